"""The figures of assignment 11, and the facts that their captions claim."""

import figure_parts as parts
import numpy as np
from figure_parts import LIGHT
from matplotlib.figure import Figure
from photograd_course.captures import all_around, rays_to_origin
from photograd_course.metrics import psnr
from photograd_course.viz.handout import Fact, figures_of, note, subplots
from photograd_course.viz.style import BLUE, FRAME, GRAY, INK, ORANGE, signed_color_map
from photograd_course.viz.style import RED as CRIMSON


def fig1_result(module):
    """Views of a teapot that were held out; recovered; and recovered with degree 0."""
    figure, found = parts.FIGURE_1.draw(module, parts.TEAPOT)
    facts = {
        "with harmonics more than 22 dB": Fact(
            found["with harmonics more than 22 dB"], 22, 60, red="uphill"
        ),
        "degree 0 loses more than 0.5 dB": Fact(
            found["degree 0 loses more than 0.5 dB"], 0.5, 20, red="uphill"
        ),
    }
    return figure, facts


def fig2_harmonics(module):
    """Harmonics to degree 3 on balls."""
    d, inside = parts.ball(44)
    Y = module.sh_basis(d, 3)
    east, pole = module.sh_basis(np.array([[1.0, 0, 0], [0, 0, 1.0]]), 3)
    around, weights = module.quadrature(6)
    there, back = module.sh_basis(around, 3), module.sh_basis(-around, 3)
    odd = np.repeat([1, -1, 1, -1], [1, 3, 5, 7])
    facts = {
        "degree 0 is the same everywhere": Fact(
            np.ptp(Y[:, 0]), 0, 1e-12, held="no known mistake makes it vary"
        ),
        "l = 1, m = 1 is negative toward +x": Fact(east[3], -1, -0.4, red="no_phase"),
        "l = 1, m = 0 is positive toward +z": Fact(pole[2], 0.4, 1, red="pole_along_y"),
        "odd degrees change sign at the opposite point, even ones do not": Fact(
            np.abs(back - there * odd).max(), 0, 1e-12, red="angle_once"
        ),
        "all but the first have mean zero": Fact(
            np.abs(weights @ there)[1:].max(), 0, 1e-12, red="recurrence_sign"
        ),
    }
    figure = Figure(figsize=(7.0, 4.1))
    top = float(np.abs(Y).max())
    for ell in range(4):
        for m in range(-ell, ell + 1):
            axes = figure.add_axes((0.075 + (m + 3) * 0.128, 0.745 - ell * 0.235, 0.122, 0.205))
            image = parts.show_ball(axes, Y[:, ell * (ell + 1) + m], inside, top)
            axes.set_title(f"m = {m}".replace("-", "−"), fontsize=7.5, pad=1.5)
        figure.text(0.015, 0.845 - ell * 0.235, f"l = {ell}", fontsize=9)
    bar = figure.add_axes((0.86, 0.75, 0.015, 0.2))
    figure.colorbar(image, cax=bar, ticks=[-0.5, 0, 0.5])
    return figure, facts


def fig3_projection(module):
    """A sky and its projections to degree 0, 1, 2 and 4."""
    d, weights = module.quadrature(40)
    directions, shape = parts.direction_map(48)
    rows, shown = {}, [("the sky", parts.sky(directions)[:, 0])]
    for degree in (0, 1, 2, 4):
        c = module.sh_project(d, weights, parts.sky(d), degree)
        shown.append((f"degree {degree}", (module.sh_basis(directions, degree) @ c)[:, 0]))
        again = module.sh_basis(d, degree) @ c
        rows[degree] = again, float(np.sqrt(weights @ (again - parts.sky(d)) ** 2)[0])
    means = [
        float((weights @ again)[0] / (weights @ parts.sky(d))[0]) for again, _ in rows.values()
    ]
    errors = [error for _, error in rows.values()]
    four = rows[4][0][:, 0]
    peak = shown[-1][1]
    facts = {
        "the error decreases with the degree": Fact(
            (np.diff(errors) < 0).all(), red="project_summed"
        ),
        "the mean is exact from the first": Fact(
            max(abs(mean - 1) for mean in means), 0, 1e-9, red="project_mean"
        ),
        "degree 4 finds the light to 10 degrees": Fact(
            np.degrees(np.arccos(directions[np.argmax(peak)] @ LIGHT)), 0, 10, red="recurrence_sign"
        ),
        "degree 4 keeps less than half of the light's peak": Fact(
            peak.max() / shown[0][1].max(), 0.1, 0.5, red="project_summed"
        ),
        "degree 4 is below zero on more than 10 % of the sphere": Fact(
            weights[four < 0].sum() / (4 * np.pi), 0.1, 0.5, red="start_of_ones"
        ),
    }
    figure, panels = subplots(7.0, 3.1, 2, 3)
    for axes, (title, values) in zip(panels.flat, shown, strict=False):
        image = axes.imshow(
            values.reshape(shape),
            cmap=signed_color_map(),
            vmin=-1.5,
            vmax=1.5,
            extent=(0, 360, -1, 1),
            aspect=90,
        )
        axes.set(title=title, xticks=[], yticks=[-1, 1])
    panels[1, 0].set(xticks=[0, 180, 360], xlabel="angle around z, degrees", ylabel="z")
    panels[0, 0].set_ylabel("z")
    axes = panels[1, 2]
    axes.bar(range(4), errors, color=BLUE, width=0.6)
    axes.set(title="error, root of the integral", xlabel="degree", xticks=range(4))
    axes.set_xticklabels(["0", "1", "2", "4"])
    axes.spines[["top", "right"]].set_visible(False)
    figure.colorbar(
        image, ax=panels[:, :2], ticks=[-1, 0, 1], shrink=0.6, location="left", extend="both"
    )
    return figure, facts


def fig4_tangent(module):
    """A function of direction, and its derivative with respect to v, from two sides."""
    c = np.random.default_rng(4).uniform(-1, 1, (16, 1))
    d, inside = parts.ball(61)
    at, _ = parts.ball(15)
    at = at[at[:, 1] < -0.3]
    from_above = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    along, rises, drawn = [], [], []
    for turn in (np.eye(3), from_above):  # rows: what lies to the right, behind, up
        v = at @ turn
        many = np.broadcast_to(c, (len(v), 16, 1)).copy()
        _, arrows = module.sh_color_adjoint(many, v, np.ones((len(v), 1)))
        along.append(np.abs(np.sum(arrows * v, axis=1)).max())
        step = 1e-4 * arrows
        rises.append(module.sh_color(many, v + step) > module.sh_color(many, v))
        drawn.append((module.sh_basis(d @ turn, 3) @ c, arrows @ turn.T))
    facts = {
        "arrows are tangent": Fact(max(along), 0, 1e-12, red="no_projection"),
        "along each arrow f rises": Fact(np.all(rises), red="wave_slope_sign"),
    }
    figure, panels = subplots(7.0, 3.3, 1, 2)
    top = max(float(np.abs(values).max()) for values, _ in drawn)
    titles = ("from −y: x to the right, z up", "from +z: x to the right, y up")
    for axes, (values, arrows), title in zip(panels, drawn, titles, strict=True):
        image = parts.show_ball(axes, values[:, 0], inside, top)
        axes.quiver(
            at[:, 0], at[:, 2], arrows[:, 0], arrows[:, 2], color=INK, scale=26, width=0.006
        )
        axes.set(xlim=(-1.08, 1.08), ylim=(-1.08, 1.08), title=title)
    figure.colorbar(image, ax=panels, ticks=[-1, 0, 1], shrink=0.7, label="f")
    return figure, facts


def fig5_irradiance(module):
    """Irradiance by brute force, from nine coefficients, and the difference by degree."""
    d, weights = module.quadrature(90)
    normals, shape = parts.direction_map(24)
    light = parts.sky(d, 6.0, 1.0)
    brute = np.maximum(normals @ d.T, 0) @ (weights[:, None] * light)
    mean = float(brute.mean())
    found, errors = {}, []
    for degree in range(5):
        c = module.sh_project(d, weights, light, degree)[None, None, None]
        found[degree] = module.probe_irradiance(c, np.zeros((len(normals), 3)), normals)
        errors.append(float(np.abs(found[degree] - brute).max() / mean))
    facts = {
        "nine coefficients are within 3 % of the mean": Fact(errors[2], 0, 0.03, red="lobe_half"),
        "degree 3 adds nothing": Fact(np.abs(found[3] - found[2]).max(), 0, 1e-12, red="lobe_flat"),
    }
    figure, panels = subplots(7.0, 3.3, 2, 3)
    high = float(brute.max()) * 1.05
    sky = parts.sky(normals, 6.0, 1.0)
    off = (found[2] - brute) / mean * 100
    far = 3.0
    for axes, values, title, limits, colors in (
        (panels[0, 0], sky, "light from a direction", (0, 5), "viridis"),
        (panels[0, 1], brute, "irradiance, brute force", (0, high), "viridis"),
        (panels[0, 2], found[2], "nine coefficients", (0, high), "viridis"),
        (panels[1, 0], off, "difference, % of mean", (-far, far), signed_color_map()),
    ):
        image = axes.imshow(
            values.reshape(shape),
            cmap=colors,
            vmin=limits[0],
            vmax=limits[1],
            extent=(0, 360, -1, 1),
            aspect=90,
        )
        axes.set(title=title, xticks=[0, 180, 360], yticks=[-1, 0, 1])
        if axes is not panels[0, 1]:
            figure.colorbar(
                image, ax=axes, shrink=0.7, ticks=[0, 2, 4] if limits[0] == 0 else [-3, 0, 3]
            )
    panels[0, 0].set_ylabel("z")
    panels[1, 0].set(ylabel="z", xlabel="angle around z, degrees")
    axes = panels[1, 1]
    axes.bar(range(5), np.array(errors) * 100, color=BLUE, width=0.6)
    axes.axhline(3, color=CRIMSON, linewidth=1, linestyle="--")
    axes.set(yscale="log", xlabel="highest degree", title="largest error, % of mean")
    axes.spines[["top", "right"]].set_visible(False)
    axes = panels[1, 2]
    factors = [
        float(
            module.probe_irradiance(
                np.eye((ell + 1) ** 2)[ell * (ell + 1)][None, None, None, :, None],
                np.zeros((1, 3)),
                np.array([[0, 0, 1.0]]),
            )[0, 0]
            / module.sh_basis(np.array([[0, 0, 1.0]]), ell)[0, ell * (ell + 1)]
        )
        for ell in range(5)
    ]
    axes.bar(range(5), factors, color=ORANGE, width=0.6)
    axes.axhline(0, color=FRAME, linewidth=0.7)
    axes.set(xlabel="degree l", title="factor of the lobe")
    axes.spines[["top", "right"]].set_visible(False)
    return figure, facts


def fig6_glyphs(module):
    """Change of the colors of a slice by a step against the derivative, by direction."""
    n, light = 12, np.array([1.0, 0.0, 1.0]) / np.sqrt(2)
    density, c = parts.ball_scene(module, n, light)
    rays = rays_to_origin(3.2 * all_around(40), 16, np.tan(0.375))
    samples = module.march(density.shape, rays)
    target = module.render(density, c, samples)
    gray = np.zeros_like(c)
    gray[..., 0, 0] = float(np.mean(c[..., 0, 0][density > 1]))
    _, _, d_c = module.loss_and_grad(density, gray, samples, target)
    slice_ = -(d_c[:, n // 2 - 1] + d_c[:, n // 2])[:, :, :, 0]
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    normal = x / np.linalg.norm(x, axis=-1, keepdims=True)
    lit = (density > 4) & (normal @ light > 0.9) & (np.linalg.norm(x, axis=-1) > 0.4)
    gain = -(d_c[lit][:, :, 0] @ module.sh_basis(light[None], 2)[0])
    turn = np.linspace(0, 2 * np.pi, 73)
    ring = np.stack([np.cos(turn), 0 * turn, np.sin(turn)], axis=1)
    change = slice_ @ module.sh_basis(ring, 2).T
    strong = np.linalg.norm(slice_, axis=-1) > 0.3 * np.linalg.norm(slice_, axis=-1).max()
    facts = {
        "cells that face the highlight get brighter toward it": Fact(
            (gain > 0).mean(), 0.95, 1, red="d_coefficients_without_g"
        ),
        "most of the larger glyphs have both colors": Fact(
            ((change[strong].min(axis=1) < 0) & (change[strong].max(axis=1) > 0)).mean(),
            0.6,
            1,
            red="recurrence_sign",
        ),
    }
    figure, axes = subplots(5.6, 5.2)
    middle = density[:, n // 2].T
    axes.imshow(middle, cmap="gray_r", vmin=0, vmax=30, origin="lower", extent=(-0.5, n - 0.5) * 2)
    top = np.abs(change).max()
    for i in range(n):
        for k in range(n):
            r = 0.8 * np.sqrt(np.abs(change[i, k]) / top)
            for sign, color in ((1, CRIMSON), (-1, BLUE)):
                part = np.where(sign * change[i, k] > 0, r, 0)
                axes.fill(i + part * ring[:, 0], k + part * ring[:, 2], color=color, linewidth=0.3)
    axes.annotate(
        "", (11.2, 11.2), (9.9, 9.9), arrowprops={"arrowstyle": "->", "color": INK, "lw": 1.5}
    )
    axes.text(9.8, 11.1, "highlight", ha="center", fontsize=8)
    axes.set(xlabel="x, cells", ylabel="z, cells", xticks=range(0, n, 2), yticks=range(0, n, 2))
    axes.set_title("change by a step: red brightens, blue darkens")
    return figure, facts


def fig7_coarse_to_fine(module):
    """PSNR of held-out views of the teapot against steps: a fixed grid, and coarse to fine."""
    rays, target = parts.TEAPOT.photographs(20, 10)
    unseen, truth = parts.TEAPOT.photographs(6, 10, 0.7)
    target, truth = target.mean(axis=1, keepdims=True), truth.mean(axis=1, keepdims=True)
    runs, own = {}, {}
    for name, n, levels in (("fixed grid", 16, 1), ("coarse to fine", 4, 3)):
        first = np.full((n,) * 3, 0.1), np.zeros((n, n, n, 9, 1))
        stages = [(0, first)]
        for end in (8, 16, 24):
            plan = (1, end) if levels == 1 else (end // 8, 8)
            with parts.rate(module, 0.2):
                stages.append((end, module.fit_plenoxels(*first, rays, target, *plan)[:2]))
        runs[name] = [psnr(parts.seen(module, each, unseen), truth) for _, each in stages]
        own[name] = psnr(parts.seen(module, stages[-1][1], rays), target)
    fixed, fine = runs.values()
    facts = {
        "coarse to fine ends more than 2 dB above": Fact(
            fine[-1] - fixed[-1], 2, 20, red="steps_at_last_level"
        ),
        "the fixed grid is better on its own photographs than on held-out views": Fact(
            own["fixed grid"] - fixed[-1], 2, 30, red="uphill"
        ),
    }
    figure, axes = subplots(7.0, 2.6)
    for (name, scores), color, look in zip(runs.items(), (GRAY, BLUE), ("s:", "o-"), strict=True):
        axes.plot((0, 8, 16, 24), scores, look, color=color, markersize=5)
        note(axes, name, (24, scores[-1]), (7, 0), va="center")
    axes.set(xlabel="step", ylabel="PSNR of held-out\nviews [dB]", xlim=(-0.5, 29.5))
    axes.set_xticks(range(0, 25, 8))
    axes.grid(visible=True)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, facts


FIGURES = figures_of(
    fig1_result,
    fig2_harmonics,
    fig3_projection,
    fig4_tangent,
    fig5_irradiance,
    fig6_glyphs,
    fig7_coarse_to_fine,
)

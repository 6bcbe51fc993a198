"""The figures of assignment 08, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from figure_parts import ADDED, LEFT_OUT, NO_EXP, NO_STEP, OWN_LIGHT, STEPS, TAKES_IN
from matplotlib.figure import Figure
from photograd_course.viz.handout import Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, FRAME, GRAY, INK, ORANGE, plain_axes
from photograd_course.viz.style import RED as CRIMSON


def fig1_view(module: ModuleType) -> tuple[Figure, Facts]:
    """A photographed volume, a wrong guess, and the derivative of the loss w.r.t. sigma."""
    figure, found = parts.FIGURE_1.draw(module)
    facts: Facts = {
        "over 95 % of the ring's summed |derivative| is negative": Fact(
            found["over 95 % of the ring's summed |derivative| is negative"],
            0.95,
            1,
            red="view_no_sigma",
        ),
        "over 95 % of the moon's summed |derivative| is positive": Fact(
            found["over 95 % of the moon's summed |derivative| is positive"],
            0.95,
            1,
            red="adjoint_only_occlusion",
        ),
        "far from planet, ring and moon it is below a thousandth": Fact(
            found["far from planet, ring and moon it is below a thousandth"],
            0,
            1e-3,
            red="view_samples_of_one_ray",
        ),
        "photograph and guess differ": Fact(
            found["photograph and guess differ"], 0.3, 1, red="no_occlusion"
        ),
    }
    return figure, facts


def fig2_ray(module: ModuleType) -> tuple[Figure, Facts]:
    """Extinction, transmittance and weights along a ray through two clouds."""
    x, sigma, dt = parts.two_clouds()
    w, T_end = parts.weights(module, sigma, dt)
    # Transmittance in front of each step: T_end of the ray that ends there.
    T = np.array([parts.end_of(module, sigma[:k], dt[:k]) for k in range(1, STEPS + 1)])
    T = np.concatenate([[1.0], T])
    thin, dense = x < 3, x > 3
    front = dense & (x < 4.5)
    facts: Facts = {
        "the second cloud is four times as dense": Fact(
            sigma[dense].max() / sigma[thin].max(), 3.9, 4.1, held="what the figure was given"
        ),
        "T never rises": Fact((np.diff(T) <= 0).all(), red="T_end_opacity"),
        "T ends at 0.02 or so": Fact(T_end, 0.01, 0.03, red="no_step"),
        "weights and T_end sum to 1": Fact(w.sum() + T_end, 1 - 1e-12, 1 + 1e-12, red="inclusive"),
        "the dense cloud has less weight than the thin one": Fact(
            w[dense].sum() / w[thin].sum(), 0.1, 0.95, red="no_occlusion"
        ),
        "its front has more weight than its back": Fact(
            w[front].sum() / max(w[dense & ~front].sum(), 1e-300), 1.5, 1e6, red="back_to_front"
        ),
    }
    figure, panels = subplots(7.0, 4.4, 3, 1, sharex=True)
    panels[0].bar(x, sigma, width=dt, color=GRAY)
    panels[0].set(ylabel="σ  [1/m]")
    panels[1].step(np.append(0.0, np.cumsum(dt)), T, color=INK, where="post")
    panels[1].set(ylabel="T in front", ylim=(0, 1.05))
    panels[2].bar(x, w, width=dt, color=BLUE)
    panels[2].set(ylabel="weight w", xlabel="distance from the camera [m]", xlim=(0, 6))
    for axes in panels:
        plain_axes(axes)
        axes.set_axisbelow(True)
    return figure, facts


def fig3_order(module: ModuleType) -> tuple[Figure, Facts]:
    """Error of the pixel against the number of steps, for four weights of a step."""
    counts = 2 ** np.arange(3, 10)
    fine = 8192
    right = parts.cloud_pixel(lambda s, c, dt: parts.pixel_of(module, s, c, dt), fine)
    ways = {
        "T α, equation (7)": (lambda s, c, dt: parts.pixel_of(module, s, c, dt), BLUE, "-", "o"),
        "T σ dt": (
            lambda s, c, dt: np.sum(parts.transmittance(s * dt) * s * dt * c),
            ORANGE,
            "--",
            "s",
        ),
        "T inclusive, times α": (
            lambda s, c, dt: np.sum(
                parts.transmittance(s * dt) * np.exp(-s * dt) * -np.expm1(-s * dt) * c
            ),
            GRAY,
            "-.",
            "^",
        ),
        "T σ, without dt": (
            lambda s, c, dt: np.sum(parts.transmittance(s * dt) * s * c),
            CRIMSON,
            ":",
            "v",
        ),
    }
    errors = {
        name: np.array([abs(parts.cloud_pixel(way[0], int(n)) - right) / right for n in counts])
        for name, way in ways.items()
    }
    names = list(ways)
    slopes = {n: np.diff(np.log2(np.maximum(e, 1e-16)))[1:-1] for n, e in errors.items()}
    at_256 = {name: float(e[counts == 256][0]) for name, e in errors.items()}
    shortcuts = min(at_256[names[1]], at_256[names[2]])
    facts: Facts = {
        "equation (7): a quarter with each halving": Fact(
            np.abs(slopes[names[0]] + 2).max(), 0, 0.1, red="riemann"
        ),
        "the shortcuts halve only": Fact(
            max(np.abs(slopes[names[k]] + 1).max() for k in (1, 2)), 0, 0.1, red="no_step"
        ),
        "both errors are thousands of times larger at 256 steps": Fact(
            shortcuts / max(at_256[names[0]], 1e-300), 2000, 1e6, red="inclusive"
        ),
        "without dt the error doubles": Fact(
            np.abs(slopes[names[3]] - 1).max(), 0, 0.1, red="lecture"
        ),
    }
    figure, axes = subplots(7.0, 3.1)
    for name, (_, color, dashes, mark) in ways.items():
        axes.loglog(counts, errors[name], color=color, linestyle=dashes, marker=mark, markersize=4)
        lift = {"T σ dt": -6, "T inclusive, times α": 6}.get(name, 0)
        note(
            axes,
            name,
            (counts[-1], errors[name][-1]),
            (7, lift),
            va="center",
            color=INK if color == GRAY else color,
        )
    axes.set(xlabel="steps", ylabel="relative error of the pixel", xlim=(7, 2200))
    axes.set_xticks(counts, [str(n) for n in counts])
    axes.minorticks_off()
    plain_axes(axes)
    return figure, facts


def fig4_adjoint(module: ModuleType) -> tuple[Figure, Facts]:
    """Derivative of a pixel with respect to extinction along the ray of figure 2, in two terms."""
    x, sigma, dt = parts.two_clouds()
    color = np.where(x < 3, 0.1, 0.95 - 0.12 * (x - 3))
    background = np.array([0.3])
    given = (sigma[None], color[None, :, None], dt[None], background)
    d_sigma, d_color, _ = (
        part[0] for part in module.composite_adjoint(*given, np.ones((1, 1)), np.zeros(1))
    )
    w = d_color[:, 0]
    # The own term, with everything else black: there is no occlusion term then.
    own = np.zeros(STEPS)
    for k in range(STEPS):
        alone = np.zeros((1, STEPS, 1))
        alone[0, k] = color[k]
        black = module.composite_adjoint(
            sigma[None], alone, dt[None], 0 * background, np.ones((1, 1)), np.zeros(1)
        )
        own[k] = black[0][0, k]
    hidden = d_sigma - own
    differences = parts.differences(module, *given)
    dark, bright = (sigma > 0.05) & (x < 3), (sigma > 0.05) & (x > 3)
    error = np.linalg.norm(d_sigma - differences) / np.linalg.norm(differences)
    facts: Facts = {
        "the sum agrees with finite differences": Fact(error, 0, 1e-7, red="adjoint_off_by_one"),
        "negative at each step of the dark cloud": Fact(
            d_sigma[dark].max(), -10, -1e-9, red="adjoint_no_occlusion"
        ),
        "positive at each step of the bright cloud": Fact(
            d_sigma[bright].min(), 1e-9, 10, red="adjoint_only_occlusion"
        ),
        "the own term is never negative": Fact(own.min(), 0, 1, red="adjoint_sign"),
        "the occlusion term is never positive": Fact(
            hidden.max(), -10, 0, red="adjoint_occlusion_added"
        ),
        "weights sum to 1 - T_end": Fact(
            w.sum() + parts.end_of(module, sigma, dt), 1 - 1e-9, 1 + 1e-9, red="adjoint_color_no_T"
        ),
    }
    figure, axes = subplots(7.0, 3.0)
    axes.axvspan(*parts.reach(x, dark, dt), color=INK, alpha=0.12, linewidth=0)
    axes.axvspan(*parts.reach(x, bright, dt), color=ORANGE, alpha=0.12, linewidth=0)
    axes.axhline(0, color=FRAME, linewidth=0.8)
    axes.plot(x, own, color=BLUE, linestyle="--")
    axes.plot(x, hidden, color=ORANGE, linestyle="-.")
    axes.plot(x, d_sigma, color=INK)
    axes.plot(x[::3], differences[::3], "o", color=INK, markersize=3.5)
    for text, place, color in (
        ("own term", (4.1, 0.035), BLUE),
        ("occlusion term", (4.1, -0.038), ORANGE),
        ("sum; dots: finite differences", (1.3, -0.034), INK),
    ):
        axes.annotate(text, place, color=color, fontsize=8)
    axes.set(ylim=(-0.07, 0.07))
    low, high = axes.get_ylim()
    for text, at in (("dark cloud", 1.5), ("bright cloud", 4.5)):
        axes.annotate(text, (at, high - 0.07 * (high - low)), ha="center", fontsize=8)
    axes.set(xlabel="distance from the camera [m]", ylabel="∂ pixel / ∂σ", xlim=(0, 6))
    plain_axes(axes)
    return figure, facts


def fig5_wrong(module: ModuleType) -> tuple[Figure, Facts]:
    """Six wrong adjoints of a ray: relative error and cosine."""
    rng = np.random.default_rng(8)
    rays, steps, length = 200, 24, 0.05
    sigma, color = rng.uniform(0.0, 3.0, (rays, steps)), rng.random((rays, steps, 3))
    dt, background = np.full((rays, steps), length), rng.random(3)
    d_pixel = rng.uniform(-1, 1, (rays, 3))
    right = module.composite_adjoint(sigma, color, dt, background, d_pixel, np.zeros(rays))[0]
    few = slice(0, 4)
    checked = parts.differences(module, sigma[few], color[few], dt[few], background, d_pixel[few])
    found = {
        name: parts.wrong(name, sigma, color, length, background, d_pixel)
        for name in (LEFT_OUT, ADDED, NO_STEP, OWN_LIGHT, NO_EXP, TAKES_IN)
    }
    error = {k: float(np.linalg.norm(v - right) / np.linalg.norm(right)) for k, v in found.items()}
    cosine = {
        k: float(np.vdot(v, right) / np.linalg.norm(v) / np.linalg.norm(right))
        for k, v in found.items()
    }
    subtle = (NO_STEP, OWN_LIGHT, NO_EXP, TAKES_IN)
    worst = np.linalg.norm(right[few] - checked) / np.linalg.norm(checked)
    facts: Facts = {
        "the right one agrees with finite differences to 1e-7": Fact(
            worst, 0, 1e-7, red="adjoint_inclusive"
        ),
        "the first two point elsewhere": Fact(
            max(cosine[LEFT_OUT], cosine[ADDED]), -1.001, 0.9, red="adjoint_no_occlusion"
        ),
        "the other four have cosines above 0.99": Fact(
            min(cosine[k] for k in subtle), 0.99, 1.0001, red="adjoint_sign"
        ),
        "and are wrong by more than 10 %": Fact(
            min(error[k] for k in subtle), 0.1, 20, red="adjoint_missing_step"
        ),
        "without dt the cosine is 1": Fact(
            cosine[NO_STEP], 1 - 1e-9, 1 + 1e-9, red="adjoint_riemann"
        ),
    }
    figure, axes = subplots(7.0, 2.6)
    names = list(found)
    values = [100 * error[name] for name in names]
    axes.barh(names, values, color=[CRIMSON] * 2 + [BLUE] * 4, height=0.62)
    for row, name in enumerate(names):
        text = f"{values[row]:.0f} %,  cosine {cosine[name]:.3f}".replace("-", "−")
        note(axes, text, (values[row], row), (5, 0), va="center")
    axes.set(xscale="log", xlim=(2, 40000), xlabel="relative error [%]")
    axes.set_xticks([3, 10, 30, 100, 300, 1000], ["3", "10", "30", "100", "300", "1000"])
    axes.set_axisbelow(True)
    axes.minorticks_off()
    axes.invert_yaxis()
    plain_axes(axes)
    axes.grid(visible=False, axis="y")
    return figure, facts


def fig6_box(module: ModuleType) -> tuple[Figure, Facts]:
    """Two rays, their crossings of the planes of a box, and the intervals between them."""
    low, high = np.array([1.0, 1.0, -1.0]), np.array([4.0, 3.0, 1.0])
    origins = np.array([[0.0, 0.6, 0.0], [0.0, 0.2, 0.0]])
    directions = np.array([[1.0, 0.5, 0.0], [0.8, 2.6, 0.0]])
    near, far = module.ray_box(low, high, origins, directions)
    planes = [
        [sorted(((low[a] - o[a]) / d[a], (high[a] - o[a]) / d[a])) for a in (0, 1)]
        for o, d in zip(origins, directions, strict=True)
    ]
    overlap = [(max(p[0][0], p[1][0]), min(p[0][1], p[1][1])) for p in planes]
    facts: Facts = {
        "the first ray hits where both intervals overlap": Fact(
            np.allclose([near[0], far[0]], overlap[0]) and near[0] < far[0], red="box_first_entry"
        ),
        "those of the second do not overlap": Fact(
            overlap[1][0] > overlap[1][1], held="what the figure was given"
        ),
        "it misses": Fact(near[1] == 0 and far[1] == 0, red="box_misses_kept"),
    }
    colors = (BLUE, CRIMSON)
    figure, (left, right) = subplots(7.0, 2.6, 1, 2, width_ratios=(1.1, 1))
    left.fill([1, 4, 4, 1], [1, 1, 3, 3], color=FRAME, alpha=0.25, linewidth=0)
    for x in (1, 4):
        left.axvline(x, color=FRAME, linewidth=0.8, linestyle=":")
    for y in (1, 3):
        left.axhline(y, color=FRAME, linewidth=0.8, linestyle=":")
    for r in (0, 1):
        o, d = origins[r, :2], directions[r, :2]
        line = o + np.array([0.0, 5.2])[:, None] * d
        left.plot(*line.T, color=colors[r], linewidth=1.0)
        if far[r] > near[r]:
            inside = o + np.array([near[r], far[r]])[:, None] * d
            left.plot(*inside.T, color=colors[r], linewidth=3.5, solid_capstyle="butt")
        for a, mark in ((0, "o"), (1, "s")):
            at = o + np.array(planes[r][a])[:, None] * d
            left.plot(*at.T, mark, color=colors[r], ms=5, mfc="white")
        name, place = (("first", (4.25, 2.45)), ("second", (1.25, 3.6)))[r]
        left.annotate(name, place, color=colors[r])
    left.set(xlim=(0, 5), ylim=(0, 4), xlabel="x", ylabel="y", aspect="equal")
    left.set(xticks=range(6), yticks=range(5))
    rows = 0
    for r in (0, 1):
        for a, mark in ((0, "o"), (1, "s")):
            right.plot(
                planes[r][a],
                [rows, rows],
                color=colors[r],
                marker=mark,
                markerfacecolor="white",
                markersize=5,
            )
            said = "in the " + "xy"[a] + " slab"
            note(right, said, (planes[r][a][0], rows), (0, 7), fontsize=7.5)
            rows += 1
        if far[r] > near[r]:
            right.plot(
                [near[r], far[r]], [rows, rows], color=colors[r], linewidth=4, solid_capstyle="butt"
            )
        said = "in the box" if far[r] > near[r] else "never in all slabs: misses"
        start = near[r] if far[r] > near[r] else 0.3
        note(right, said, (start, rows), (0, 6), fontsize=7.5, color=colors[r])
        rows += 1
    right.set(xlim=(0, 5.3), ylim=(5.6, -0.9), xlabel="t", yticks=[])
    right.spines[["top", "right", "left"]].set_visible(False)
    return figure, facts


FIGURES = figures_of(fig1_view, fig2_ray, fig3_order, fig4_adjoint, fig5_wrong, fig6_box)

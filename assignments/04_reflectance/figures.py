"""The figures of assignment 04, and the facts that their captions claim.

`module` is the solution or a mutant of it.
"""

import figure_parts as parts
import numpy as np
from figure_parts import arrow, toward
from matplotlib.colors import SymLogNorm
from matplotlib.ticker import NullFormatter
from photograd_course.color import srgb_encode
from photograd_course.viz.handout import Fact, figures_of, note, subplots
from photograd_course.viz.style import BLUE, FRAME, GRAY, INK, ORANGE, signed_color_map
from photograd_course.viz.style import RED as CRIMSON


def fig1_chart(module):
    """Balls of the material: roughness to the right, metalness downward."""
    figure, found = parts.FIGURE_1.draw(module)
    facts = {
        "each pixel of half metal is the mean of those above and below": Fact(
            found["each pixel of half metal is the mean of those above and below"],
            0,
            1e-12,
            red="gltf_premixed",
        ),
        "the metal's highlight has the base color": Fact(
            found["the metal's highlight has the base color"],
            0,
            0.05,
            red="gltf_metalness_reversed",
        ),
        "the coating's highlight is nearly white": Fact(
            found["the coating's highlight is nearly white"], 0.75, 1.0, red="gltf_tinted_varnish"
        ),
        "the metal's highlight gets darker to the right": Fact(
            found["the metal's highlight gets darker to the right"], red="lobe_no_masking"
        ),
    }
    return figure, facts


def fig2_solid_angle(module):
    """Light at an angle to the surface; a cell of the hemisphere, and the disc below it."""
    even = module.furnace(lambda _, wi: np.ones((len(wi), 1)), np.array([0.5]))[0, 0]
    facts = {
        "the solid angles of a hemisphere sum to 2 pi": Fact(
            module.hemisphere()[1].sum() - 2 * np.pi, -1e-12, 1e-12, held="about given directions"
        ),
        "times their cosines they sum to pi, the area of the disc": Fact(
            even - np.pi, -1e-12, 1e-12, red="furnace_no_cosine"
        ),
    }
    figure, (left, right) = subplots(7.0, 2.4, 1, 2, width_ratios=(3.8, 2.8))
    parts.draw_light_at_an_angle(left)
    parts.draw_solid_angle(right)
    return figure, facts


def fig3_furnace(module):
    """Directional albedo of white materials, by the cosine of the viewer."""
    cosines = np.concatenate([[0.02, 0.05], np.linspace(0.1, 1.0, 19)])

    def of(model, *given, cosines=cosines):
        return module.furnace(lambda wo, wi: model(wo, wi, *given), cosines)[:, 0]

    mirrors = {r: module.furnace(parts.mirror(module, r), cosines)[:, 0] for r in (0.6, 0.8, 1.0)}
    burley = {r: of(module.burley_diffuse, 1.0, r) for r in (0.3, 1.0)}
    with np.errstate(under="ignore"):
        printed, right = (
            of(module.cook_torrance, 1.0, 0.4, flag, cosines=cosines[2:]) for flag in (True, False)
        )
    plastic = module.furnace(parts.white(module, 0.0, 0.6), np.array([0.1]))[0, 0]
    facts = {
        "microfacets of roughness 1 return 1 - ln 2 straight up": Fact(
            mirrors[1.0][-1] - 1 + np.log(2), -1e-9, 1e-9, red="lobe_printed"
        ),
        "no microfacets return more than arrives": Fact(
            max(float(values.max()) for values in mirrors.values()), 0.3, 1.0, red="lobe_no_masking"
        ),
        "Burley's, roughness 1, returns 1.46 at 0.05": Fact(
            burley[1.0][1], 1.46, 1.47, red="furnace_mean"
        ),
        "Burley's, roughness 1, is above 1 everywhere": Fact(
            burley[1.0].min(), 1.0, 1.1, red="furnace_over_pi"
        ),
        "Burley's, roughness 0.3, is nowhere above 1": Fact(
            burley[0.3].max(), 0.5, 1.0, red="furnace_no_cosine"
        ),
        "as printed, Cook and Torrance's returns four times as much": Fact(
            np.abs(printed / right - 4).max(), 0, 1e-9, held="about a model that is given"
        ),
        "corrected it nowhere returns more than arrives": Fact(
            right.max(), 0.8, 1.0, red="furnace_viewer_cosine"
        ),
        "white plastic of roughness 0.6 returns 1.06 at 0.1": Fact(
            plastic, 1.055, 1.065, red="gltf_ground_keeps_all"
        ),
    }
    figure, panels = subplots(7.0, 3.2, 1, 2, width_ratios=(1.5, 1))
    axes = panels[0]
    looks = ((BLUE, "-"), (ORANGE, "--"), (CRIMSON, "-."))
    for (r, values), (color, look) in zip(mirrors.items(), looks, strict=True):
        axes.plot(cosines, values, look, color=color, label=f"microfacets, roughness {r:g}")
    for (r, values), look in zip(burley.items(), (":", "-"), strict=True):
        axes.plot(cosines, values, look, color=INK, label=f"Burley, roughness {r:g}")
    axes.plot(1.0, 1 - np.log(2), "o", color=CRIMSON, markersize=5, clip_on=False)
    note(axes, "1 − ln 2", (1.0, 1 - np.log(2)), (-8, -14), ha="right")
    axes.set(title="microfacets with F = 1, and Burley's white", ylim=(0, 1.6))
    axes.legend(loc="lower left", fontsize=6.5)
    axes = panels[1]
    axes.plot(cosines[2:], printed, color=CRIMSON, label="as printed")
    axes.plot(cosines[2:], right, "--", color=BLUE, label="with 4 π")
    axes.set(title="Cook and Torrance's, slope 0.4", ylim=(0, 4.4))
    axes.legend(loc="center right", fontsize=7)
    for axes in panels:
        axes.axhline(1, color=FRAME, linewidth=0.8)
        axes.set(xlim=(0, 1), xlabel="cosine of the viewer")
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].set_ylabel("directional albedo")
    return figure, facts


def fig4_facets(module):
    """A half vector; what viewer and light see of a rough surface; a facet that turns."""
    wo, wi = np.array([[np.sin(0.9), 0, np.cos(0.9)]]), np.array([[-0.6, 0, 0.8]])
    shared = 4 * wo[0, 2] * wi[0, 2] * np.pi * module.ggx_lobe(wo, wi, np.ones(1))[0]
    x = np.linspace(-1.2, 1.2, 1200)
    z = parts.profile(x)
    by_viewer, by_light = (parts.is_seen(x, z, toward(each)) for each in (55, -50))
    both, one = by_viewer & by_light, by_viewer ^ by_light
    o, turn = toward(50), 12.0
    out = [parts.mirrored(o, toward(n)) for n in (0.0, -turn)]
    facts = {
        "w_h halves the angle": Fact(
            abs(module.half_vector(wo, wi)[0] @ (wo - wi)[0]), 0, 1e-12, held="given code"
        ),
        "both see fewer facets than the viewer alone": Fact(
            shared * (1 + wo[0, 2]) / (2 * wo[0, 2]), 0.5, 0.95, red="lobe_no_masking"
        ),
        "some are seen by both, some by one": Fact(
            min(both.sum(), one.sum()), 100, 900, held="drawn here"
        ),
        "the reflected direction turns by twice the angle": Fact(
            np.degrees(np.arccos(out[0] @ out[1])), 24 - 1e-6, 24 + 1e-6, held="drawn here"
        ),
    }
    figure, panels = subplots(7.0, 2.1, 1, 3)
    left, middle, right = panels
    parts.draw_half_vector(left)
    parts.draw_masking(middle, x, z, both, one)
    parts.draw_turned_facet(right, o, turn)
    return figure, facts


def fig5_cap(module):
    """Visible normals of a squeezed hemisphere; the hemisphere; the cap of reflected directions."""
    n, squeeze, z = 6000, 0.4, 0.5
    v = np.array([np.sqrt(1 - z * z), z])
    wo = np.tile([v[0], 0.0, z], (n, 1))
    c = module.sample_ggx(wo, np.ones(n), np.random.default_rng(3).random((n, 2)))
    heights = np.histogram(c[:, 2], np.linspace(-z, 1, 11))[0] / (n / 10)
    facts = {
        "reflected directions reach down to -v_z": Fact(
            c[:, 2].min(), -z - 1e-9, -z + 0.01, red="sample_half_ball"
        ),
        "their heights are uniform": Fact(
            np.abs(heights - 1).max(), 0, 0.15, red="sample_even_angles"
        ),
    }
    figure, panels = subplots(7.0, 2.2, 1, 4, width_ratios=(2.8, 2.8, 2.8, 1.4))
    o = parts.unit(v / [squeeze, 1])  # so that v is its stretched direction
    parts.draw_visible_normals(panels[0], squeeze, o, "$w_o$")
    parts.draw_visible_normals(panels[1], 1.0, v, "v")
    parts.bare(panels[0], (-1.2, 1.6), (-1.05, 1.5), "facets")
    parts.bare(panels[1], (-1.2, 1.6), (-1.05, 1.5), "hemisphere")
    axes = panels[2]
    turn = np.radians(np.linspace(0, 360, 181))
    axes.plot(np.cos(turn), np.sin(turn), color=GRAY, linewidth=0.9)
    axes.plot(*c[:700, [0, 2]].T, ".", color=ORANGE, markersize=2)
    axes.plot([-1.2, 1.2], [-z, -z], color=INK, linewidth=0.8)
    axes.text(0, -z - 0.24, "$c_z = -v_z$", ha="center")
    arrow(axes, [0, 0], 1.25 * v, "v", CRIMSON)
    parts.bare(axes, (-1.3, 1.5), (-1.05, 1.5), "cap")
    axes = panels[3]
    axes.barh(np.linspace(-z, 1, 21)[1::2], heights, 0.9 * (1 + z) / 10, color=ORANGE)
    axes.set(ylim=(-1.05, 1.5), yticks=[-z, 0, 1], xticks=[0, 1], title="by height")
    axes.set_yticklabels(["$-v_z$", "0", "1"])
    axes.spines[["top", "right"]].set_visible(False)
    return figure, facts


def fig6_samples(module):
    """Samples over their density, and weights of two samplers."""
    rng = np.random.default_rng(7)
    r, n = 0.6, 4000
    panels_of, below = [], []
    for z in (0.95, 0.35):
        wo = np.tile([np.sqrt(1 - z * z), 0.0, z], (n, 1))
        wi = module.sample_ggx(wo, np.full(n, r), rng.random((n, 2)))
        panels_of.append((z, wo, wi))
        below.append(float((wi[:, 2] <= 0).mean()))
    z, wo, wi = panels_of[1]
    weights = parts.weights(module, wo, wi, r, module.ggx_pdf(wo, wi, np.full(n, r)))
    even = parts.even(rng, n)
    plain = parts.weights(module, wo, even, r, np.full(n, 1 / (2 * np.pi)))
    right = float(module.furnace(parts.mirror(module, r), np.array([z]))[0, 0])
    spread = weights.std() / np.sqrt(n)
    facts = {
        "no weight is above 1": Fact(weights.max(), 0.5, 1 + 1e-9, red="pdf_half"),
        "the mean weight is the albedo within four standard errors": Fact(
            abs(weights.mean() - right) / spread, 0, 4, red="sample_half_ball"
        ),
        "uniform directions are more than three times as noisy": Fact(
            plain.std() / weights.std(), 3, 100, red="pdf_all_facets"
        ),
        "for both viewers about a tenth lies below the surface": Fact(
            np.abs(np.array(below) - 0.1).max(), 0, 0.02, red="sample_all_facets"
        ),
    }
    figure, panels = subplots(7.0, 2.7, 1, 3)
    x = np.linspace(-1, 1, 121)
    px, py = (each.ravel() for each in np.meshgrid(x, x))
    pz = np.sqrt(np.maximum(1 - px**2 - py**2, 0))
    grid = np.stack([px, py, pz], axis=1)
    for axes, (z, wo, wi) in zip(panels[:2], panels_of, strict=True):
        density = module.ggx_pdf(np.tile(wo[:1], (len(grid), 1)), grid, np.full(len(grid), r))
        density = np.where(px**2 + py**2 < 0.995, density, np.nan).reshape(121, 121)
        axes.imshow(density, origin="lower", extent=(-1, 1, -1, 1), cmap="viridis", vmin=0)
        shown = wi[(wi[:, 2] > 0)][:350]
        axes.plot(shown[:, 0], shown[:, 1], ".", color="white", markersize=1.6)
        axes.plot(wo[0, 0], 0, "o", markerfacecolor="none", color=CRIMSON, markersize=6)
        axes.set(title=f"viewer at cosine {z:g}", xticks=[], yticks=[], xlabel="x")
        axes.set_ylabel("y")
    axes = panels[2]
    bins = np.linspace(0, 4, 41)
    axes.hist(np.minimum(plain, 3.99), bins, color=GRAY, label="uniform sampling")
    axes.hist(weights, bins, color=BLUE, alpha=0.8, label="visible normals")
    axes.axvline(right, color=CRIMSON, linewidth=1)
    axes.set(xlabel="weight f cos / pdf", title="4000 weights, 0.35", yscale="log")
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.legend(fontsize=6.5)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, facts


def fig7_by_roughness(module):
    """A plastic ball, its derivative with respect to roughness, and a finite difference."""
    size, r, step = 150, 0.35, 0.02
    color = np.array([0.75, 0.12, 0.08])
    inside, frame = module.ball(size)
    wo, wi = frame[:, :, 2], frame @ parts.unit(parts.LIGHTS[0][0])
    n = len(wo)
    given = np.tile(color, (n, 1)), np.zeros(n)
    cosine = np.pi * np.clip(wi[:, 2:], 0, None)
    d_f = np.repeat(cosine / 3, 3, axis=1)
    _, _, slope = module.gltf_backward(wo, wi, *given, np.full(n, r), d_f)
    before, after = (
        (module.gltf(wo, wi, *given, np.full(n, each)) * cosine).mean(axis=1)
        for each in (r, r + step)
    )
    middle = int(np.argmax(before))
    change, told = after - before, slope * step
    center = np.linalg.norm(np.argwhere(inside) - np.argwhere(inside)[middle], axis=1)
    ring = (center > 14) & (center < 26)
    dark = wi[:, 2] <= 0
    error = change / step - slope
    facts = {
        "the middle of the highlight gets darker": Fact(slope[middle], -1e9, -1, red="back_no_D"),
        "the ring around it gets brighter": Fact(
            (slope[ring] > 0).mean(), 0.95, 1, red="back_q_sign"
        ),
        "a step of 0.02 differs by up to 13 % of the largest derivative": Fact(
            np.abs(told - change).max() / np.abs(told).max(), 0.12, 0.13, red="back_of_alpha"
        ),
        "in the shadow it is exactly zero": Fact(
            np.abs(slope[dark]).max(), 0, 0, red="back_rows_summed"
        ),
    }
    figure, panels = subplots(7.0, 2.6, 1, 3)
    picture = np.ones((size, size, 3))
    picture[inside] = srgb_encode(
        np.clip(module.gltf(wo, wi, *given, np.full(n, r)) * cosine, 0, 1)
    )
    panels[0].imshow(picture)
    panels[0].set_title("plastic, roughness 0.35")
    # Linear between -0.1 and 0.1, logarithmic beyond: the middle is 20 times the ring.
    scale = SymLogNorm(0.1, vmin=-float(np.abs(slope).max()), vmax=float(np.abs(slope).max()))
    for axes, values, title in (
        (panels[1], slope, "∂ brightness / ∂ roughness"),
        (panels[2], error, "finite difference minus that"),
    ):
        field = np.full((size, size), np.nan)
        field[inside] = values
        image = axes.imshow(field, cmap=signed_color_map(), norm=scale)
        lit = np.zeros((size, size))
        lit[inside] = ~dark
        axes.contour(inside, [0.5], colors=GRAY, linewidths=0.7)
        axes.contour(np.where(inside, lit, np.nan), [0.5], colors=GRAY, linewidths=0.7)
        axes.set_title(title)
    for axes in panels:
        axes.set_axis_off()
    ticks = (-5, -1, -0.1, 0, 0.1, 1, 5)
    figure.colorbar(image, ax=panels[1:], shrink=0.8, ticks=ticks, format="%g")
    return figure, facts


FIGURES = figures_of(
    fig1_chart,
    fig2_solid_angle,
    fig3_furnace,
    fig4_facets,
    fig5_cap,
    fig6_samples,
    fig7_by_roughness,
)

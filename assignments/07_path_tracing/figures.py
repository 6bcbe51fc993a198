"""The figures of assignment 07, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from figure_parts import UP
from matplotlib.figure import Figure
from photograd_course.viz.handout import Array, Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes, signed_color_map
from photograd_course.viz.style import RED as CRIMSON

GAMMA = parts.FIGURE_1.GAMMA


def fig1_result(module: ModuleType) -> tuple[Figure, Facts]:
    """A room with all bounces and with direct light; a table, and what was recovered of it."""
    figure, found = parts.FIGURE_1.draw(module)
    facts: Facts = {
        "direct light leaves the ceiling black": Fact(
            found["direct light leaves the ceiling black"], 0.0, 1e-9
        ),
        "bounces light it": Fact(found["bounces light it"], 0.02, 1.0),
        "the recovered table looks like the truth": Fact(
            found["the recovered table looks like the truth"], 0.0, 0.1
        ),
        "and has its numbers within 0.02": Fact(
            found["and has its numbers within 0.02"], 0.0, 0.02
        ),
    }
    return figure, facts


def fig2_measure(module: ModuleType) -> tuple[Figure, Facts]:
    """Irradiance below a light, by the density of the handout and by two wrong ones."""
    aside = np.linspace(0.0, 4.0, 33)
    light = module.rectangle([-0.5, 2, -0.5], [1, 0, 0], [0, 0, 1], emission=1.0)
    scene = module.assemble([light])
    x, w = np.polynomial.legendre.leggauss(6)
    u, v = np.meshgrid((x + 1) / 2, (x + 1) / 2, indexing="ij")
    u3 = np.stack([0 * u.ravel(), u.ravel(), v.ravel()], axis=1)
    weights = np.outer(w, w).ravel() / 4
    ours, by_area, no_cosine, right = [], [], [], []
    for s in aside:
        points = np.tile([s, 0.0, 0.0], (36, 1))
        wi, distance, primitive = module.sample_light(scene, points, u3)
        pdf = module.light_pdf(scene, primitive, wi, distance)
        cosine = wi @ UP
        ours.append(weights @ (cosine / np.where(pdf > 0, pdf, 1)))
        by_area.append(weights @ cosine)
        no_cosine.append(weights @ (cosine / distance**2))
        right.append(parts.irradiance(np.array([[a - s, 2, b] for a, b in _SQUARE])))
    ours, by_area, no_cosine, right = (np.array(e) for e in (ours, by_area, no_cosine, right))
    facts: Facts = {
        "dots on the line": Fact(np.abs(ours / right - 1).max(), 0.0, 1e-6),
        "per area 4 times too bright or more": Fact((by_area / right).min(), 4.0, 8.0),
        "more than 40 times at 4 m": Fact(by_area[-1] / right[-1], 40.0, 48.0),
        "without the cosine right below the light": Fact(no_cosine[0] / right[0], 1.0, 1.1),
        "at 4 m twice as bright or more": Fact(no_cosine[-1] / right[-1], 2.0, 3.0),
    }
    figure, (sketch, axes) = subplots(7.0, 2.9, 1, 2, width_ratios=(1, 1.35))
    parts.draw_solid_angle(sketch)
    axes.semilogy(aside, right, color=GRAY)
    axes.semilogy(aside[::2], np.maximum(ours, 1e-9)[::2], "o", color=BLUE, markersize=4)
    axes.semilogy(aside, by_area, color=CRIMSON)
    axes.semilogy(aside, no_cosine, color=ORANGE)
    note(axes, "density per area", (2.2, by_area[18]), (0, 5), color=CRIMSON)
    note(axes, "without cos′", (2.6, no_cosine[21]), (0, 8), color=ORANGE)
    note(axes, "yours, and Lambert's formula", (0.1, 0.03), (0, 0), color=BLUE)
    axes.set(xlabel="horizontal distance  [m]", ylabel="irradiance / radiance", ylim=(5e-3, 2))
    plain_axes(axes)
    return figure, facts


def fig3_strategies(module: ModuleType) -> tuple[Figure, Facts]:
    """Four strips of metal below a light, by three strategies; their noise."""
    roughness, width, height, samples, shown_ones = (0.2, 0.3, 0.5, 0.8), 84, 58, 16, 4
    strips = [
        module.rectangle(
            [-1 + 0.5 * k, 0, -1],
            [0, 0, 2],
            [0.5, 0, 0],
            base_color=0.8,
            metalness=1.0,
            roughness=each,
        )
        for k, each in enumerate(roughness)
    ]
    light = module.rectangle([-1, 0.4, -1.4], [2, 0, 0], [0, 0.6, 0.3], emission=1.5)
    scene = module.assemble([*strips, light])
    origins, directions = module.camera_rays(width, height, [0, 1.3, 1.7], [0, 0, -0.1], 48)
    hit = module.closest_hit(scene, origins, directions)
    on = (hit["primitive"] >= 0) & (hit["primitive"] < 4)
    rng = np.random.default_rng(3)
    many = module.repeated(module.take(hit, on), samples)
    u = rng.random((2, len(many["primitive"]), 3))
    pictures = [*parts.alone(module, scene, many, *u), module.direct_light(scene, many, *u)]
    pictures = [p[:, 0].reshape(-1, samples) for p in pictures]
    strip = hit["primitive"][on]
    # Error of a sample over the brightness of the strip, both as root mean squares: dark pixels, of
    # which a smooth strip has many, count little in either.
    bright = pictures[2].mean(axis=1)
    spread = np.array(
        [
            [
                np.sqrt(p[strip == k].var(axis=1, ddof=1).mean() / (bright[strip == k] ** 2).mean())
                for k in range(4)
            ]
            for p in pictures
        ]
    )
    means = np.array([[p[strip == k].mean() for k in range(4)] for p in pictures])
    best = spread[:2].min(axis=0)
    facts: Facts = {
        "light sampling: noisy where it is smooth": Fact(spread[0, 0] / spread[0, 3], 3.0, 30.0),
        "BSDF sampling: noisy where it is rough": Fact(spread[1, 3] / spread[1, 0], 1.5, 10.0),
        "its tallest bar is the rough strip's": Fact(spread[1].argmax() == 3),
        "smooth: light sampling is noisier": Fact(spread[0, 0] / spread[1, 0], 1.5, 30.0),
        "rough: BSDF sampling is noisier": Fact(spread[1, 3] / spread[0, 3], 1.5, 30.0),
        "both: never much worse than the better one": Fact((spread[2] / best).max(), 0.2, 1.3),
        "smooth: the mean of BSDF sampling": Fact(means[2, 0] / means[1, 0], 0.8, 1.25),
        "rough: the mean of light sampling": Fact(means[2, 3] / means[0, 3], 0.8, 1.25),
    }
    figure, axes = subplots(7.0, 3.6, 2, 3, height_ratios=(1.5, 1))
    for column, (name, p) in enumerate(
        zip(("light sampling", "BSDF sampling", "both (MIS)"), pictures, strict=True)
    ):
        shown = np.zeros(width * height)
        shown[on] = p[:, :shown_ones].mean(axis=1)
        shown[hit["primitive"] == 4] = 1.5
        gray = np.clip(shown.reshape(height, width), 0, 1) ** GAMMA
        axes[0, column].imshow(gray, cmap="gray", vmin=0, vmax=1)
        axes[0, column].set(xticks=[], yticks=[], title=name)
        for k, each in enumerate(roughness):  # the roughness of the strip, at its front edge
            low = np.flatnonzero(on)[strip == k].max() // width
            row = np.flatnonzero(on)[strip == k]
            middle = np.median(row[row // width == low] % width)
            axes[0, column].text(middle, low - 2, str(each), color="white", ha="center", fontsize=7)
        axes[1, column].bar(range(4), spread[column], color=(ORANGE, GRAY, BLUE)[column])
        axes[1, column].set(yscale="log", ylim=(0.5, 20), xlabel="roughness")
        axes[1, column].set_xticks(range(4), [str(r) for r in roughness])
    axes[1, 0].set(ylabel="noise / brightness")
    return figure, facts


def fig4_furnace(module: ModuleType) -> tuple[Figure, Facts]:
    """A furnace room by depth: mean, vertices per path and cost, with roulette and without."""
    albedo, depths = 0.4, np.array([2, 3, 5, 8, 12])
    rng = np.random.default_rng(5)
    room, origins, directions = parts.furnace(module, albedo, 2500, rng)
    closest_hit, always = module.closest_hit, module.ALWAYS
    found = []
    for limit in (always, 99):
        counted = [0]

        def watched(scene: object, o: Array, d: Array, counted: list[int] = counted) -> object:
            counted[0] += len(o)
            return closest_hit(scene, o, d)

        rows = []
        for depth in depths:
            counted[0] = 0
            module.ALWAYS, module.closest_hit = limit, watched
            seen = module.trace_paths(room, origins, directions, int(depth), rng)[:, 0]
            module.ALWAYS, module.closest_hit = always, closest_hit
            # Three rays start at each vertex: two for direct light, one to continue.
            visited = counted[0] / len(origins) / 3
            rows.append((seen.mean(), seen.std() / np.sqrt(len(seen)), visited, seen.var()))
        found.append(np.array(rows).T)
    right = (1 - albedo**depths) / (1 - albedo)
    # The light of depths 2, 3, ... once more, where each vertex but the last adds its emission.
    double = right + (1 - albedo ** (depths - 1)) / (1 - albedo) - 1
    off = max(float((np.abs(m - right) / np.maximum(e, 1e-6)).max()) for m, e, *_ in found)
    prices = [variance * visited for _, _, visited, variance in found]
    facts: Facts = {
        "the means agree with the series": Fact(off, 0.0, 4.5),
        "counted twice: right at depth 2, too bright from 3 on": Fact(
            abs(double[0] - right[0]) < 1e-9 and double[1] > 1.2 * right[1]
        ),
        "with roulette below 4 vertices": Fact(found[0][2][-1], 2.0, 4.0),
        "without it as many as the depth allows": Fact(found[1][2][-1], 10.0, 13.0),
        "more expensive at depth 8": Fact((prices[0] / prices[1])[3], 1.1, 2.0),
        "about even at depth 12": Fact((prices[0] / prices[1])[4], 0.7, 1.4),
    }
    figure, axes = subplots(7.0, 2.6, 1, 3, width_ratios=(1.3, 1, 1))
    axes[0].plot(depths, right, color=GRAY, zorder=0)
    axes[0].plot(depths, double, "x", color=CRIMSON, markersize=5)
    note(axes[0], "emission added\nat every hit", (5, double[2]), (6, -18), color=CRIMSON)
    for k, (name, color) in enumerate((("roulette", BLUE), ("none", ORANGE))):
        mean, error, visited, _ = found[k]
        style = {"color": color, "marker": "os"[k], "markersize": 4}
        axes[0].errorbar(depths + 0.3 * k - 0.15, mean, 3 * error, linestyle="", **style)
        axes[1].plot(depths, visited, label=name, **style)
        axes[2].plot(depths, prices[k], **style)
    axes[1].legend(frameon=False)
    titles = ("mean radiance", "vertices per path", "variance × vertices")
    for each, title in zip(axes, titles, strict=True):
        each.set(xlabel="depth", title=title, xticks=depths)
        plain_axes(each)
    return figure, facts


def fig5_gradient(module: ModuleType) -> tuple[Figure, Facts]:
    """The gradient with respect to roughness, and a fit with shared random numbers."""
    rng = np.random.default_rng(6)
    values, n = np.linspace(0.25, 0.75, 6), 1200
    place = {
        "points": np.array([[0.1, 0, 0.1]]),
        "normals": UP[None],
        "primitive": np.array([0]),
        "wo": np.array([[0, 0.8, 0.6]]),
        "front": np.array([True]),
        "t": np.ones(1),
    }
    hit, d = module.repeated(place, n), np.full((n, 3), 1 / (3 * n))
    ours, wrong, right, errors = [], [], [], []
    for value in values:
        scene = module.demo_table(roughness=value)
        u = rng.random((2, n, 3))
        batches = [
            module.direct_light_backward(
                scene, module.take(hit, rows), u[0, rows], u[1, rows], d[rows]
            )[1][0]
            for rows in np.arange(n).reshape(15, -1)
        ]
        ours.append(sum(batches))
        errors.append(float(np.std(batches) * np.sqrt(15)))
        wrong.append(ours[-1] + parts.through_density(module, scene, hit, u[1], value))
        ends = [
            parts.fine(module, module.demo_table(roughness=value + e), place) for e in (1e-3, -1e-3)
        ]
        right.append((ends[0] - ends[1]) / 2e-3)
    ours, wrong, right, errors = (np.array(each) for each in (ours, wrong, right, errors))
    tracks = [parts.descent(module, shared) for shared in (False, True)]
    facts: Facts = {
        "dots on the line": Fact((np.abs(ours - right) / errors).max(), 0.0, 4.5),
        "crosses are not": Fact((np.abs(wrong - right) / errors).max(), 6.0, 1e4),
        "independent numbers settle at the truth": Fact(tracks[0][-40:].mean(), 0.57, 0.63),
        "shared ones about a quarter too dark": Fact(1 - tracks[1][-40:].mean() / 0.6, 0.2, 0.3),
    }
    figure, (left, side) = subplots(7.0, 2.8, 1, 2)
    left.plot(values, right, color=GRAY)
    left.errorbar(values, ours, 2 * errors, fmt="o", color=BLUE, markersize=4)
    left.plot(values, wrong, "x", color=CRIMSON)
    left.set(xlabel="roughness", title="∂ radiance / ∂ roughness")
    side.axhline(0.6, color=GRAY)
    side.plot(tracks[0], color=BLUE, linewidth=1)
    side.plot(tracks[1], color=CRIMSON, linewidth=1)
    note(side, "shared random numbers", (60, tracks[1][60]), (10, -14), color=CRIMSON)
    note(side, "independent random numbers", (30, 0.66), (0, 8), color=BLUE)
    side.set(xlabel="step", title="base color", ylim=(0.25, 0.75))
    for each in (left, side):
        plain_axes(each)
    return figure, facts


def fig6_recover(module: ModuleType) -> tuple[Figure, Facts]:
    """The table and two derivatives of its pixels; a fit, and that of the core."""
    truth, rays = module.demo_table(), module.table_rays()
    picture, slope, core = module.core_answers()
    rng = np.random.default_rng(7)
    mine = module.by_roughness(truth, 0, *rays, rng).reshape(7, 10)
    seen = parts.table(module, truth, (10, 7), rng, 4)
    start = module.demo_table((0.5, 0.5, 0.5), 0.6)
    color, rough, track = module.recover(start, 0, *rays, picture.reshape(70, 3), 45, rng)
    exact, found = np.array([0.8, 0.5, 0.2, 0.35]), np.append(color, rough)
    shown = parts.table(module, truth, (60, 42), rng)
    by_red, by_rough = parts.table_derivatives(module, (60, 42), rng)
    facts: Facts = {
        "your image is the core's": Fact(parts.apart(seen, picture), 0.0, 0.1),
        "your gradient is the core's": Fact(parts.apart(mine, slope), 0.0, 0.35),
        "wider highlights are dimmer in the middle": Fact(by_rough[21:30, 20:40].min(), -20, -1),
        "more red is brighter everywhere": Fact(by_red.min(), 0.0, 20.0),
        "base color found within 0.02": Fact(np.abs(found - exact)[:3].max(), 0.0, 0.02),
        "roughness found within 0.02": Fact(abs(found - exact)[3], 0.0, 0.02),
        "the core as well": Fact(np.abs(core - exact).max(), 0.0, 0.02),
    }
    figure = Figure(figsize=(7.0, 4.2), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(1, 1))
    axes = above.subplots(1, 3)
    axes[0].imshow(np.clip(shown / 2, 0, 1) ** GAMMA)
    for each, values in zip(axes[1:], (by_red, by_rough), strict=True):
        top = np.quantile(np.abs(values), 0.98)
        each.imshow(values, cmap=signed_color_map(), vmin=-top, vmax=top)
    names = ("your image", "∂ red / ∂ red of the table", "∂ / ∂ roughness")
    for each, name in zip(axes, names, strict=True):
        each.set(xticks=[], yticks=[], title=name)
    axis = below.subplots()
    for k, color in enumerate((CRIMSON, "#4a8f3c", BLUE, INK)):
        axis.axhline(exact[k], color=color, linewidth=0.7, linestyle=":")
        axis.plot(np.arange(1, 46), track[:, k], color=color)
        axis.plot([46], [core[k]], "x", color=color)
        note(axis, ("red", "green", "blue", "roughness")[k], (24, track[24, k]), (3, 4))
    axis.set(xlabel="step", ylim=(0, 1))
    plain_axes(axis)
    return figure, facts


_SQUARE = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))


FIGURES = figures_of(
    fig1_result, fig2_measure, fig3_strategies, fig4_furnace, fig5_gradient, fig6_recover
)
RED = {
    "fig1_result": "back_sign",
    "fig2_measure": "pdf_no_cosine",
    "fig3_strategies": "direct_weights_exchanged",
    "fig4_furnace": "roulette_no_division",
    "fig5_gradient": "back_density_too",
    "fig6_recover": "back_sign",
}

"""The figures of assignment 07, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from figure_parts import UP
from matplotlib.figure import Figure
from photograd_course.viz.handout import Array, Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes
from photograd_course.viz.style import RED as CRIMSON

GAMMA = 1 / 2.2


def fig1_measure(module: ModuleType) -> tuple[Figure, Facts]:
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
    figure, axes = subplots(7.0, 2.9)
    axes.semilogy(aside, right, color=GRAY)
    axes.semilogy(aside[::2], np.maximum(ours, 1e-9)[::2], "o", color=BLUE, markersize=4)
    axes.semilogy(aside, by_area, color=CRIMSON)
    axes.semilogy(aside, no_cosine, color=ORANGE)
    note(axes, "density per area", (2.6, by_area[21]), (0, 5), color=CRIMSON)
    note(axes, "without the cosine at the light", (2.6, no_cosine[21]), (0, 8), color=ORANGE)
    note(axes, "yours, and Lambert's formula", (1.2, right[10]), (-60, -24), color=BLUE)
    axes.set(xlabel="horizontal distance  [m]", ylabel="irradiance / radiance", ylim=(5e-3, 2))
    plain_axes(axes)
    return figure, facts


def fig2_strategies(module: ModuleType) -> tuple[Figure, Facts]:
    """Four strips of metal below a light, by three strategies; their noise."""
    roughness, width, height, samples, shown_ones = (0.2, 0.3, 0.5, 0.8), 40, 28, 64, 4
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
    figure, axes = subplots(7.0, 3.6, 2, 3, height_ratios=(1.3, 1))
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
            axes[0, column].text(middle, low - 1, str(each), color="white", ha="center", fontsize=7)
        axes[1, column].bar(range(4), spread[column], color=(ORANGE, GRAY, BLUE)[column])
        axes[1, column].set(yscale="log", ylim=(0.5, 20), xlabel="roughness")
        axes[1, column].set_xticks(range(4), [str(r) for r in roughness])
    axes[1, 0].set(ylabel="noise / brightness")
    return figure, facts


def fig3_depth(module: ModuleType) -> tuple[Figure, Facts]:
    """A room at three depths; a furnace room by depth."""
    scene = module.demo_room()
    width, height, samples = 36, 30, 9
    rays = module.camera_rays(width, height, [0, 1, 3.4], [0, 1, 0], 38)
    rng = np.random.default_rng(4)
    pictures = []
    for depth in (1, 2, 5):
        many = [np.repeat(each, 1 if depth == 1 else samples, axis=0) for each in rays]
        seen = module.trace_paths(scene, *many, depth, rng)
        pictures.append(seen.reshape(height * width, -1, 3).mean(axis=1))
    albedo, depths = 0.6, np.arange(1, 8)
    room, origins, directions = parts.furnace(module, albedo, 700, rng)
    means, errors, double = [], [], []
    for depth in depths:
        seen = module.trace_paths(room, origins, directions, int(depth), rng)[:, 0]
        means.append(seen.mean())
        errors.append(seen.std() / np.sqrt(len(seen)))
        powers = albedo ** np.arange(depth)
        double.append(powers.sum() + powers[1:-1].sum())
    right = (1 - albedo**depths) / (1 - albedo)
    off = np.abs(np.array(means) - right) / np.maximum(errors, 1e-3)
    ceiling = [float(each.reshape(height, width, 3)[0, 12:24].mean()) for each in pictures[1:]]
    facts: Facts = {
        "depth 1 is the light alone": Fact((pictures[0].sum(axis=1) > 0).mean(), 0.003, 0.1),
        "direct light leaves the ceiling black": Fact(ceiling[0], 0.0, 1e-9),
        "bounces light it": Fact(ceiling[1], 0.02, 1.0),
        "dots on the line": Fact(off.max(), 0.0, 4.5),
        "counted twice: too bright from depth 3 on": Fact(
            abs(double[1] - right[1]) < 1e-9 and double[2] > 1.2 * right[2]
        ),
    }
    figure, axes = subplots(7.0, 2.3, 1, 4, width_ratios=(1, 1, 1, 1.4))
    for k, (depth, picture) in enumerate(zip((1, 2, 5), pictures, strict=True)):
        shown = np.clip(picture.reshape(height, width, 3), 0, 1) ** GAMMA
        axes[k].imshow(shown)
        axes[k].set(xticks=[], yticks=[], title=f"depth {depth}")
    axes[3].plot(depths, right, color=GRAY)
    axes[3].plot(depths, means, "o", color=BLUE, markersize=4)
    axes[3].plot(depths, double, "x", color=CRIMSON, markersize=5)
    axes[3].set(xlabel="depth", title="radiance of a furnace", ylim=(0.8, 4.2))
    plain_axes(axes[3])
    return figure, facts


def fig4_roulette(module: ModuleType) -> tuple[Figure, Facts]:
    """Mean, vertices per path and cost, with roulette and without."""
    albedo, depths = 0.4, np.array([2, 4, 8, 12])
    rng = np.random.default_rng(5)
    room, origins, directions = parts.furnace(module, albedo, 2500, rng)
    closest_hit, always = module.closest_hit, module.ALWAYS
    means, visits, prices = [], [], []
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
            rows.append(
                (seen.mean(), seen.std() / np.sqrt(len(seen)), visited, seen.var() * visited)
            )
        mean, error, visited, price = np.array(rows).T
        means.append((mean, error))
        visits.append(visited)
        prices.append(price)
    right = (1 - albedo**depths) / (1 - albedo)
    off = max(float((np.abs(m - right) / np.maximum(e, 1e-6)).max()) for m, e in means)
    facts: Facts = {
        "the means agree with the series": Fact(off, 0.0, 4.5),
        "with roulette below 4 vertices": Fact(visits[0][-1], 2.0, 4.0),
        "without it as many as the depth allows": Fact(visits[1][-1], 10.0, 13.0),
        "more expensive at depth 8": Fact((prices[0] / prices[1])[2], 1.1, 2.0),
        "about even at depth 12": Fact((prices[0] / prices[1])[3], 0.7, 1.4),
    }
    figure, axes = subplots(7.0, 2.4, 1, 3)
    for k, (name, color) in enumerate((("roulette", BLUE), ("none", ORANGE))):
        shift = 0.12 * (2 * k - 1)
        axes[0].errorbar(
            depths + shift, means[k][0], 3 * means[k][1], fmt="o", color=color, markersize=4
        )
        axes[1].plot(depths, visits[k], color=color, marker="o", markersize=4, label=name)
        axes[2].plot(depths, prices[k], color=color, marker="o", markersize=4)
    axes[0].plot(depths, right, color=GRAY, zorder=0)
    axes[1].legend(frameon=False)
    for each, title in zip(axes, ("mean", "vertices per path", "variance × vertices"), strict=True):
        each.set(xlabel="depth", title=title)
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
    """The table by the submission and by the core; a fit."""
    truth, rays = module.demo_table(), module.table_rays()
    picture, slope, core = module.core_answers()
    rng = np.random.default_rng(7)
    hit = module.closest_hit(truth, *rays)
    on = hit["primitive"] == 0
    pixels, each = int(on.sum()), module.SIDE**2
    many = module.repeated(module.take(hit, on), each)
    seen = np.zeros((70, 3))
    for _ in range(4):
        u = module.strata(rng, pixels), module.strata(rng, pixels)
        seen[on] += module.direct_light(truth, many, *u).reshape(pixels, each, 3).mean(axis=1) / 4
    mine = module.by_roughness(truth, 0, *rays, rng).reshape(7, 10)
    start = module.demo_table((0.5, 0.5, 0.5), 0.6)
    color, rough, track = module.recover(start, 0, *rays, picture.reshape(70, 3), 45, rng)
    exact = np.array([0.8, 0.5, 0.2, 0.35])
    found = np.append(color, rough)
    facts: Facts = {
        "your image is the core's": Fact(parts.apart(seen.reshape(7, 10, 3), picture), 0.0, 0.1),
        "your gradient is the core's": Fact(parts.apart(mine, slope), 0.0, 0.35),
        "base color found within 0.02": Fact(np.abs(found - exact)[:3].max(), 0.0, 0.02),
        "roughness found within 0.02": Fact(abs(found - exact)[3], 0.0, 0.02),
        "the core as well": Fact(np.abs(core - exact).max(), 0.0, 0.02),
    }
    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(1, 1.25))
    axes = above.subplots(1, 4)
    for each, shown in zip(axes, (seen.reshape(7, 10, 3), picture), strict=False):
        each.imshow(np.clip(shown / 2, 0, 1) ** GAMMA)
    for each, shown in zip(axes[2:], (mine, slope), strict=True):
        each.imshow(shown, cmap="RdBu_r", vmin=-3, vmax=3)
    for each, name in zip(
        axes, ("yours", "the core's", "your gradient", "the core's"), strict=True
    ):
        each.set(xticks=[], yticks=[], title=name)
    axis = below.subplots()
    for k, color in enumerate((CRIMSON, "#4a8f3c", BLUE, INK)):
        axis.axhline(exact[k], color=color, linewidth=0.7, linestyle=":")
        axis.plot(np.arange(1, 46), track[:, k], color=color)
        axis.plot([46], [core[k]], "x", color=color)
    for k, name in enumerate(("red", "green", "blue", "roughness")):
        note(axis, name, (24, track[24, k]), (3, 4))
    axis.set(xlabel="step", ylim=(0, 1))
    plain_axes(axis)
    return figure, facts


_SQUARE = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))


FIGURES = figures_of(
    fig1_measure, fig2_strategies, fig3_depth, fig4_roulette, fig5_gradient, fig6_recover
)
RED = {
    "fig1_measure": "pdf_no_cosine",
    "fig2_strategies": "direct_weights_exchanged",
    "fig3_depth": "trace_double_emission",
    "fig4_roulette": "roulette_no_division",
    "fig5_gradient": "back_density_too",
    "fig6_recover": "back_sign",
}

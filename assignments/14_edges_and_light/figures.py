"""The figures of assignment 14, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.handout import Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes, signed_color_map
from photograd_course.viz.style import RED as CRIMSON

SIGNED = signed_color_map()


def fig1_result(module: ModuleType) -> tuple[Figure, Facts]:
    """A caustic of two letters; its lens; a silhouette and a stroke, recovered."""
    figure, found = parts.FIGURE_1.draw(module)
    facts: Facts = {
        "the design has the letters": Fact(found["the design has the letters"], 0.98, 1.0),
        "with nine times the rays as well": Fact(
            found["with nine times the rays as well"], 0.9, 1.0
        ),
        "the outline overlaps by 0.97 or more": Fact(
            found["the outline overlaps by 0.97 or more"], 0.97, 1.0
        ),
        "the width within 1 %": Fact(found["the width within 1 %"], 0, 0.01),
    }
    return figure, facts


def fig2_coverage(module: ModuleType) -> tuple[Figure, Facts]:
    """Area of a pixel by offset, and both derivatives."""
    offsets, angles = np.linspace(-0.8, 0.8, 161), np.radians([0, 25, 45])
    curves = [module.edge_coverage(np.full(161, angle), offsets) for angle in angles]
    coarse = np.linspace(-0.66, 0.66, 12)
    dots = np.array([[parts.samples_of(s, angle) for s in coarse] for angle in angles])
    step, turn = 0.02, 0.02
    lengths = np.array(
        [
            [
                (parts.samples_of(s + step, a) - parts.samples_of(s - step, a)) / (2 * step)
                for s in coarse
            ]
            for a in angles
        ]
    )
    at, rotations = (0.1, 0.3), np.radians(np.linspace(-90, 90, 181))
    few = np.radians(np.linspace(-80, 80, 17))
    by_angle = [module.edge_coverage(rotations, np.full(181, s))[2] for s in at]
    turned = np.array(
        [
            [
                (parts.samples_of(s, a + turn) - parts.samples_of(s, a - turn)) / (2 * turn)
                for a in few
            ]
            for s in at
        ]
    )
    mine = np.array([module.edge_coverage(np.full(12, a), coarse) for a in angles])
    angular = np.array([module.edge_coverage(few, np.full(17, s))[2] for s in at])
    middle = module.edge_coverage(np.radians([0.0, 45, 20]), np.array([0.3, 0.3, 0.0]))[2]
    away = np.abs(np.abs(coarse) - 0.5) > 0.05
    facts: Facts = {
        "dots on the lines of the area": Fact(np.abs(mine[:, 0] - dots).max(), 0, 3e-3),
        "the longest edge is the diagonal": Fact(curves[2][1].max(), 1.41, 1.4143),
        "dots on the lengths": Fact(np.abs(mine[:, 1] - lengths)[:, away].max(), 0, 0.06),
        "dots on the derivatives of the angle": Fact(np.abs(angular - turned).max(), 0, 0.04),
        "it vanishes by symmetry": Fact(np.abs(middle).max(), 0, 1e-9),
        "and nowhere else is it 0": Fact(np.abs(np.array(by_angle)).max(), 0.05, 1.0),
    }
    figure, axes = subplots(7.0, 2.6, 1, 3)
    for angle, color, (area, length, _), dot, measured in zip(
        angles, (BLUE, ORANGE, INK), curves, dots, lengths, strict=True
    ):
        axes[0].plot(offsets, area, color=color, label=f"{np.degrees(angle):.0f}°")
        axes[0].plot(coarse, dot, "o", color=color, markersize=2.5)
        axes[1].plot(offsets, length, color=color)
        axes[1].plot(coarse[away], measured[away], "o", color=color, markersize=2.5)
    axes[0].step([-0.8, 0, 0.8], [0, 0, 1], color=CRIMSON, linewidth=1, linestyle="--")
    note(axes[0], "one sample", (0, 0.06), (6, 0), color=CRIMSON, fontsize=7)
    axes[0].legend(loc="upper left")
    for values, dot, color, s in zip(by_angle, turned, (BLUE, ORANGE), at, strict=True):
        axes[2].plot(np.degrees(rotations), values, color=color, label=f"offset {s}")
        axes[2].plot(np.degrees(few), dot, "o", color=color, markersize=2.5)
    axes[2].legend(loc="lower left")
    for each, title, label in zip(
        axes,
        ("area", "∂ area / ∂ offset", "∂ area / ∂ angle"),
        ("offset", "offset", "angle [degrees]"),
        strict=True,
    ):
        each.set(title=title, xlabel=label)
        plain_axes(each)
    axes[2].set(xticks=(-90, -45, 0, 45, 90), ylim=(-0.19, 0.13))
    return figure, facts


def fig3_edges(module: ModuleType) -> tuple[Figure, Facts]:
    """Samples on a boundary, the error by their number, five recovered triangles."""
    triangle, rng = parts.TRIANGLE, np.random.default_rng(5)
    white, black, ones = module._white, module._black, np.ones((16, 16, 1))
    x, y = np.roll(triangle, -1, axis=0).T - np.roll(triangle, 1, axis=0).T
    right = np.stack([y, -x], axis=1) / 2
    counts, errors, means = np.array([10, 40, 160, 640, 2560]), [], []
    for n in counts:
        got = np.array(
            [
                module.edge_sampling_backward(triangle, white, black, ones, rng.random(n))
                for _ in range(60)
            ]
        )
        errors.append(np.sqrt(np.mean((got - right) ** 2) / np.mean(right**2)))
        means.append(np.abs(got.mean(axis=0) - right).max() / got.std(axis=0).max() * np.sqrt(60))
    jumps = []
    for n in counts:
        points = rng.uniform(0, 16, (60, n, 2))
        moved = [triangle + step * np.array([[1.0, 0], [0, 0], [0, 0]]) for step in (1e-4, -1e-4)]
        ends = [[parts.inside(each, p).mean() * 256 for p in points] for each in moved]
        jumps.append((np.array(ends[0]) - np.array(ends[1])) / 2e-4)
    idle = np.mean([np.mean(each == 0) for each in jumps[:4]])
    slope = np.polyfit(np.log(counts), np.log(np.maximum(errors, 1e-12)), 1)[0]
    tracks = [
        module.recover_polygon(module.polygon_image(triangle, 16, 16), start, 120, k)
        for k, start in enumerate(parts.starts())
    ]
    worst = max(parts.vertex_error(found, triangle) for found, _ in tracks)
    facts: Facts = {
        "the means are right": Fact(max(means), 0, 5),
        "the error falls like the square root": Fact(slope, -0.6, -0.4),
        "differences of samples are mostly 0": Fact(idle, 0.9, 1.0),
        "each vertex within 0.01 pixels": Fact(worst, 0, 0.01),
    }
    figure, axes = subplots(7.0, 2.7, 1, 3)
    axes[0].imshow(
        module.polygon_image(triangle, 16, 16), cmap="Greys", vmin=0, vmax=2, extent=(0, 16, 16, 0)
    )
    sides = np.roll(triangle, -1, axis=0) - triangle
    length = np.hypot(*sides.T)
    where = np.searchsorted(np.cumsum(length), rng.random(60) * length.sum())
    spots = triangle[where] + rng.random((60, 1)) * sides[where]
    out = np.stack([sides[where, 1], -sides[where, 0]], axis=1) / length[where, None]
    axes[0].quiver(*spots.T, *out.T, angles="xy", scale=18, width=0.006, color=BLUE)
    axes[0].set(xticks=[], yticks=[], title="60 samples")
    axes[1].loglog(counts, errors, "o-", color=BLUE, markersize=4)
    noise = [np.sqrt(np.mean((each - right[0, 0]) ** 2)) / abs(right[0, 0]) for each in jumps]
    axes[1].loglog(counts, np.maximum(noise, 1e-3), "x", color=CRIMSON)
    axes[1].set(xlabel="samples", title="relative error")
    plain_axes(axes[1])
    axes[2].imshow(
        module.polygon_image(triangle, 16, 16), cmap="Greys", vmin=0, vmax=2, extent=(0, 16, 16, 0)
    )
    for _, track in tracks:
        axes[2].plot(*parts.close_up(track[0]).T, color=GRAY, linewidth=0.8)
        for k in range(3):
            axes[2].plot(*track[:, k].T, color=ORANGE, linewidth=1)
    axes[2].plot(*parts.close_up(tracks[0][0]).T, color=BLUE)
    axes[2].set(xticks=[], yticks=[], title="five starts", xlim=(0, 16), ylim=(16, 0))
    return figure, facts


def fig4_stroke(module: ModuleType) -> tuple[Figure, Facts]:
    """A stroke, and two derivatives of each pixel."""
    size = 15
    picture = module.stroke_image(parts.CURVE, parts.WIDTH, size, size)
    by_width, by_point = parts.stroke_derivatives(module, size)
    expected = parts.curve_length(module) + np.pi * parts.WIDTH / 2
    t, distance = module.nearest_on_curve(parts.CURVE, module.pixel_centers(size, size))
    below = module.pixel_centers(size, size)[:, 1] > module.bezier(parts.CURVE, t)[:, 1]
    rim = (distance > 0.6) & (distance < 1.6) & (t > 0.2) & (t < 0.5)
    gains, losses = by_point.ravel()[rim & below], by_point.ravel()[rim & ~below]
    facts: Facts = {
        "wider covers more everywhere": Fact(by_width.min(), -1e-12, 1e-12),
        "the sum is length plus caps": Fact(by_width.sum() / expected, 0.97, 1.03),
        "it is about 19.4": Fact(expected, 19.35, 19.45),
        "downward: below gains": Fact(gains.min(), 0, 1),
        "downward: above loses": Fact(losses.max(), -1, 0),
    }
    figure, axes = subplots(7.0, 2.6, 1, 3)
    axes[0].imshow(picture, cmap="Greys", vmin=0, vmax=1.5, extent=(0, size, size, 0))
    axes[0].plot(*module.bezier(parts.CURVE, np.linspace(0, 1, 60)).T, color=BLUE)
    axes[0].plot(*parts.CURVE.T, "o--", color=ORANGE, markersize=4, linewidth=1)
    axes[0].set(title="a stroke", xlim=(0, size), ylim=(size, -1.5))
    for each, values, title in (
        (axes[1], by_width, "∂ / ∂ width"),
        (axes[2], by_point, "∂ / ∂ y of the middle point"),
    ):
        top = np.abs(values).max()
        each.imshow(values, cmap=SIGNED, vmin=-top, vmax=top, extent=(0, size, size, 0))
        each.set(title=title)
    for each in axes:
        each.set(xticks=[], yticks=[])
    return figure, facts


def fig5_replay(module: ModuleType) -> tuple[Figure, Facts]:
    """The niche, the derivative of its pixels with respect to a wall, two fits."""
    image = parts.niche_image(module, 50, 40, 12, 3)
    replayed, by_steps = parts.wall_derivatives(module, 15, 12, 8)
    reflected = replayed[8:, 5:11]
    target = parts.table_photograph(module)
    start, rays = module.demo_niche((0.5, 0.5, 0.5), 0.45), module.niche_rays(8, 6)
    exact = np.array([0.8, 0.5, 0.2, 0.35])
    deep = module.recover_material(start, 0, *rays, target, 3, 45, 11)
    direct = module.recover_material(start, 0, *rays, target, 2, 45, 11)
    off = np.abs(np.append(deep[0], deep[1]) - exact)
    short = np.abs(np.append(direct[0], direct[1]) - exact)
    facts: Facts = {
        "replay agrees with finite differences": Fact(
            np.linalg.norm(replayed - by_steps) / np.linalg.norm(by_steps), 0, 1e-6
        ),
        "the table reflects the wall": Fact(reflected.max(), 0.005, 1),
        "base color within 0.02": Fact(off[:3].max(), 0, 0.02),
        "roughness within 0.02": Fact(off[3], 0, 0.02),
        "direct light alone: more than 0.05 off": Fact(short.max(), 0.05, 1),
    }
    figure, axes = subplots(7.0, 2.5, 1, 3, width_ratios=(1, 1, 1.2))
    axes[0].imshow(np.clip(image, 0, 1) ** (1 / 2.2))
    axes[0].set(xticks=[], yticks=[], title="your path tracer")
    top = np.quantile(np.abs(replayed), 0.98)
    axes[1].imshow(replayed, cmap=SIGNED, vmin=-top, vmax=top)
    axes[1].set(xticks=[], yticks=[], title="∂ / ∂ red of the wall")
    colors = (CRIMSON, "#4a8f3c", BLUE, INK)
    for k, (color, name) in enumerate(zip(colors, ("red", "green", "blue", "rough"), strict=True)):
        axes[2].axhline(exact[k], color=color, linestyle=":", linewidth=0.8)
        axes[2].plot(deep[2][:, k], color=color)
        axes[2].plot(direct[2][:, k], color=color, linewidth=0.6)
        note(axes[2], name, (44, exact[k]), (4, -3), color=color, fontsize=7)
    axes[2].set(xlabel="step", title="the table, recovered", ylim=(0, 1), xlim=(0, 56))
    plain_axes(axes[2])
    return figure, facts


def fig6_caustic(module: ModuleType) -> tuple[Figure, Facts]:
    """Rays behind a section of the lens, the loss, the gradient of a flat lens."""
    target = module.letters_image(parts.LETTERS, 32)
    heights, losses = module.design_caustic(target, 64, 60)
    points = module.landing_points(heights).reshape(64, 64, 2)
    flat = np.zeros((65, 65))
    landed = module.landing_points(flat)
    residual = module.splat(landed, 32) - target
    d_points = module.splat_backward(landed, 2 * residual / residual.size)
    d_flat = module.landing_backward(flat, d_points)
    first, last = float(np.mean(residual**2)), float(losses[-1])
    facts: Facts = {
        "the loss falls by 20 or more": Fact(first / max(last, 1e-9), 20, 1e6),
        "no light is turned back": Fact(np.isfinite(points).all()),
        "the lens bulges where it is bright": Fact(
            parts.likeness(-d_flat[:64, :64].reshape(32, 2, 32, 2).mean(axis=(1, 3)), target),
            0.3,
            1,
        ),
    }
    figure, axes = subplots(7.0, 2.6, 1, 3)
    row = 24
    x = (np.arange(64) + 0.5) / 64
    for k in range(64):
        axes[0].plot([x[k], points[row, k, 0]], [0, 1], color=ORANGE, linewidth=0.5)
    axes[0].fill_between(
        np.arange(65) / 64, -0.12, 4 * (heights[row] - heights[row].max()), color=BLUE, alpha=0.5
    )
    axes[0].set(
        title="rays to the screen", xlim=(0, 1), ylim=(-0.35, 1.02), xticks=[], yticks=[0, 1]
    )
    axes[0].set_yticklabels(["lens", "screen"])
    for k, size in enumerate((8, 16, 32)):
        axes[1].semilogy(np.arange(60) + 60 * k, losses[60 * k : 60 * k + 60], label=f"{size}²")
    axes[1].set(title="loss", xlabel="step")
    axes[1].legend()
    plain_axes(axes[1])
    top = np.abs(d_flat).max()
    axes[2].imshow(d_flat, cmap=SIGNED, vmin=-top, vmax=top)
    axes[2].set(xticks=[], yticks=[], title="∂ loss / ∂ heights, flat lens")
    return figure, facts


FIGURES = figures_of(fig1_result, fig2_coverage, fig3_edges, fig4_stroke, fig5_replay, fig6_caustic)
RED = {
    "fig1_result": "edges_normal_inward",
    "fig2_coverage": "coverage_angle_sign",
    "fig3_edges": "edges_no_length",
    "fig4_stroke": "stroke_width_not_half",
    "fig5_replay": "replay_bounces_alone",
    "fig6_caustic": "lens_sign",
}

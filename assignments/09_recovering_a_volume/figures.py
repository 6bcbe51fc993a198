"""The figures of assignment 09, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from matplotlib.figure import Figure
from photograd_course.captures import look_at_origin, two_striped_balls
from photograd_course.viz.handout import Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes, signed_color_map


def fig1_result(module: ModuleType) -> tuple[Figure, Facts]:
    """A snowman from its photographs: a held-out view, and the view during the fit."""
    figure, found = parts.FIGURE_1.draw(module)
    facts: Facts = {
        "the fit passes 27 dB on held-out views": Fact(
            found["the fit passes 27 dB on held-out views"], 27, 60
        ),
        "it gets better from picture to picture": Fact(
            found["it gets better from picture to picture"]
        ),
    }
    return figure, facts


def fig2_cameras(module: ModuleType) -> tuple[Figure, Facts]:
    """Cameras around the box from above, and the rays of one row of pixels."""
    size, turn = 7, np.arange(6) * np.pi / 3 + 0.3
    places = 3.8 * np.stack([np.cos(turn), 0 * turn, np.sin(turn)], axis=1)
    poses = np.stack([look_at_origin(place) for place in places])
    views = parts.views_of(np.zeros((6, size, size, 3)), poses)
    row = 3 * size + np.arange(size)
    origins, directions, _ = module.ray_batch(views, row)
    middle = module.ray_batch(views, 3 * size + 3 + np.arange(6) * size**2)
    toward = -np.einsum("ri,ri->r", middle[0], middle[1]) / np.sum(middle[1] ** 2, axis=1)
    miss = np.linalg.norm(middle[0] + toward[:, None] * middle[1], axis=1)
    dots = origins + np.linspace(2.8, 4.8, 3)[:, None, None] * directions
    columns = parts.columns_of(views, 0, dots.reshape(-1, 3)).reshape(3, size)
    facts: Facts = {
        "central rays go through the origin": Fact(miss.max(), 0, 1e-9),
        "dots lie at the centers of their pixels": Fact(
            np.abs(columns - np.arange(size) - 0.5).max(), 0, 1e-9
        ),
    }
    figure, axes = subplots(7.0, 3.6)
    axes.fill([-1, 1, 1, -1], [-1, -1, 1, 1], color=GRAY, alpha=0.25, linewidth=0)
    for ray in range(size):
        ends = origins[ray] + np.array([0, 6.0])[:, None] * directions[ray]
        axes.plot(ends[:, 0], ends[:, 2], color=BLUE, linewidth=0.8)
    axes.plot(dots[..., 0].ravel(), dots[..., 2].ravel(), "o", color=BLUE, markersize=3)
    for k, place in enumerate(places):
        side = look_at_origin(place)[:3, 0]
        wing = place * 0.87 + np.array([-0.34, 0.34])[:, None] * side
        outline = np.stack([place, wing[0], wing[1], place])
        axes.plot(outline[:, 0], outline[:, 2], color=ORANGE if k == 0 else INK, linewidth=1.2)
    axes.annotate("box", (-0.92, 0.68), fontsize=8)
    # x to the right and y towards the reader: a right-handed z goes down.
    axes.set(xlim=(-5.6, 5.6), ylim=(4.1, -4.1), xlabel="x [m]", ylabel="z [m]", aspect="equal")
    plain_axes(axes)
    drawn = axes.yaxis_inverted() and not axes.xaxis_inverted()
    facts["it is the view from above, not from below"] = Fact(drawn)
    return figure, facts


def fig3_tv(module: ModuleType) -> tuple[Figure, Facts]:
    """A view recovered from three photographs with three weights of total variation."""
    scene = two_striped_balls(16, 1.0)
    views = parts.photographs(module, scene, 3, 14)
    unseen = parts.photographs(module, scene, 5, 14, 1.0)
    weights, kept = (0.0, 0.01, 1.0), module.TV
    found = []
    for weight in weights:
        module.TV = weight
        start = module.fog((16, 16, 16))
        found.append(module.fit_volume(views, start, 25, np.random.default_rng(9))[0])
    module.TV = kept
    scores = [parts.score(module, grid, unseen) for grid in found]
    facts: Facts = {
        "0.01 gains more than 1 dB over none": Fact(scores[1] - scores[0], 1, 20),
        "a hundred times as much is worse than none": Fact(scores[2] - scores[0], -30, -0.5),
    }
    large = parts.large_view(module, scene, unseen, 1)
    shown = [("truth", np.asarray(large["pictures"])[0])]
    for k in (0, 1, 2):
        picture = parts.renderings(module, found[k], large).reshape(parts.LARGE, parts.LARGE, 3)
        shown.append((f"TV = {weights[k]:g}: {scores[k]:.1f} dB", picture))
    figure = Figure(figsize=(7.0, 2.1), layout="constrained")
    for axes, (title, picture) in zip(figure.subplots(1, 4), shown, strict=True):
        parts.show(axes, picture, title)
    return figure, facts


def fig4_signs(module: ModuleType) -> tuple[Figure, Facts]:
    """A photograph, a slice of the density, the derivative at fog, and its signs."""
    scene, views = parts.small_scene(module)
    n = len(scene)
    slope = parts.slope_of(module, module.fog((n, n, n)), views)
    signs = module.gradient_sign_map(module.fog((n, n, n)), views)
    inside, outside, other, _ = parts.kinds(module, scene, views)
    where = n // 2
    facts: Facts = {
        "inside over 95 % are negative": Fact(parts.share_of(signs, inside, -1), 0.95, 1),
        "where only background is visible over 95 % are positive": Fact(
            parts.share_of(signs, outside, 1), 0.95, 1
        ),
        "of the other empty voxels far from all are positive": Fact(
            parts.share_of(signs, other, 1), 0.4, 0.8
        ),
    }
    root = np.sign(slope) * np.sqrt(np.abs(slope) / np.abs(slope).max())
    large = parts.large_view(module, scene, views, 2)
    figure, panels = subplots(7.0, 2.1, 1, 4)
    parts.show(panels[0], np.asarray(large["pictures"])[0], "one of six cameras' view")
    panels[1].imshow(scene[:, :, where, 3].T, cmap="gray_r", origin="lower")
    panels[1].set_title("true density, slice")
    for axes, values, title in (
        (panels[2], root, "∂L/∂σ from fog (roots)"),
        (panels[3], signs, "sign map"),
    ):
        axes.imshow(
            values[:, :, where].T,
            cmap=signed_color_map(),
            vmin=-1,
            vmax=1,
            origin="lower",
            interpolation="nearest",
        )
        axes.contour(scene[:, :, where, 3].T, levels=[5], colors=INK, linewidths=0.8)
        axes.set_title(title)
    for axes in panels:
        axes.set(xticks=[], yticks=[])
    return figure, facts


def fig5_why(module: ModuleType) -> tuple[Figure, Facts]:
    """Fraction of positive voxels by how many photographs see a ball through them."""
    scene, views = parts.small_scene(module)
    n = len(scene)
    fog = module.fog((n, n, n))
    *_, blamed = parts.kinds(module, scene, views)
    empty = (scene[..., 3] == 0) & (blamed >= 0)
    later, _ = module.fit_volume(views, fog, 12, np.random.default_rng(9))
    shares = []
    for grid in (fog, later):
        signs = module.gradient_sign_map(grid, views)
        shares.append([parts.share_of(signs, empty & (blamed == k), 1) for k in range(7)])
    start, after = shares
    facts: Facts = {
        "none: all are positive": Fact(start[0], 0.999, 1),
        "all six: few are": Fact(start[6], 0, 0.25),
        "the fraction falls from none to six": Fact(start[0] > start[3] > start[6]),
        "after twelve steps far more are positive from two on": Fact(
            all(after[k] > start[k] + 0.25 for k in range(2, 7))
        ),
    }
    figure, axes = subplots(7.0, 2.7)
    axes.bar(range(7), [100 * s for s in start], color=BLUE, width=0.6, label="from fog")
    axes.plot(range(7), [100 * s for s in after], "o", color=ORANGE, label="after twelve steps")
    axes.set(
        xlabel="photographs that see a ball along a ray through the voxel",
        ylabel="positive [%]",
        ylim=(0, 125),
        xticks=range(7),
    )
    axes.legend(loc="upper right", ncols=2)
    axes.set_axisbelow(True)
    plain_axes(axes)
    return figure, facts


def fig6_wrong(module: ModuleType) -> tuple[Figure, Facts]:
    """PSNR by steps, with a right and with a wrong adjoint."""
    scene = two_striped_balls(20, 1.0)
    views = parts.photographs(module, scene, 12, 14)
    unseen = parts.photographs(module, scene, 3, 14, 1.0)
    marks = (0, 1, 4, 8, 20, 50)
    right = parts.watched(module, views, 20, marks)
    wrong = parts.watched(module, views, 20, marks, hiding=False)
    own, new = ([parts.score(module, grid, each) for grid in right] for each in (views, unseen))
    bad = [parts.score(module, grid, unseen) for grid in wrong]
    at = marks.index(8)
    facts: Facts = {
        "the right one passes 30 dB on held-out views": Fact(new[-1], 30, 60),
        "after eight steps both are less than 1 dB apart": Fact(abs(new[at] - bad[at]), 0, 1),
        "the wrong one still has more than 20 dB": Fact(bad[-1], 20, 40),
        "and is worse than the right one in the end": Fact(new[-1] - bad[-1], 1.5, 40),
        "photographs are matched better than held-out views": Fact(own[-1] > new[-1]),
    }
    figure, axes = subplots(7.0, 2.9)
    axes.plot(marks, own, "o--", color=BLUE, markersize=4)
    axes.plot(marks, new, "o-", color=BLUE, markersize=4)
    axes.plot(marks, bad, "o-", color=ORANGE, markersize=4)
    note(axes, "right adjoint", (marks[-1], new[-1]), (-4, -16), color=BLUE, ha="right")
    note(axes, "no occlusion term", (marks[-1], bad[-1]), (-4, -24), color=ORANGE, ha="right")
    axes.set(xlabel="steps", ylabel="PSNR [dB]", xlim=(0, marks[-1]))
    plain_axes(axes)
    return figure, facts


FIGURES = figures_of(fig1_result, fig2_cameras, fig3_tv, fig4_signs, fig5_why, fig6_wrong)
RED = {
    "fig1_result": "fit_uphill",
    "fig2_cameras": "rays_corner",
    "fig3_tv": "fit_without_tv",
    "fig4_signs": "map_upside_down",
    "fig5_why": "map_upside_down",
    "fig6_wrong": "fit_uphill",
}

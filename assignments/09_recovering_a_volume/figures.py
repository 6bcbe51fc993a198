"""The figures of assignment 09, and the facts that their captions claim."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from photograd_course.captures import all_around, look_at_origin
from photograd_course.viz.handout import Array, Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes, signed_color_map

Views = dict[str, Array | float]
BACKGROUND = np.array([0.04, 0.05, 0.08])
LOW, HIGH = np.full(3, -1.0), np.full(3, 1.0)


def fig1_cameras(module: ModuleType) -> tuple[Figure, Facts]:
    """Cameras around the box from above, and the rays of one row of pixels."""
    size, turn = 7, np.arange(6) * np.pi / 3 + 0.3
    places = 3.8 * np.stack([np.cos(turn), 0 * turn, np.sin(turn)], axis=1)
    views = _views(np.zeros((6, size, size, 3)), np.stack([look_at_origin(p) for p in places]))
    row = 3 * size + np.arange(size)
    origins, directions, _ = module.ray_batch(views, row)
    middle = module.ray_batch(views, 3 * size + 3 + np.arange(6) * size**2)
    toward = -np.einsum("ri,ri->r", middle[0], middle[1]) / np.sum(middle[1] ** 2, axis=1)
    miss = np.linalg.norm(middle[0] + toward[:, None] * middle[1], axis=1)
    dots = origins + np.linspace(2.8, 4.8, 3)[:, None, None] * directions
    columns = _columns(views, 0, dots.reshape(-1, 3)).reshape(3, size)
    corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    edges = np.array([_columns(views, k, corners) for k in range(6)])
    facts: Facts = {
        "central rays go through the origin": Fact(miss.max(), 0, 1e-9),
        "dots lie at the centers of their pixels": Fact(
            np.abs(columns - np.arange(size) - 0.5).max(), 0, 1e-9
        ),
        "corners lie between the first and the last column": Fact(
            np.abs(edges - size / 2).max(), 0, size / 2
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


def fig2_signs(module: ModuleType) -> tuple[Figure, Facts]:
    """A photograph, a slice of the density, the derivative at fog, and its signs."""
    scene, views = _small_scene(module)
    n = len(scene)
    slope = _slope(module, module.fog((n, n, n)), views)
    signs = module.gradient_sign_map(module.fog((n, n, n)), views)
    inside, outside, other, _ = _kinds(module, scene, views)
    where = n // 2
    facts: Facts = {
        "inside over 95 % are negative": Fact(_share(signs, inside, -1), 0.95, 1),
        "where only background is visible over 95 % are positive": Fact(
            _share(signs, outside, 1), 0.95, 1
        ),
        "of the other empty voxels far from all are positive": Fact(
            _share(signs, other, 1), 0.4, 0.8
        ),
    }
    root = np.sign(slope) * np.sqrt(np.abs(slope) / np.abs(slope).max())
    pictures = np.asarray(views["pictures"])
    figure, panels = subplots(7.0, 2.1, 1, 4)
    _show(panels[0], pictures[2], "one of six photographs")
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


def fig3_why(module: ModuleType) -> tuple[Figure, Facts]:
    """Fraction of positive voxels by how many photographs see a ball through them."""
    scene, views = _small_scene(module)
    n = len(scene)
    fog = module.fog((n, n, n))
    *_, blamed = _kinds(module, scene, views)
    empty = (scene[..., 3] == 0) & (blamed >= 0)
    later, _ = module.fit_volume(views, fog, 12, np.random.default_rng(9))
    shares = []
    for grid in (fog, later):
        signs = module.gradient_sign_map(grid, views)
        shares.append([_share(signs, empty & (blamed == k), 1) for k in range(7)])
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


def fig4_fit(module: ModuleType) -> tuple[Figure, Facts]:
    """A held-out view after some steps; PSNR by steps with a right and with a wrong adjoint."""
    scene = _two_balls(20, 1.0)
    views, unseen = _photographs(module, scene, 12, 14), _photographs(module, scene, 3, 14, 1.0)
    marks = (0, 1, 4, 8, 20, 50)
    right = _watched(module, views, 20, marks)
    wrong = _watched(module, views, 20, marks, _without_hiding(module))
    own, new = ([_score(module, grid, each) for grid in right] for each in (views, unseen))
    bad = [_score(module, grid, unseen) for grid in wrong]
    at = marks.index(8)
    facts: Facts = {
        "the right one passes 30 dB on held-out views": Fact(new[-1], 30, 60),
        "after eight steps both are less than 1 dB apart": Fact(abs(new[at] - bad[at]), 0, 1),
        "the wrong one still has more than 20 dB": Fact(bad[-1], 20, 40),
        "and is worse than the right one in the end": Fact(new[-1] - bad[-1], 1.5, 40),
        "photographs are matched better than held-out views": Fact(own[-1] > new[-1]),
    }
    large = _large(module, scene, unseen)
    figure = Figure(figsize=(7.0, 4.6), layout="constrained")
    grid = figure.add_gridspec(2, 4, height_ratios=(1, 1.25))
    shown = [("truth", np.asarray(large["pictures"])[0])]
    for steps in (1, 8, 50):
        found = _rendered(module, right[marks.index(steps)], large).reshape(40, 40, 3)
        shown.append((f"after {steps} step{'s' * (steps > 1)}", found))
    for k, (title, picture) in enumerate(shown):
        _show(figure.add_subplot(grid[0, k]), picture, title)
    axes = figure.add_subplot(grid[1, :])
    axes.plot(marks, own, "o--", color=BLUE, markersize=4)
    axes.plot(marks, new, "o-", color=BLUE, markersize=4)
    axes.plot(marks, bad, "o-", color=ORANGE, markersize=4)
    note(axes, "right adjoint", (marks[-1], new[-1]), (-4, -16), color=BLUE, ha="right")
    note(axes, "no occlusion term", (marks[-1], bad[-1]), (-4, -24), color=ORANGE, ha="right")
    axes.set(xlabel="steps", ylabel="PSNR [dB]", xlim=(0, marks[-1]))
    plain_axes(axes)
    return figure, facts


def fig5_tv(module: ModuleType) -> tuple[Figure, Facts]:
    """A view recovered from three photographs with three weights of total variation."""
    scene = _two_balls(16, 1.0)
    views, unseen = _photographs(module, scene, 3, 14), _photographs(module, scene, 5, 14, 1.0)
    weights, kept = (0.0, 0.01, 1.0), module.TV
    found = []
    for weight in weights:
        module.TV = weight
        start = module.fog((16, 16, 16))
        found.append(module.fit_volume(views, start, 25, np.random.default_rng(9))[0])
    module.TV = kept
    scores = [_score(module, grid, unseen) for grid in found]
    facts: Facts = {
        "0.01 gains more than 1 dB over none": Fact(scores[1] - scores[0], 1, 20),
        "a hundred times as much is worse than none": Fact(scores[2] - scores[0], -30, -0.5),
    }
    large = _large(module, scene, unseen)
    shown = [("truth", np.asarray(large["pictures"])[0])]
    for k in (0, 1, 2):
        picture = _rendered(module, found[k], large).reshape(40, 40, 3)
        shown.append((f"TV = {weights[k]:g}: {scores[k]:.1f} dB", picture))
    figure = Figure(figsize=(7.0, 2.1), layout="constrained")
    for axes, (title, picture) in zip(figure.subplots(1, 4), shown, strict=True):
        _show(axes, picture, title)
    return figure, facts


def _views(pictures: Array, poses: Array) -> Views:
    return {
        "pictures": pictures,
        "world_from_camera": poses,
        "focal": 1.2 * pictures.shape[2],
        "low": LOW,
        "high": HIGH,
        "background": BACKGROUND,
    }


def _columns(views: Views, view: int, points: Array) -> Array:
    """The columns to which points are projected, by equation (5)."""
    pose = np.asarray(views["world_from_camera"])[view]
    x, _, z = ((points - pose[:3, 3]) @ pose[:3, :3]).T
    return views["focal"] * x / z + np.asarray(views["pictures"]).shape[2] / 2


def _two_balls(n: int, scale: float) -> Array:
    """Two striped balls of n^3 voxels."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    grid = np.full((n, n, n, 4), 0.5)
    grid[..., 3] = 0.0
    for middle, radius, paint in (
        ((-0.25, 0.0, 0.1), 0.45, (0.95, 0.7, 0.6)),
        ((0.4, 0.2, -0.25), 0.3, (0.6, 0.75, 0.95)),
    ):
        away = np.linalg.norm(x - scale * np.array(middle), axis=-1)
        inside = np.clip((scale * radius - away) * n / 3 + 0.5, 0, 1)
        here = inside > grid[..., 3] / 10
        stripes = 0.75 + 0.25 * np.sin(x[here] @ np.array([6.0, 8.0, 3.0]))
        grid[here, :3] = stripes[:, None] * paint
        grid[..., 3] = np.maximum(grid[..., 3], 10 * inside)
    return grid


def _rendered(module: ModuleType, grid: Array, views: Views) -> Array:
    chosen = np.arange(np.asarray(views["pictures"])[..., 0].size)
    origins, directions, _ = module.ray_batch(views, chosen)
    return module.render_rays(grid, LOW, HIGH, origins, directions, 32, BACKGROUND)


def _photographs(
    module: ModuleType, grid: Array, count: int, size: int, turn: float = 0.0
) -> Views:
    views = _views(
        np.zeros((count, size, size, 3)),
        np.stack([look_at_origin(3.2 * p) for p in all_around(count, turn, up=1)]),
    )
    views["pictures"] = _rendered(module, grid, views).reshape(count, size, size, 3)
    return views


def _large(module: ModuleType, grid: Array, views: Views) -> Views:
    """One of the views, the second, with 40 x 40 pixels."""
    pose = np.asarray(views["world_from_camera"])[1:2]
    large = _views(np.zeros((1, 40, 40, 3)), pose)
    large["pictures"] = _rendered(module, grid, large).reshape(1, 40, 40, 3)
    return large


def _score(module: ModuleType, grid: Array, views: Views) -> float:
    error = _rendered(module, grid, views) - np.asarray(views["pictures"]).reshape(-1, 3)
    return float(-10 * np.log10(np.mean(error**2)))


def _small_scene(module: ModuleType) -> tuple[Array, Views]:
    scene = _two_balls(16, 0.7)
    return scene, _photographs(module, scene, 6, 14)


def _slope(module: ModuleType, grid: Array, views: Views) -> Array:
    """The derivative with respect to extinction over all pixels."""
    chosen = np.arange(np.asarray(views["pictures"])[..., 0].size)
    origins, directions, truth = module.ray_batch(views, chosen)
    rays = (LOW, HIGH, origins, directions, module.SAMPLES, BACKGROUND)
    _, d_pixels = module.mse_and_cotangent(module.render_rays(grid, *rays), truth)
    return module.render_adjoint(grid, *rays, d_pixels)[0][..., 3]


def _kinds(module: ModuleType, scene: Array, views: Views) -> tuple[Array, Array, Array, Array]:
    """Voxels inside; before background only; other empty ones; how many views see a ball.

    The last is -1 where no ray reads a voxel at all.
    """
    pictures = np.asarray(views["pictures"])
    each = pictures[0, ..., 0].size
    white = np.ones(scene.shape)
    seen, blamed = np.zeros(scene.shape[:3], bool), np.zeros(scene.shape[:3], int)
    for view in range(len(pictures)):
        chosen = view * each + np.arange(each)
        origins, directions, truth = module.ray_batch(views, chosen)
        meets = np.abs(truth - BACKGROUND).max(axis=1) > 1e-3
        rays = (LOW, HIGH, origins, directions, module.SAMPLES, BACKGROUND)
        for which in (np.ones(each), meets):
            weight = which[:, None] * np.ones(3)
            touched = module.render_adjoint(white, *rays, weight)[0][..., 0] > 1e-9
            if which is meets:
                blamed += touched
            else:
                seen |= touched
    blamed[~seen] = -1
    empty = scene[..., 3] == 0
    return scene[..., 3] > 5, blamed == 0, empty & (blamed > 0), blamed


def _share(signs: Array, where: Array, sign: int) -> float:
    return float(np.mean(signs[where] == sign)) if where.any() else float("nan")


def _watched(
    module: ModuleType, views: Views, n: int, marks: tuple[int, ...], adjoint: object = None
) -> list[Array]:
    """The volumes after the marked numbers of steps of one fit, perhaps with another adjoint."""
    passed: list[Array] = []
    kept = module.tv_loss_adjoint, module.render_adjoint

    def spy(grid: Array, eps: float) -> object:
        passed.append(grid.copy())
        return kept[0](grid, eps)

    module.tv_loss_adjoint = spy  # type: ignore[attr-defined]
    module.render_adjoint = adjoint or kept[1]  # type: ignore[attr-defined]
    try:
        start = module.fog((n, n, n))
        last, _ = module.fit_volume(views, start, marks[-1], np.random.default_rng(9))
    finally:
        module.tv_loss_adjoint, module.render_adjoint = kept  # type: ignore[attr-defined]
    return [[*passed, last][k] for k in marks]


def _without_hiding(module: ModuleType) -> Callable[..., tuple[Array, Array]]:
    """The adjoint of 08 without the occlusion term of d_sigma."""
    parts = module.render_adjoint.__globals__

    def adjoint(
        grid: Array,
        low: Array,
        high: Array,
        origins: Array,
        directions: Array,
        n: int,
        background: Array,
        d_pixel: Array,
    ) -> tuple[Array, Array]:
        u, dt = parts["ray_samples"](low, high, origins, directions, n)
        flat = u.reshape(-1, 3)
        samples = parts["trilinear"](grid, flat).reshape(*dt.shape, 4)
        sigma, color = samples[..., 3], samples[..., :3]
        none = np.zeros(len(d_pixel))
        given = (sigma, color, dt, background, d_pixel, none)
        _, d_color, d_background = parts["composite_adjoint"](*given)
        shows = (
            dt * np.exp(-np.cumsum(sigma * dt, axis=1)) * np.einsum("rsc,rc->rs", color, d_pixel)
        )
        d_samples = np.concatenate([d_color, shows[..., None]], axis=2).reshape(-1, 4)
        return parts["trilinear_adjoint"](grid.shape[:3], flat, d_samples), d_background

    return adjoint


def _show(axes: Axes, picture: Array, title: str) -> None:
    axes.imshow(np.clip(picture, 0, 1) ** (1 / 2.2), interpolation="nearest")
    axes.set(xticks=[], yticks=[])
    axes.set_title(title)


FIGURES = figures_of(fig1_cameras, fig2_signs, fig3_why, fig4_fit, fig5_tv)
RED = {
    "fig1_cameras": "rays_corner",
    "fig2_signs": "map_upside_down",
    "fig3_why": "map_upside_down",
    "fig4_fit": "fit_uphill",
    "fig5_tv": "fit_without_tv",
}

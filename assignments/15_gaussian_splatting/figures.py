"""The figures of assignment 15, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from figure_parts import BLACK, HERE, MARKS, WIDE
from matplotlib.figure import Figure
from photograd_course.viz.handout import Fact, Facts, figures_of, subplots
from photograd_course.viz.style import BLUE, GRAY, ORANGE, plain_axes

LARGE = 360  # pixels of the views of Figure 1


def fig1_banana(module: ModuleType) -> tuple[Figure, Facts]:
    """A held-out photograph, its rendering, and novel views, of the scene in `banana.npz`.

    That file is what `explore.py` found with the core: 1200 steps, photographs 320 pixels wide.
    """
    with np.load(HERE / "banana.npz") as kept:
        scene = {name: kept[name].astype(np.float64) for name in kept.files}
    background = scene.pop("background")
    unseen = parts.photographs(LARGE)[1]
    shown = [module.picture(scene, camera, background)[0] for camera, _ in unseen]
    error = [got - truth for got, (_, truth) in zip(shown, unseen, strict=True)]
    score = -10 * np.log10(np.mean(np.square(error)))
    facts: Facts = {"held-out views have more than 23.5 dB": Fact(score, 23.5, 40)}
    novel = []
    for angle in (0.3, 1.7, 3.1, 4.5):
        place = 2.9 * np.array([0.8 * np.sin(angle), 0.6, 0.8 * np.cos(angle)])
        camera = parts.camera_at(place, LARGE // 2, LARGE // 3, 1.7)
        novel.append(module.picture(scene, camera, background)[0])
    figure = Figure(figsize=(7.0, 3.9), layout="constrained")
    grid = figure.add_gridspec(2, 4, height_ratios=(2, 1))
    named = [("held-out photograph", unseen[0][1]), ("your Gaussians", shown[0])]
    for k, (title, picture) in enumerate([*named, *(("novel view", each) for each in novel)]):
        cells = grid[0, 2 * k : 2 * k + 2] if k < 2 else grid[1, k - 2]
        parts.show(figure.add_subplot(cells), picture, title)
    return figure, facts


def fig2_projection(module: ModuleType) -> tuple[Figure, Facts]:
    """Projected points of a Gaussian with its ellipse; its width far outside the image."""
    camera = parts.camera_at(np.array([0.0, 0.0, -4.0]), 64)
    cov, _ = module.covariance(np.array([[0.9, 0.3, -0.2, 0.5]]), np.log([[0.5, 0.15, 0.3]]))
    mean = np.array([[0.25, -0.15, 0.2]])
    mean2d, cov2d, _, _ = module.project(mean, cov, camera)
    rng = np.random.default_rng(15)
    points = mean + rng.standard_normal((4000, 3)) @ np.linalg.cholesky(cov[0]).T
    seen = module.project(points, np.repeat(cov, len(points), axis=0), camera)[0]
    sample = np.cov(seen.T)[[0, 0, 1], [0, 1, 1]]
    ball = np.repeat(0.04 * np.eye(3)[None], 80, axis=0)
    limit = float(module.limits(camera)[1][0])
    slopes = np.linspace(0, 5 * limit, 80)
    places = parts.world(camera, np.stack([3 * slopes, 0 * slopes, 0 * slopes + 3], axis=1))
    widths = [np.sqrt(module.project(places, ball, camera)[1][:, 0])]
    module.MARGIN, kept = 1e3, module.MARGIN  # type: ignore[attr-defined]
    widths.append(np.sqrt(module.project(places, ball, camera)[1][:, 0]))
    module.MARGIN = kept  # type: ignore[attr-defined]
    held, free = widths
    f, root = float(np.asarray(camera["focal"])[0]), np.sqrt(1 + slopes**2)
    facts: Facts = {
        "the points' covariance is cov2d within 6 %": Fact(
            np.linalg.norm(sample - cov2d[0]) / np.linalg.norm(cov2d[0]), 0, 0.06
        ),
        "clamped, the width is constant": Fact(held[-1] / held[slopes > limit][0], 0.999, 1.001),
        "not clamped, it is more than twice as large in the end": Fact(free[-1] / held[-1], 2, 10),
        "not clamped, it is proportional to the root of 1 + u_x^2": Fact(
            np.abs(free / (f * 0.2 / 3 * root) - 1).max(), 0, 1e-9
        ),
    }
    figure, (left, right) = subplots(7.0, 3.0, 1, 2)
    left.plot(*seen[:700].T, ".", color=GRAY, markersize=2)
    for k in (1, 2):
        left.add_patch(parts.ellipse(mean2d[0], cov2d[0], k, edgecolor=BLUE))
    left.plot(*mean2d[0], "o", color=ORANGE, markersize=5)
    left.set(xlim=(0, 64), ylim=(64, 0), aspect="equal", xlabel="column", ylabel="row")
    right.plot(slopes, free, "--", color=ORANGE, label="not clamped")
    right.plot(slopes, held, color=BLUE, label="clamped")
    for place, name in ((32 / f, "edge of the image"), (limit, "limit")):
        right.axvline(place, color=GRAY, linewidth=0.8)
        right.annotate(
            name,
            (place, 14.5),
            (2, 0),
            textcoords="offset points",
            fontsize=7,
            rotation=90,
            va="top",
            color=GRAY,
        )
    right.set(xlabel="t_x / t_z", ylabel="√C_xx [pixels]")
    right.legend()
    for axes in (left, right):
        plain_axes(axes)
    return figure, facts


def fig3_absgrad(module: ModuleType) -> tuple[Figure, Facts]:
    """One splat over two stripes: the gradient of each pixel; fits with density control."""
    n = 16
    camera = parts.camera_at(np.array([0.0, 0.0, -2.0]), n)
    y, x = (np.mgrid[0:n, 0:n] + 0.5).reshape(2, -1)
    pixels = np.stack([x, y], axis=1)
    off = np.abs(x - n / 2)
    truth = np.where((off > 2) & (off < 5), 0.9, 0.05)[:, None] * np.ones(3)
    one = parts.cloud(1, 0.35)
    one["means"][:], one["colors"][:] = 0.0, 0.7
    shown, back = module.render(one, camera, pixels, BLACK)
    d_shown = 2 * (shown - truth) / len(pixels)
    total = back(d_shown)["absgrad"][0]
    single = []
    cov, _ = module.covariance(one["quats"], one["log_scales"])
    mean2d, cov2d, depth, _ = module.project(one["means"], cov, camera)
    for k in range(len(pixels)):
        alpha, back_alpha = module.screen_alpha(
            mean2d, cov2d, one["opacity_logits"], pixels[k, None]
        )
        _, back_blend = module.composite_splats(alpha, one["colors"], depth, BLACK)
        single.append(back_alpha(back_blend(d_shown[k, None])[0])[0][0])
    terms = -np.array(single)
    signed = np.abs(terms.sum(axis=0))
    views = [(camera, truth.reshape(n, n, 3))]
    curves = [
        module.fit(parts.cloud(4, 0.3), views, 120, np.random.default_rng(1), BLACK, max_count, 20)[
            1
        ]
        for max_count in (0, 60)
    ]
    facts: Facts = {
        "the sum along x is less than 5 % of the sum of absolute values": Fact(
            signed[0] / total[0], 0, 0.05
        ),
        "the absolute gradient is the sum of absolute values": Fact(
            total[0] / np.abs(terms[:, 0]).sum(), 1 - 1e-9, 1 + 1e-9
        ),
        "with densify the loss ends below a tenth": Fact(curves[1][-1] / curves[0][-1], 0, 0.1),
    }
    figure, (left, right) = subplots(7.0, 2.9, 1, 2)
    left.imshow(truth.reshape(n, n, 3), extent=(0, n, n, 0))
    left.quiver(
        x,
        y,
        *(terms / np.abs(terms).max()).T,
        angles="xy",
        scale_units="xy",
        scale=0.5,
        color=ORANGE,
        width=0.006,
    )
    for k in (1, 2):
        left.add_patch(parts.ellipse(mean2d[0], cov2d[0], k, edgecolor=BLUE))
    left.set(xticks=[], yticks=[], title="−gradient of the mean, per pixel")
    right.semilogy(curves[0], color=GRAY, label="four Gaussians")
    right.semilogy(curves[1], color=BLUE, label="up to sixty")
    right.set(xlabel="step", ylabel="loss")
    right.legend()
    plain_axes(right)
    return figure, facts


def fig4_fit(module: ModuleType) -> tuple[Figure, Facts]:
    """A held-out view during the fit."""
    scenes, background = parts.fitted(module)
    unseen = parts.photographs(WIDE)[1]
    fine, truth = parts.photographs(2 * WIDE)[1][0][0], unseen[0][1]
    scores = [parts.score_of(module, scene, unseen, background) for scene in scenes]
    counts = [len(scene["means"]) for scene in scenes]
    facts: Facts = {
        "each view is better than the one before": Fact(np.all(np.diff(scores) > 0)),
        "the last has more than 27 dB": Fact(scores[-1], 27, 60),
        "it ends with more Gaussians": Fact(counts[-1] - counts[0], 50, 500),
    }
    figure, panels = subplots(7.0, 3.4, 2, 3)
    for axes, scene, step, count, score in zip(
        panels.flat, scenes, MARKS, counts, scores, strict=False
    ):
        shown, _ = module.picture(scene, fine, background)
        parts.show(axes, shown, f"step {step}, {count} Gaussians: {score:.1f} dB")
    parts.show(panels.flat[-1], truth, "the photograph")
    return figure, facts


def fig5_arrows(module: ModuleType) -> tuple[Figure, Facts]:
    """Where gradient descent moves each mean, the absolute gradients, and the chosen ones."""
    scenes, background = parts.fitted(module)
    scene, (camera, truth) = scenes[2], parts.photographs(WIDE)[0][1]
    shown, back = module.picture(scene, camera, background)
    error = shown - truth
    gradient = back(2 * error / error[..., 0].size)
    absgrad = np.linalg.norm(gradient["absgrad"], axis=1) * WIDE / 2
    chosen = absgrad > module.THRESHOLD
    moved, slope = {**scene}, gradient["means"]
    moved["means"] = scene["means"] - 1e-5 * slope / np.abs(slope).max()
    after = module.picture(moved, camera, background)[0] - truth
    fall = np.sum(error**2) - np.sum(after**2)
    predicted = 1e-5 * np.sum(slope**2) / np.abs(slope).max() * error[..., 0].size
    cov, _ = module.covariance(scene["quats"], scene["log_scales"])
    places, cov2d, depth, _ = module.project(scene["means"], cov, camera)
    # The error below a Gaussian, weighted with its own opacity.
    tall, wide = truth.shape[:2]
    pixels = np.stack(np.mgrid[0:tall, 0:wide][::-1], axis=-1).reshape(-1, 2) + 0.5
    alpha, _ = module.screen_alpha(places, cov2d, scene["opacity_logits"], pixels)
    beneath = alpha @ np.sum(error**2, axis=2).ravel() / np.maximum(alpha.sum(axis=1), 1e-9)
    at = np.clip(places.astype(int), 0, [wide - 1, tall - 1])
    on_fruit = (truth[..., 0] - truth[..., 2] > 0.15)[at[:, 1], at[:, 0]]
    facts: Facts = {
        "a small step along all arrows lowers the loss as the gradient predicts": Fact(
            fall / predicted, 0.98, 1.02
        ),
        "most of the chosen lie on the bananas, and some on the carpet": Fact(
            on_fruit[chosen].mean(), 0.55, 0.95
        ),
        "some are chosen, and most are not": Fact(chosen.mean(), 0.05, 0.6),
        "below the chosen ones the error is larger": Fact(
            beneath[chosen].mean() / beneath[~chosen].mean(), 2, 50
        ),
    }
    W = np.asarray(camera["camera_from_world"])[:2, :3]
    arrows = -(slope @ W.T) * depth[:, None]
    arrows *= 5 / np.quantile(np.linalg.norm(arrows, axis=1), 0.97)
    figure, panels = subplots(7.0, 1.95, 1, 3)
    parts.show(panels[0], truth, "a photograph")
    parts.show(panels[1], 0.6 * shown, "rendering, −gradient of the means")
    # Brightest: what one pixel in fifty exceeds.
    miss = np.sqrt(np.mean(error**2, axis=2, keepdims=True))
    miss = 0.8 * np.minimum(miss / np.quantile(miss, 0.98), 1)
    parts.show(panels[2], np.repeat(miss, 3, axis=2), "error; circles: absolute gradient")
    panels[1].quiver(
        *(places - 0.5).T,
        *arrows.T,
        angles="xy",
        scale_units="xy",
        scale=1,
        color="white",
        width=0.006,
    )
    for which, color in ((~chosen, GRAY), (chosen, ORANGE)):
        panels[2].scatter(
            *(places[which] - 0.5).T,
            s=90 * absgrad[which] / absgrad.max(),
            facecolors="none",
            edgecolors=color,
            linewidths=0.8,
        )
    for axes in panels:
        axes.set(xlim=(-0.5, wide - 0.5), ylim=(tall - 0.5, -0.5))
    return figure, facts


FIGURES = figures_of(
    *map(parts.calm, (fig1_banana, fig2_projection, fig3_absgrad, fig4_fit, fig5_arrows))
)
RED = {
    "fig1_banana": "shape_turned_back",
    "fig2_projection": "lens_not_held",
    "fig3_absgrad": "absgrad_of_the_sum",
    "fig4_fit": "alpha_back_mean_sign",
    "fig5_arrows": "alpha_back_mean_sign",
}

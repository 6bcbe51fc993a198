"""The figures of assignment 15, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from figure_parts import BLACK, MOST, SIZE, STEPS, VIEWS
from matplotlib.figure import Figure
from photograd_course.viz.handout import Fact, Facts, figures_of, subplots
from photograd_course.viz.style import BLUE, GRAY, ORANGE, plain_axes, signed_color_map


def fig1_projection(module: ModuleType) -> tuple[Figure, Facts]:
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
    facts: Facts = {
        "the points' covariance is cov2d within 6 %": Fact(
            np.linalg.norm(sample - cov2d[0]) / np.linalg.norm(cov2d[0]), 0, 0.06
        ),
        "clamped, the width is constant": Fact(held[-1] / held[slopes > limit][0], 0.999, 1.001),
        "not clamped, it is more than twice as large in the end": Fact(free[-1] / held[-1], 2, 10),
    }
    figure, (left, right) = subplots(7.0, 3.0, 1, 2)
    left.plot(*seen[:700].T, ".", color=GRAY, markersize=2)
    for k in (1, 2):
        left.add_patch(parts.ellipse(mean2d[0], cov2d[0], k, edgecolor=BLUE))
    left.plot(*mean2d[0], "o", color=ORANGE, markersize=5)
    left.set(xlim=(0, 64), ylim=(64, 0), aspect="equal", xlabel="column", ylabel="row")
    right.plot(slopes, free, "--", color=ORANGE, label="not clamped")
    right.plot(slopes, held, color=BLUE, label="clamped")
    right.axvline(limit, color=GRAY, linewidth=0.8)
    right.set(xlabel="t_x / t_z", ylabel="width of the splat [pixels]")
    right.legend()
    for axes in (left, right):
        plain_axes(axes)
    return figure, facts


def fig2_weights(module: ModuleType) -> tuple[Figure, Facts]:
    """Six splats in one pixel: alpha, the transmittance in front of each, and the weight."""
    alpha = np.array([[0.35], [0.6], [0.25], [0.8], [0.5], [0.3]])
    depth = np.array([2.2, 1.4, 3.1, 2.7, 3.6, 1.8])
    count = len(alpha)
    weights = np.array(
        [
            module.composite(alpha, np.eye(count)[:, [k] * 3], depth, BLACK)[0][0, 0]
            for k in range(count)
        ]
    )
    left = float(module.composite(alpha, np.zeros((count, 3)), depth, np.ones(3))[0][0, 0])
    order = np.argsort(depth)
    facts: Facts = {
        "weights and T_end sum to 1": Fact(weights.sum() + left, 1 - 1e-12, 1 + 1e-12),
        "the weight of the nearest is its alpha": Fact(weights[order[0]] - 0.6, -1e-12, 1e-12),
        "the weight of the most opaque one is a quarter of that of the nearest": Fact(
            weights[3] / weights[1], 0.23, 0.27
        ),
    }
    figure, axes = subplots(7.0, 2.4)
    x = np.arange(count)
    axes.bar(x - 0.2, alpha[order, 0], width=0.36, color=GRAY, label="α")
    axes.bar(x + 0.2, weights[order], width=0.36, color=BLUE, label="weight T α")
    through = np.concatenate([[1.0], np.cumprod(1 - alpha[order, 0])])
    axes.step(np.arange(count + 1) - 0.5, through, where="post", color=ORANGE, label="T")
    axes.set(xticks=x, xticklabels=[f"{depth[k]} m\nrow {k}" for k in order], ylim=(0, 1.05))
    axes.legend(ncols=3)
    axes.set_axisbelow(True)
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
        _, back_blend = module.composite(alpha, one["colors"], depth, BLACK)
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
    marks = (0, 20, 40, 80, STEPS)
    kept, found, _ = parts.fitted(module, marks)
    fine = parts.camera_at(parts.places(3, 1.0)[0], 96)
    truth = parts.photograph(fine)
    shown = [module.picture(scene, fine, BLACK)[0] for scene in kept]
    new = [parts.photographs(3, 1.0), [len(scene["means"]) for scene in kept]]
    scores = [parts.score_of(module, scene, new[0]) for scene in kept]
    facts: Facts = {
        "each frame is better than the one before": Fact(np.all(np.diff(scores) > 0)),
        "the last one has more than 26 dB on held-out views": Fact(scores[-1], 26, 60),
        "it begins with 80 Gaussians": Fact(new[1][0], 80, 80),
        "it ends with more than 150": Fact(len(found["means"]), 151, MOST),
    }
    figure, panels = subplots(7.0, 1.75, 1, len(marks) + 1)
    for axes, image, step, count, score in zip(panels, shown, marks, new[1], scores, strict=False):
        parts.show(axes, image, f"step {step}\n{count}: {score:.1f} dB")
    parts.show(panels[-1], truth, "truth\n")
    return figure, facts


def fig5_arrows(module: ModuleType) -> tuple[Figure, Facts]:
    """Where gradient descent moves each mean, the absolute gradients, and the chosen ones."""
    (scene,), _, views = parts.fitted(module, (70,), 70)
    camera, truth = views[1]
    shown, back = module.picture(scene, camera, BLACK)
    error = shown - truth
    gradient = back(2 * error / error[..., 0].size)
    absgrad = np.linalg.norm(gradient["absgrad"], axis=1) * SIZE / 2
    chosen = absgrad > module.THRESHOLD
    moved, slope = {**scene}, gradient["means"]
    moved["means"] = scene["means"] - 1e-5 * slope / np.abs(slope).max()
    fall = np.sum(error**2) - np.sum((module.picture(moved, camera, BLACK)[0] - truth) ** 2)
    predicted = 1e-5 * np.sum(slope**2) / np.abs(slope).max() * error[..., 0].size
    cov, _ = module.covariance(scene["quats"], scene["log_scales"])
    places, cov2d, depth, _ = module.project(scene["means"], cov, camera)
    # The error below a Gaussian, weighted with its own weights.
    pixels = np.stack(np.mgrid[0:SIZE, 0:SIZE][::-1], axis=-1).reshape(-1, 2) + 0.5
    alpha, _ = module.screen_alpha(places, cov2d, scene["opacity_logits"], pixels)
    beneath = alpha @ np.sum(error**2, axis=2).ravel() / np.maximum(alpha.sum(axis=1), 1e-9)
    facts: Facts = {
        "a small step along all arrows lowers the loss as the gradient predicts": Fact(
            fall / predicted, 0.98, 1.02
        ),
        "some are chosen, and most are not": Fact(chosen.mean(), 0.05, 0.6),
        "below the chosen ones the error is at least 1.5 times that below the others": Fact(
            beneath[chosen].mean() / beneath[~chosen].mean(), 1.5, 50
        ),
    }
    arrows = (
        -(slope @ camera["camera_from_world"][:2, :3].T) * (depth / camera["focal"][0])[:, None]
    )
    arrows *= 4 / np.quantile(np.linalg.norm(arrows, axis=1), 0.97)
    figure, panels = subplots(7.0, 2.7, 1, 3)
    parts.show(panels[0], truth, "a photograph")
    parts.show(panels[1], shown, "arrows: −gradient of the means")
    parts.show(panels[2], 0.35 * shown, "circles: absolute gradient; orange: chosen")
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
            s=120 * absgrad[which] / absgrad.max(),
            facecolors="none",
            edgecolors=color,
            linewidths=0.9,
        )
    for axes in panels:
        axes.set(xlim=(-0.5, SIZE - 0.5), ylim=(SIZE - 0.5, -0.5))
    return figure, facts


def fig6_three(module: ModuleType) -> tuple[Figure, Facts]:
    """One capture, three representations: images, bytes, gradients at the start."""
    views, unseen = parts.photographs(VIEWS), parts.photographs(3, 1.0)
    begin = parts.cloud(80, 0.1)
    _, splats, _ = parts.fitted(module, ())
    volume, slope9, score9 = parts.volume(views, unseen)
    grid, slope11, score11 = parts.grid(views, unseen)
    score = parts.score_of(module, splats, unseen)
    sizes = [4 * sum(a.size for a in splats.values()), 4 * volume.size, 4 * grid]
    facts: Facts = {
        "the Gaussians have the highest PSNR": Fact(score > max(score9[0], score11[0])),
        "and the fewest bytes": Fact(sizes[0] < min(sizes[1:])),
        "10 KiB of them as float32": Fact(sizes[0] / 1024, 9.5, 10.5),
        "all three have more than 20 dB": Fact(min(score, score9[0], score11[0]), 20, 60),
    }
    camera, truth = views[1]
    shown, back = module.picture(begin, camera, BLACK)
    gradient = back(2 * (shown - truth) / truth[..., 0].size)["means"]
    cov, _ = module.covariance(begin["quats"], begin["log_scales"])
    places, _, depth, _ = module.project(begin["means"], cov, camera)
    arrows = -(gradient @ camera["camera_from_world"][:2, :3].T) * depth[:, None]
    arrows *= 5 / np.quantile(np.linalg.norm(arrows, axis=1), 0.95)
    names = ("Gaussians", "volume (09)", "SH grid (11)")
    pictures = (module.picture(splats, unseen[0][0], BLACK)[0], score9[1], score11[1])
    figure, panels = subplots(7.0, 3.9, 2, 4)
    parts.show(panels[0, 0], unseen[0][1], "held-out view: truth")
    for axes, image, name, size, decibels in zip(
        panels[0, 1:], pictures, names, sizes, (score, score9[0], score11[0]), strict=True
    ):
        parts.show(axes, image, f"{name}\n{decibels:.1f} dB, {size / 1024:.0f} KiB")
    parts.show(panels[1, 0], truth, "a photograph")
    parts.show(panels[1, 1], 0.5 * shown, "start: ∂L/∂mean")
    panels[1, 1].quiver(
        *(places - 0.5).T,
        *arrows.T,
        angles="xy",
        scale_units="xy",
        scale=1,
        color="white",
        width=0.008,
    )
    panels[1, 1].set(xlim=(-0.5, SIZE - 0.5), ylim=(SIZE - 0.5, -0.5))
    for axes, values in ((panels[1, 2], slope9), (panels[1, 3], slope11)):
        flat = values[:, :, values.shape[2] // 2].T
        root = np.sign(flat) * np.sqrt(np.abs(flat) / np.abs(flat).max())
        axes.imshow(
            root, cmap=signed_color_map(), vmin=-1, vmax=1, origin="lower", interpolation="nearest"
        )
        axes.set(xticks=[], yticks=[])
        axes.set_title("start: ∂L/∂σ, slice", fontsize=8)
    return figure, facts


FIGURES = figures_of(
    *map(
        parts.calm, (fig1_projection, fig2_weights, fig3_absgrad, fig4_fit, fig5_arrows, fig6_three)
    )
)
RED = {
    "fig1_projection": "lens_not_held",
    "fig2_weights": "blend_inclusive",
    "fig3_absgrad": "absgrad_of_the_sum",
    "fig4_fit": "alpha_back_mean_sign",
    "fig5_arrows": "alpha_back_mean_sign",
    "fig6_three": "alpha_back_mean_sign",
}

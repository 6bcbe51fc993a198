"""3D Gaussian splatting: rendering a scene of 3D Gaussians, and its backward pass.

A scene is a dict of arrays with a row for each Gaussian, and every number may take any value:

    "means"             (N, 3), meters, in the world
    "log_scales"        (N, 3), logarithms of the standard deviations along its axes, in meters
    "quats"             (N, 4), quaternions (w, x, y, z) of any length above zero
    "opacity_logits"    (N,), the opacity at the center is 1 / (1 + exp(-logit))
    "colors"            (N, 3), as in the images

A *camera* is a dict: "camera_from_world" (3, 4), a rotation W and a translation t0 that take a
point p to t = W p + t0 with x to the right, y down, z forward; "focal" and "center", (2,) each, in
pixels along x and y; "width" and "height". The center of pixel (row, column) is at
(column + 1/2, row + 1/2).

Your tasks are six functions, one section of the handout each; `photograd course check 15` tells
how far you are. Five of them return, after their values, a function `back`: given the derivative of
a loss with respect to the values, it returns the derivatives with respect to the arguments. The
other functions are given and stay as they are; `volume_rendering.py`, beside this file, must be
yours of assignment 08. All numbers are float64.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
from volume_rendering import composite, composite_adjoint

# Arrays and their shapes; float64 where nothing else is said.
Vectors = Annotated[np.ndarray, "N 3"]
Quaternions = Annotated[np.ndarray, "N 4"]
Covariances = Annotated[np.ndarray, "N 3 3"]
PerGaussian = Annotated[np.ndarray, "N"]
ScreenPoints = Annotated[np.ndarray, "N 2"]
ScreenCovariances = Annotated[np.ndarray, "N 3"]  # xx, xy, yy
Pixels = Annotated[np.ndarray, "P 2"]
Alphas = Annotated[np.ndarray, "N P"]
Colors = Annotated[np.ndarray, "N 3"]
Shown = Annotated[np.ndarray, "P 3"]
Color = Annotated[np.ndarray, "3"]
Source = Annotated[np.ndarray, "M"]  # int64
Scene = dict[str, np.ndarray]
Camera = dict[str, Any]
Back = Callable[..., Any]  # a backward pass

LOW_PASS = 0.3  # pixels squared: no splat is thinner than about a pixel
MARGIN = 0.15  # of the image size: how far outside the image J is not clamped
NEAR = 0.01  # meters; nearer Gaussians are culled
ALPHA_MIN, ALPHA_MAX = 1 / 255, 0.999
FAINT = 0.02  # opacity below which a Gaussian is pruned
SMALL = 0.06  # meters; longer ones are split, the others cloned
THRESHOLD = 0.002  # of the positional gradient statistics
SHRINK = 1.6  # a part of a split Gaussian is smaller by this factor
TILE = 16  # pixels
RATES = {"means": 0.008, "log_scales": 0.03, "quats": 0.03, "opacity_logits": 0.05, "colors": 0.02}
# The matrix K that takes r to the cross product a x r has the entries sum_k CROSS[i, j, k] a_k.
CROSS = np.array(
    [
        [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
        [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
        [[0, -1, 0], [1, 0, 0], [0, 0, 0]],
    ]
)


def covariance(quats: Quaternions, log_scales: Vectors) -> tuple[Covariances, Back]:
    """The covariances of Gaussians.

    Args:
        quats: (N, 4), of any length above zero.
        log_scales: (N, 3).

    Returns:
        (cov, back): (N, 3, 3), symmetric; back(d_cov) returns (d_quats, d_log_scales), and each of
        the nine numbers of d_cov is a derivative of its own. Handout section 1.
    """
    # >>> solution 15.1
    length = np.linalg.norm(quats, axis=1, keepdims=True)
    n = quats / length
    w, K = n[:, :1, None], np.einsum("ijk,nk->nij", CROSS, n[:, 1:])
    R = np.eye(3) + 2 * (w * K + K @ K)
    s = np.exp(log_scales)[:, None]
    M = R * s

    def back(d_cov):
        d_M = (d_cov + d_cov.swapaxes(1, 2)) @ M
        d_R = 2 * d_M * s
        d_K = w * d_R - d_R @ K - K @ d_R
        d_u = np.einsum("ijk,nij->nk", CROSS, d_K)
        d_n = np.concatenate([np.sum(d_R * K, axis=(1, 2))[:, None], d_u], axis=1)
        along = np.sum(n * d_n, axis=1, keepdims=True)
        return (d_n - along * n) / length, np.sum(d_M * M, axis=1)

    return M @ M.swapaxes(1, 2), back
    # <<< solution


def depths(means, camera):
    """Given: the depths (N,) of means along the axis of the camera, in meters."""
    view = camera["camera_from_world"]
    return means @ view[2, :3] + view[2, 3]


def limits(camera):
    """Given: (low, high), (2,) each, to which t_x / t_z and t_y / t_z are clamped in J."""
    size = np.array([camera["width"], camera["height"]], np.float64)
    low = (-MARGIN * size - camera["center"]) / camera["focal"]
    return low, ((1 + MARGIN) * size - camera["center"]) / camera["focal"]


def project(
    means: Vectors, cov: Covariances, camera: Camera
) -> tuple[ScreenPoints, ScreenCovariances, PerGaussian, Back]:
    """Means and covariances of Gaussians, projected to the screen.

    Args:
        means: (N, 3), all in front of the camera.
        cov: (N, 3, 3), symmetric.
        camera: see above.

    Returns:
        (mean2d, cov2d, depth, back): (N, 2), pixels along x and y; (N, 3), the entries xx, xy, yy,
        in pixels squared; (N,), meters; back(d_mean2d, d_cov2d) returns (d_means, d_cov). Handout
        section 2.
    """
    # >>> solution 15.2
    W, f = camera["camera_from_world"][:, :3], camera["focal"]
    t = means @ W.T + camera["camera_from_world"][:, 3]
    z = t[:, 2:]
    u = t[:, :2] / z
    h = np.clip(u, *limits(camera))
    A = (f / z)[:, :, None] * (W[:2] - h[:, :, None] * W[2])
    S = A @ cov @ A.swapaxes(1, 2)

    def back(d_mean2d, d_cov2d):
        G = d_cov2d[:, [0, 1, 1, 2]].reshape(-1, 2, 2) * [[1, 0.5], [0.5, 1]]
        d_A = 2 * G @ A @ cov
        d_h = -f / z * (d_A @ W[2])
        d_u = f * d_mean2d + np.where(h == u, d_h, 0.0)
        d_z = -np.sum(d_u * u, axis=1) - np.sum(d_A * A, axis=(1, 2))
        d_t = np.concatenate([d_u, d_z[:, None]], axis=1) / z
        return d_t @ W, A.swapaxes(1, 2) @ G @ A

    return f * u + camera["center"], S[:, [0, 0, 1], [0, 1, 1]], t[:, 2], back
    # <<< solution


def screen_alpha(
    mean2d: ScreenPoints, cov2d: ScreenCovariances, opacity_logits: PerGaussian, pixels: Pixels
) -> tuple[Alphas, Back]:
    """The opacity of each splat in each pixel.

    Args:
        mean2d: (N, 2), in pixels along x and y.
        cov2d: (N, 3), xx, xy, yy, in pixels squared; LOW_PASS is still to be added.
        opacity_logits: (N,).
        pixels: (P, 2), points on the screen.

    Returns:
        (alpha, back): (N, P); back(d_alpha) returns (d_mean2d, d_cov2d, d_opacity_logits, absgrad);
        absgrad (N, 2) is the absolute gradient, the sum over pixels of the absolute values of their
        contributions to d_mean2d. Handout section 3.
    """
    # >>> solution 15.3
    S = cov2d + np.array([LOW_PASS, 0, LOW_PASS])
    det = S[:, 0] * S[:, 2] - S[:, 1] ** 2
    Qxx, Qxy, Qyy = (S[:, ::-1] * [1, -1, 1] / det[:, None]).T[:, :, None]
    dx, dy = (mean2d[:, None] - pixels).transpose(2, 0, 1)
    vx, vy = Qxx * dx + Qxy * dy, Qxy * dx + Qyy * dy
    o = 1 / (1 + np.exp(-opacity_logits))
    raw = o[:, None] * np.exp(-(dx * vx + dy * vy) / 2)
    seen = raw >= ALPHA_MIN

    def back(d_alpha):
        g = np.where(seen & (raw <= ALPHA_MAX), raw * d_alpha, 0.0)
        gx, gy = g * vx, g * vy
        d_S = np.stack([gx * vx / 2, gx * vy, gy * vy / 2]).sum(axis=2).T
        d_mean2d = -np.stack([gx, gy]).sum(axis=2).T
        absgrad = np.abs(np.stack([gx, gy])).sum(axis=2).T
        return d_mean2d, d_S, (1 - o) * g.sum(axis=1), absgrad

    return np.where(seen, np.minimum(raw, ALPHA_MAX), 0.0), back
    # <<< solution


def composite_splats(
    alpha: Alphas, colors: Colors, depth: PerGaussian, background: Color
) -> tuple[Shown, Back]:
    """Splats in front of each other, by the `composite` of assignment 08.

    Args:
        alpha: (N, P), below 1; N may be 0.
        colors: (N, 3).
        depth: (N,); the smaller is in front, of equal ones the earlier row.
        background: (3,), the color behind all splats.

    Returns:
        (shown, back): (P, 3); back(d_shown) returns (d_alpha, d_colors, d_background), rows in
        their original order. Handout section 4.
    """
    # >>> solution 15.4
    if not len(alpha):
        shown = np.repeat(background[None], alpha.shape[1], axis=0)
        return shown, lambda g: (np.zeros(alpha.shape), np.zeros(colors.shape), g.sum(axis=0))
    order = np.argsort(depth, kind="stable")
    clear = 1 - alpha[order].T
    layers = np.broadcast_to(colors[order], (*clear.shape, 3))
    steps = -np.log(clear), layers, np.ones(clear.shape), background
    shown, T_end = composite(*steps)

    def back(d_shown):
        d_sigma, d_color, d_background = composite_adjoint(*steps, d_shown, np.zeros(T_end.shape))
        d_alpha, d_colors = np.zeros(alpha.shape), np.zeros(colors.shape)
        d_alpha[order] = (d_sigma / clear).T
        d_colors[order] = d_color.sum(axis=0)
        return d_alpha, d_colors, d_background

    return shown, back
    # <<< solution


def render(
    gaussians: Scene, camera: Camera, pixels: Pixels, background: Color
) -> tuple[Shown, Back]:
    """Render some pixels of a scene.

    Args:
        gaussians: N of them; those whose depth is NEAR or less are culled.
        camera: see above.
        pixels: (P, 2), points on the screen.
        background: (3,).

    Returns:
        (shown, back): (P, 3); back(d_shown) returns a dict with the derivatives with respect to all
        five arrays of the scene and "background" (3,), and the absolute gradient "absgrad" (N, 2);
        culled rows have zeros. Handout section 5.
    """
    # >>> solution 15.5
    drawn = depths(gaussians["means"], camera) > NEAR
    part = {key: values[drawn] for key, values in gaussians.items()}
    cov, shape_back = covariance(part["quats"], part["log_scales"])
    mean2d, cov2d, depth, lens_back = project(part["means"], cov, camera)
    alpha, alpha_back = screen_alpha(mean2d, cov2d, part["opacity_logits"], pixels)
    shown, blend_back = composite_splats(alpha, part["colors"], depth, background)

    def back(d_shown):
        found = {}
        d_alpha, found["colors"], d_background = blend_back(d_shown)
        d_mean2d, d_cov2d, found["opacity_logits"], found["absgrad"] = alpha_back(d_alpha)
        found["means"], d_cov = lens_back(d_mean2d, d_cov2d)
        found["quats"], found["log_scales"] = shape_back(d_cov)
        rows = {key: np.zeros((len(drawn), *each.shape[1:])) for key, each in found.items()}
        for key, each in found.items():
            rows[key][drawn] = each
        return {**rows, "background": d_background}

    return shown, back
    # <<< solution


def densify(
    gaussians: Scene, grad2d: PerGaussian, rng: np.random.Generator, max_count: int
) -> tuple[Scene, Source]:
    """Density control: clone, split and prune Gaussians.

    Args:
        gaussians: N of them; these arrays must not change.
        grad2d: (N,), positional gradient statistics: mean length of the absolute gradient.
        rng: a numpy.random.Generator, used once: standard_normal((2 * count, 3)) for count splits.
        max_count: the largest number of Gaussians, unless more than that stay after pruning.

    Returns:
        (gaussians, source): the new scene, and (M,), integers: the old row of each, or -1 for a new
        one. Handout section 6.
    """
    # >>> solution 15.6
    opacity = 1 / (1 + np.exp(-gaussians["opacity_logits"]))
    kept = opacity >= FAINT
    rows = np.argsort(-grad2d, kind="stable")
    chosen = rows[(kept & (grad2d > THRESHOLD))[rows]][: max(max_count - kept.sum(), 0)]
    small = np.exp(gaussians["log_scales"]).max(axis=1) <= SMALL
    clone, split = (np.sort(chosen[each]) for each in (small[chosen], ~small[chosen]))
    kept[split] = False
    stay = np.flatnonzero(kept)
    rows = np.concatenate([stay, clone, split, split])
    logits = gaussians["opacity_logits"].copy()
    logits[clone] = np.log(np.sqrt(1 + np.exp(logits[clone])) - 1)
    after = {key: part[rows] for key, part in {**gaussians, "opacity_logits": logits}.items()}
    fresh = slice(len(rows) - 2 * len(split), None)
    whole, _ = covariance(after["quats"][fresh], after["log_scales"][fresh])
    drawn = rng.standard_normal((2 * len(split), 3))
    after["means"][fresh] += np.einsum("nij,nj->ni", np.linalg.cholesky(whole), drawn)
    after["log_scales"][fresh] -= np.log(SHRINK)
    return after, np.where(np.arange(len(rows)) < len(stay), rows, -1)
    # <<< solution


def reach(gaussians, camera):
    """Given: (low, high), (N, 2) each: outside this box alpha is below ALPHA_MIN."""
    ahead = depths(gaussians["means"], camera) > NEAR
    low, high = np.full((len(ahead), 2), np.inf), np.full((len(ahead), 2), -np.inf)
    visible = {key: values[ahead] for key, values in gaussians.items()}
    spread, _ = covariance(visible["quats"], visible["log_scales"])
    middle, extent, *_ = project(visible["means"], spread, camera)
    solid = 1 / (1 + np.exp(-visible["opacity_logits"]))
    sigmas = np.sqrt(2 * np.log(np.maximum(solid / ALPHA_MIN, 1)))
    half = sigmas[:, None] * np.sqrt(extent[:, ::2] + LOW_PASS)
    low[ahead], high[ahead] = middle - half, middle + half
    return low, high


def picture(gaussians, camera, background):
    """Given: all pixels by `render`, in tiles of TILE x TILE, each with the splats that cover it.

    Returns:
        (shown, back): (H, W, 3); back as that of `render`.
    """
    low, high = reach(gaussians, camera)
    height, width = camera["height"], camera["width"]
    shown, tiles = np.zeros((height, width, 3)), []
    for top in range(0, height, TILE):
        for left in range(0, width, TILE):
            block = slice(top, min(top + TILE, height)), slice(left, min(left + TILE, width))
            y, x = (each.ravel() + 0.5 for each in np.mgrid[block])
            here = (high > [x[0], y[0]]) & (low < [x[-1], y[-1]])
            here = np.flatnonzero(here.all(axis=1))
            some = {key: values[here] for key, values in gaussians.items()}
            colors, tile_back = render(some, camera, np.stack([x, y], axis=1), background)
            shown[block] = colors.reshape(shown[block].shape)
            tiles.append((block, here, tile_back))

    def back(d_shown):
        total = {key: np.zeros_like(values) for key, values in gaussians.items()}
        total.update(absgrad=np.zeros((len(low), 2)), background=np.zeros(3))
        for block, here, tile_back in tiles:
            for key, values in tile_back(d_shown[block].reshape(-1, 3)).items():
                total[key][... if key == "background" else here] += values
        return total

    return shown, back


class Adam:
    """Adam for a scene, as in assignment 01, with beta1 = 0.9 and beta2 = 0.99."""

    def __init__(self, gaussians):
        self.m = {key: np.zeros_like(values) for key, values in gaussians.items()}
        self.v = {key: np.zeros_like(values) for key, values in gaussians.items()}
        self.k = 0

    def step(self, gaussians, gradient):
        """The scene after one step; the given one does not change."""
        self.k += 1
        moved = {}
        for key, values in gaussians.items():
            self.m[key] = 0.9 * self.m[key] + 0.1 * gradient[key]
            self.v[key] = 0.99 * self.v[key] + 0.01 * gradient[key] ** 2
            m, v = self.m[key] / (1 - 0.9**self.k), self.v[key] / (1 - 0.99**self.k)
            moved[key] = values - RATES[key] * m / (np.sqrt(v) + 1e-8)
        return moved

    def follow(self, source):
        """Old rows keep their moments after `densify`; those of new rows are zero."""
        for moments in (self.m, self.v):
            for key, values in moments.items():
                old = (source >= 0).reshape(-1, *[1] * (values.ndim - 1))
                moments[key] = np.where(old, values[source], 0.0)


def fit(gaussians, views, steps, rng, background, max_count, every=50, watch=None):
    """Given: fit a scene to photographs, one of them per step.

    Args:
        gaussians: the initial scene.
        views: a list of pairs of a camera and an image (H, W, 3).
        steps: the number of steps.
        rng: a numpy.random.Generator.
        background: (3,).
        max_count: the largest number of Gaussians; 0: no density control.
        every: steps between two calls of `densify`, in the first two thirds of the fit.
        watch: called with (step, gaussians, loss) before each step, or None.

    Returns:
        (gaussians, losses): losses (steps,), of the image of each step.
    """
    adam, losses = Adam(gaussians), np.zeros(steps)
    total, times = np.zeros(len(gaussians["means"])), np.zeros(len(gaussians["means"]))
    for step in range(steps):
        camera, truth = views[rng.integers(len(views))]
        shown, back = picture(gaussians, camera, background)
        error = shown - truth
        losses[step] = np.sum(error**2) / error[..., 0].size
        if watch is not None:
            watch(step, gaussians, losses[step])
        gradient = back(2 * error / error[..., 0].size)
        absgrad = np.linalg.norm(gradient["absgrad"], axis=1)
        # From pixels to halves of an image, so that a threshold holds for any image size.
        total += absgrad * max(camera["width"], camera["height"]) / 2
        times += absgrad > 0
        gaussians = adam.step(gaussians, gradient)
        if max_count and (step + 1) % every == 0 and 3 * step < 2 * steps:
            grad2d = total / np.maximum(times, 1)
            gaussians, source = densify(gaussians, grad2d, rng, max_count)
            adam.follow(source)
            total, times = np.zeros(len(source)), np.zeros(len(source))
    return gaussians, losses

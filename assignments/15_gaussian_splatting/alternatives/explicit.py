"""Whole arrays, number by number: entries of R, A, B, C of a conic, sums of logarithms."""

from __future__ import annotations

import numpy as np

LOW_PASS = 0.3  # pixels squared: no splat is thinner than about a pixel
MARGIN = 0.15  # of the picture's size: how far outside of it slopes are still taken where they are
NEAR = 0.01  # metres; Gaussians that are closer are not drawn
ALPHA_MIN, ALPHA_MAX = 1 / 255, 0.999
FAINT = 0.02  # opacity below which a Gaussian is dropped
SMALL = 0.06  # metres; longer ones are split, the others cloned
THRESHOLD = 0.002  # of the pressure
SHRINK = 1.6  # a part of a split Gaussian is smaller by this
TILE = 16  # pixels
RATES = {"means": 0.008, "log_scales": 0.03, "quats": 0.03, "opacity_logits": 0.05, "colors": 0.02}
# The matrix that takes v to the cross product u x v has the entries sum_k CROSS[i, j, k] u_k.
CROSS = np.array(
    [
        [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
        [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
        [[0, -1, 0], [1, 0, 0], [0, 0, 0]],
    ]
)


def covariance(quats, log_scales):
    """The covariances of Gaussians."""
    size = np.sqrt(np.sum(quats**2, axis=1))
    w, x, y, z = quats.T / size
    R = np.empty((len(quats), 3, 3))
    ww, xx, yy, zz = w * w, x * x, y * y, z * z
    R[:, 0, 0], R[:, 0, 1], R[:, 0, 2] = ww + xx - yy - zz, 2 * (x * y - w * z), 2 * (x * z + w * y)
    R[:, 1, 0], R[:, 1, 1], R[:, 1, 2] = 2 * (x * y + w * z), ww - xx + yy - zz, 2 * (y * z - w * x)
    R[:, 2, 0], R[:, 2, 1], R[:, 2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), ww - xx - yy + zz
    variance = np.exp(2 * log_scales)
    cov = np.einsum("nik,nk,njk->nij", R, variance, R)

    def back(d_cov):
        d_variance = np.einsum("nij,nik,njk->nk", d_cov, R, R)
        G = np.einsum("nij,njk,nk->nik", d_cov, R, variance)
        G = G + np.einsum("nji,njk,nk->nik", d_cov, R, variance)
        g = 2 * G.transpose(1, 2, 0)
        d = np.stack(
            [
                w * (g[0, 0] + g[1, 1] + g[2, 2])
                + z * (g[1, 0] - g[0, 1])
                + y * (g[0, 2] - g[2, 0])
                + x * (g[2, 1] - g[1, 2]),
                x * (g[0, 0] - g[1, 1] - g[2, 2])
                + y * (g[0, 1] + g[1, 0])
                + z * (g[0, 2] + g[2, 0])
                + w * (g[2, 1] - g[1, 2]),
                y * (g[1, 1] - g[0, 0] - g[2, 2])
                + x * (g[0, 1] + g[1, 0])
                + z * (g[1, 2] + g[2, 1])
                + w * (g[0, 2] - g[2, 0]),
                z * (g[2, 2] - g[0, 0] - g[1, 1])
                + x * (g[0, 2] + g[2, 0])
                + y * (g[1, 2] + g[2, 1])
                + w * (g[1, 0] - g[0, 1]),
            ]
        )
        unit = np.stack([w, x, y, z])
        return ((d - unit * np.sum(d * unit, axis=0)) / size).T, 2 * variance * d_variance

    return cov, back


def depths(means, camera):
    """Given: how far in front of the camera means lie, along its axis; (N,)."""
    view = camera["camera_from_world"]
    return means @ view[2, :3] + view[2, 3]


def limits(camera):
    """Given: (low, high), (2,) each: where t_x / t_z and t_y / t_z are held for the slopes."""
    size = np.array([camera["width"], camera["height"]], np.float64)
    low = (-MARGIN * size - camera["centre"]) / camera["focal"]
    return low, ((1 + MARGIN) * size - camera["centre"]) / camera["focal"]


def project(means, cov, camera):
    """Gaussians as the camera sees them."""
    W, b = camera["camera_from_world"][:, :3], camera["camera_from_world"][:, 3]
    x, y, z = W @ means.T + b[:, None]
    (fx, fy), (cx, cy) = camera["focal"], camera["centre"]
    (x_low, y_low), (x_high, y_high) = limits(camera)
    hx, hy = np.clip(x / z, x_low, x_high), np.clip(y / z, y_low, y_high)
    free_x, free_y = (x / z >= x_low) & (x / z <= x_high), (y / z >= y_low) & (y / z <= y_high)
    V = W @ cov @ W.T
    jx, jy, kx, ky = fx / z, fy / z, -fx * hx / z, -fy * hy / z
    xx = jx * jx * V[:, 0, 0] + 2 * jx * kx * V[:, 0, 2] + kx * kx * V[:, 2, 2]
    yy = jy * jy * V[:, 1, 1] + 2 * jy * ky * V[:, 1, 2] + ky * ky * V[:, 2, 2]
    xy = jx * jy * V[:, 0, 1] + jx * ky * V[:, 0, 2] + kx * jy * V[:, 1, 2] + kx * ky * V[:, 2, 2]

    def back(d_mean2d, d_cov2d):
        p, q, r = d_cov2d.T
        d_jx = 2 * p * (jx * V[:, 0, 0] + kx * V[:, 0, 2]) + q * (jy * V[:, 0, 1] + ky * V[:, 0, 2])
        d_jy = 2 * r * (jy * V[:, 1, 1] + ky * V[:, 1, 2]) + q * (jx * V[:, 0, 1] + kx * V[:, 1, 2])
        d_kx = 2 * p * (jx * V[:, 0, 2] + kx * V[:, 2, 2]) + q * (jy * V[:, 1, 2] + ky * V[:, 2, 2])
        d_ky = 2 * r * (jy * V[:, 1, 2] + ky * V[:, 2, 2]) + q * (jx * V[:, 0, 2] + kx * V[:, 2, 2])
        d_x = d_mean2d[:, 0] * fx / z - free_x * d_kx * fx / z**2
        d_y = d_mean2d[:, 1] * fy / z - free_y * d_ky * fy / z**2
        # Free: -f x / z^2 has the slope 2 f x / z^3 by z; held: -f h / z has f h / z^2.
        d_z = -d_mean2d[:, 0] * fx * x / z**2 - d_mean2d[:, 1] * fy * y / z**2
        d_z = d_z - d_jx * fx / z**2 - d_jy * fy / z**2
        d_z = d_z + d_kx * np.where(free_x, 2 * fx * x / z**3, fx * hx / z**2)
        d_z = d_z + d_ky * np.where(free_y, 2 * fy * y / z**3, fy * hy / z**2)
        d_V = np.zeros_like(V)
        d_V[:, 0, 0], d_V[:, 1, 1] = p * jx * jx, r * jy * jy
        d_V[:, 2, 2] = p * kx * kx + q * kx * ky + r * ky * ky
        d_V[:, 0, 1], d_V[:, 0, 2] = q * jx * jy, 2 * p * jx * kx + q * jx * ky
        d_V[:, 1, 2] = 2 * r * jy * ky + q * kx * jy
        return np.stack([d_x, d_y, d_z], axis=1) @ W, W.T @ d_V @ W

    mean2d = np.stack([fx * x / z + cx, fy * y / z + cy], axis=1)
    return mean2d, np.stack([xx, xy, yy], axis=1), z, back


def screen_alpha(mean2d, cov2d, opacity_logits, pixels):
    """How much of each pixel's light each splat takes."""
    xx, xy, yy = cov2d[:, 0] + LOW_PASS, cov2d[:, 1], cov2d[:, 2] + LOW_PASS
    det = xx * yy - xy * xy
    A, B, C = yy / det, -xy / det, xx / det
    dx = mean2d[:, :1] - pixels[:, 0]
    dy = mean2d[:, 1:] - pixels[:, 1]
    sigma = 0.5 * (A[:, None] * dx**2 + C[:, None] * dy**2) + B[:, None] * dx * dy
    opacity = 1 / (1 + np.exp(-opacity_logits))
    full = opacity[:, None] * np.exp(-sigma)
    alpha = np.minimum(full, ALPHA_MAX)
    alpha[full < ALPHA_MIN] = 0

    def back(d_alpha):
        d_sigma = -full * d_alpha
        d_sigma[(full < ALPHA_MIN) | (full > ALPHA_MAX)] = 0
        along_x = d_sigma * (A[:, None] * dx + B[:, None] * dy)
        along_y = d_sigma * (B[:, None] * dx + C[:, None] * dy)
        d_A = 0.5 * np.sum(d_sigma * dx * dx, axis=1)
        d_B = np.sum(d_sigma * dx * dy, axis=1)
        d_C = 0.5 * np.sum(d_sigma * dy * dy, axis=1)
        d_xx = -(A * A * d_A + A * B * d_B + B * B * d_C)
        d_xy = -(2 * A * B * d_A + (A * C + B * B) * d_B + 2 * B * C * d_C)
        d_yy = -(B * B * d_A + B * C * d_B + C * C * d_C)
        d_mean2d = np.stack([along_x.sum(axis=1), along_y.sum(axis=1)], axis=1)
        pull = np.stack([abs(along_x).sum(axis=1), abs(along_y).sum(axis=1)], axis=1)
        d_logits = -d_sigma.sum(axis=1) * (1 - opacity)
        return d_mean2d, np.stack([d_xx, d_xy, d_yy], axis=1), d_logits, pull

    return alpha, back


def composite(alpha, colors, depth, background):
    """Splats over one another, nearest first."""
    order = np.lexsort((np.arange(len(depth)), depth))
    a = alpha[order]
    through = np.log1p(-a)
    total = np.cumsum(through, axis=0)
    T = np.exp(total - through)
    left = np.exp(through.sum(axis=0))
    weight = T * a
    shown = np.einsum("np,nc->pc", weight, colors[order]) + np.outer(left, background)

    def back(d_shown):
        value = np.einsum("nc,pc->np", colors[order], d_shown)
        lit = weight * value
        later = np.cumsum(lit[::-1], axis=0)[::-1] - lit + left * (d_shown @ background)
        where = np.argsort(order)
        d_alpha = (T * value - later / (1 - a))[where]
        return d_alpha, (weight @ d_shown)[where], left @ d_shown

    return shown, back


def render(gaussians, camera, pixels, background):
    """What some pixels show of a scene."""
    drawn = depths(gaussians["means"], camera) > NEAR
    part = {key: values[drawn] for key, values in gaussians.items()}
    cov, shape_back = covariance(part["quats"], part["log_scales"])
    mean2d, cov2d, depth, lens_back = project(part["means"], cov, camera)
    alpha, alpha_back = screen_alpha(mean2d, cov2d, part["opacity_logits"], pixels)
    shown, blend_back = composite(alpha, part["colors"], depth, background)

    def back(d_shown):
        found = {}
        d_alpha, found["colors"], d_background = blend_back(d_shown)
        d_mean2d, d_cov2d, found["opacity_logits"], found["pull"] = alpha_back(d_alpha)
        found["means"], d_cov = lens_back(d_mean2d, d_cov2d)
        found["quats"], found["log_scales"] = shape_back(d_cov)
        rows = {key: np.zeros((len(drawn), *each.shape[1:])) for key, each in found.items()}
        for key, each in found.items():
            rows[key][drawn] = each
        return {**rows, "background": d_background}

    return shown, back


def densify(gaussians, pressure, rng, most):
    """Clone, split and drop Gaussians."""
    opacity = 1 / (1 + np.exp(-gaussians["opacity_logits"]))
    kept = opacity >= FAINT
    rows = np.argsort(-pressure, kind="stable")
    chosen = rows[(kept & (pressure > THRESHOLD))[rows]][: max(most - kept.sum(), 0)]
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


def reach(gaussians, camera):
    """Given: (low, high), (N, 2) each: outside of this box alpha is below ALPHA_MIN."""
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
    """Given: all pixels by `render`, TILE x TILE of them at a time, with what can reach them."""
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
        total.update(pull=np.zeros((len(low), 2)), background=np.zeros(3))
        for block, here, tile_back in tiles:
            for key, values in tile_back(d_shown[block].reshape(-1, 3)).items():
                total[key][... if key == "background" else here] += values
        return total

    return shown, back


class Adam:
    """Steps of Adam for a scene, as in assignment 01, with beta 0.9 and 0.99."""

    def __init__(self, gaussians):
        self.m = {key: np.zeros_like(values) for key, values in gaussians.items()}
        self.v = {key: np.zeros_like(values) for key, values in gaussians.items()}
        self.k = 0

    def step(self, gaussians, gradient):
        """The scene after one step; the given one stays as it is."""
        self.k += 1
        moved = {}
        for key, values in gaussians.items():
            self.m[key] = 0.9 * self.m[key] + 0.1 * gradient[key]
            self.v[key] = 0.99 * self.v[key] + 0.01 * gradient[key] ** 2
            m, v = self.m[key] / (1 - 0.9**self.k), self.v[key] / (1 - 0.99**self.k)
            moved[key] = values - RATES[key] * m / (np.sqrt(v) + 1e-8)
        return moved

    def follow(self, source):
        """Rows keep their moments when a scene has changed; new ones begin with none."""
        for moments in (self.m, self.v):
            for key, values in moments.items():
                old = (source >= 0).reshape(-1, *[1] * (values.ndim - 1))
                moments[key] = np.where(old, values[source], 0.0)


def fit(gaussians, views, steps, rng, background, most, every=50, watch=None):
    """Given: fit a scene to photographs, one of them in each step."""
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
        pull = np.linalg.norm(gradient["pull"], axis=1)
        # The loss is a mean over pixels: with this factor a threshold holds for any picture's size.
        total += pull * max(camera["width"], camera["height"]) / 2
        times += pull > 0
        gaussians = adam.step(gaussians, gradient)
        if most and (step + 1) % every == 0 and 3 * step < 2 * steps:
            pressure = total / np.maximum(times, 1)
            gaussians, source = densify(gaussians, pressure, rng, most)
            adam.follow(source)
            total, times = np.zeros(len(source)), np.zeros(len(source))
    return gaussians, losses

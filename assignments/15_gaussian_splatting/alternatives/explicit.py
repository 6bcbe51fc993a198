"""Whole arrays, number by number: entries of R, A, B, C of a conic, sums of logarithms."""

import numpy as np
from splatting import FAINT, LOW_PASS, NEAR, SHRINK, SMALL, THRESHOLD, depths, limits

ALPHA_MIN, ALPHA_MAX = 1 / 255, 0.999


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


def project(means, cov, camera):
    """Gaussians as the camera sees them."""
    W, b = camera["camera_from_world"][:, :3], camera["camera_from_world"][:, 3]
    x, y, z = W @ means.T + b[:, None]
    (fx, fy), (cx, cy) = camera["focal"], camera["center"]
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
        absgrad = np.stack([abs(along_x).sum(axis=1), abs(along_y).sum(axis=1)], axis=1)
        d_logits = -d_sigma.sum(axis=1) * (1 - opacity)
        return d_mean2d, np.stack([d_xx, d_xy, d_yy], axis=1), d_logits, absgrad

    return alpha, back


def composite_splats(alpha, colors, depth, background):
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
    """What some pixels show of a scene: from here on the rows stand front to back."""
    depth = depths(gaussians["means"], camera)
    index = np.argsort(depth, kind="stable")
    index = index[np.searchsorted(depth[index], NEAR, side="right") :]
    means, log_scales, quats, logits, colors = (
        gaussians[key][index]
        for key in ("means", "log_scales", "quats", "opacity_logits", "colors")
    )
    cov, of_shape = covariance(quats, log_scales)
    mean2d, cov2d, depth, of_lens = project(means, cov, camera)
    alpha, of_alpha = screen_alpha(mean2d, cov2d, logits, pixels)
    shown, of_blend = composite_splats(alpha, colors, depth, background)

    def back(d_shown):
        d_alpha, d_colors, d_background = of_blend(d_shown)
        d_mean2d, d_cov2d, d_logits, absgrad = of_alpha(d_alpha)
        d_means, d_cov = of_lens(d_mean2d, d_cov2d)
        d_quats, d_log_scales = of_shape(d_cov)
        columns = [d_means, d_log_scales, d_quats, d_logits[:, None], d_colors, absgrad]
        table = np.zeros((len(gaussians["means"]), 16))
        table[index] = np.concatenate(columns, axis=1)
        return {
            "means": table[:, :3],
            "log_scales": table[:, 3:6],
            "quats": table[:, 6:10],
            "opacity_logits": table[:, 10],
            "colors": table[:, 11:14],
            "absgrad": table[:, 14:],
            "background": d_background,
        }

    return shown, back


def densify(gaussians, grad2d, rng, max_count):
    """Clone, split and drop Gaussians: masks, ranks by counting, a Cholesky factor by entries."""
    a = 1 / (1 + np.exp(-gaussians["opacity_logits"]))
    alive = a >= FAINT
    asks = alive & (grad2d > THRESHOLD)
    number = np.arange(len(a))
    before = grad2d[:, None] > grad2d
    before |= (grad2d[:, None] == grad2d) & (number[:, None] < number)
    chosen = asks & (np.sum(before & asks[:, None], axis=0) < max_count - np.sum(alive))
    long = np.any(np.exp(gaussians["log_scales"]) > SMALL, axis=1)
    masks = [alive & ~(chosen & long), chosen & ~long, chosen & long, chosen & long]
    rows = np.nonzero(np.stack(masks))[1]
    size = [np.sum(mask) for mask in masks]
    after = {key: part[rows] for key, part in gaussians.items()}
    cloned = (chosen & ~long)[rows]
    after["opacity_logits"][cloned] = np.log(np.expm1(-0.5 * np.log1p(-a[rows][cloned])))
    child = np.arange(len(rows)) >= size[0] + size[1]
    c = covariance(after["quats"][child], after["log_scales"][child])[0].transpose(1, 2, 0)
    z = rng.standard_normal((2 * size[2], 3)).T
    xx = np.sqrt(c[0, 0])
    yx, zx = c[1, 0] / xx, c[2, 0] / xx
    yy = np.sqrt(c[1, 1] - yx * yx)
    zy = (c[2, 1] - zx * yx) / yy
    zz = np.sqrt(c[2, 2] - zx * zx - zy * zy)
    moved = [xx * z[0], yx * z[0] + yy * z[1], zx * z[0] + zy * z[1] + zz * z[2]]
    after["means"][child] += np.transpose(moved)
    after["log_scales"][child] -= np.log(SHRINK)
    source = rows.copy()
    source[size[0] :] = -1
    return after, source

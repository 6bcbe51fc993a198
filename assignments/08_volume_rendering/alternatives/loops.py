"""Scalar loops over rays, steps, axes and channels; the rest of the light from the last step on."""

import math

import numpy as np
from volume_rendering import ray_samples


def composite(sigma, color, dt, background):
    pixels, ends = [], []
    behind = background.tolist()
    for sigmas, colors, lengths in zip(sigma.tolist(), color.tolist(), dt.tolist(), strict=True):
        pixel, T = [0.0] * len(behind), 1.0
        for extinction, shade, length in zip(sigmas, colors, lengths, strict=True):
            weight = T * -math.expm1(-extinction * length)
            for c, value in enumerate(shade):
                pixel[c] += weight * value
            T *= math.exp(-extinction * length)
        pixels.append([value + T * b for value, b in zip(pixel, behind, strict=True)])
        ends.append(T)
    return np.array(pixels), np.array(ends)


def composite_adjoint(sigma, color, dt, background, d_pixel, d_T_end):
    behind, slopes, tints = background.tolist(), [], []
    d_background = [0.0] * len(behind)
    for r in range(len(sigma)):
        sigmas, colors, lengths = sigma[r].tolist(), color[r].tolist(), dt[r].tolist()
        d = d_pixel[r].tolist()
        front = [1.0]
        for extinction, length in zip(sigmas, lengths, strict=True):
            front.append(front[-1] * math.exp(-extinction * length))
        hidden = float(d_T_end[r])
        for c, value in enumerate(behind):
            d_background[c] += front[-1] * d[c]
            hidden += value * d[c]
        hidden *= front[-1]
        slope, tint = [0.0] * len(sigmas), [[]] * len(sigmas)
        for k in reversed(range(len(sigmas))):
            weight = front[k] * -math.expm1(-sigmas[k] * lengths[k])
            own = 0.0
            for c, value in enumerate(colors[k]):
                own += d[c] * value
            tint[k] = [weight * each for each in d]
            slope[k] = lengths[k] * (front[k + 1] * own - hidden)
            hidden += weight * own
        slopes.append(slope)
        tints.append(tint)
    return np.array(slopes), np.array(tints), np.array(d_background)


def ray_box(low, high, origins, directions):
    t_near, t_far = np.zeros(len(origins)), np.zeros(len(origins))
    for r in range(len(origins)):
        near, far = 0.0, math.inf
        for axis in range(3):
            o, d = float(origins[r, axis]), float(directions[r, axis])
            if d == 0.0:
                if not low[axis] <= o <= high[axis]:
                    far = -math.inf
                continue
            a, b = (low[axis] - o) / d, (high[axis] - o) / d
            near, far = max(near, min(a, b)), min(far, max(a, b))
        if near < far:
            t_near[r], t_far[r] = near, far
    return t_near, t_far


def _axis(n, place):
    x = min(max(place * n - 0.5, 0.0), n - 1.0)
    cell = min(int(x), max(n - 2, 0))
    return ((cell, 1 - (x - cell)), (min(cell + 1, n - 1), x - cell))


def _eight(shape, place):
    """The eight (i, j, k, weight) of one place."""
    xs, ys, zs = _axis(shape[0], place[0]), _axis(shape[1], place[1]), _axis(shape[2], place[2])
    flat = [(i, j, wx * wy) for i, wx in xs for j, wy in ys]
    return [(i, j, k, wxy * wz) for i, j, wxy in flat for k, wz in zs]


def trilinear(grid, u):
    shape, values, channels = grid.shape[:3], grid.tolist(), range(grid.shape[3])
    out = []
    for place in u.tolist():
        total = [0.0 for _ in channels]
        for i, j, k, weight in _eight(shape, place):
            voxel = values[i][j][k]
            for c in channels:
                total[c] += weight * voxel[c]
        out.append(total)
    return np.array(out)


def trilinear_adjoint(shape, u, g):
    channels = range(g.shape[1])
    out = np.zeros((*shape, g.shape[1])).tolist()
    for place, given in zip(u.tolist(), g.tolist(), strict=True):
        for i, j, k, weight in _eight(shape, place):
            voxel = out[i][j][k]
            for c in channels:
                voxel[c] += weight * given[c]
    return np.array(out)


def render_adjoint(grid, low, high, origins, directions, n, background, d_pixel):
    u, dt = ray_samples(low, high, origins, directions, n)
    points = u.reshape(-1, 3)
    samples = trilinear(grid, points).reshape(len(origins), n, 4)
    d_sigma, d_color, d_background = composite_adjoint(
        samples[:, :, 3], samples[:, :, :3], dt, background, d_pixel, np.zeros(len(origins))
    )
    d_samples = np.zeros((len(origins), n, 4))
    for r in range(len(origins)):
        for k in range(n):
            for c in range(3):
                d_samples[r, k, c] = d_color[r, k, c]
            d_samples[r, k, 3] = d_sigma[r, k]
    return trilinear_adjoint(grid.shape[:3], points, d_samples.reshape(-1, 4)), d_background

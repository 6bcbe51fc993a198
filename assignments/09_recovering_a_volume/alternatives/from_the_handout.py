"""From the handout alone: functions for each equation, differences by np.diff and padding."""

import numpy as np
from volume_recovery import FLOOR, SAMPLES, SMOOTH, TV, Adam, draw
from volume_rendering import render_adjoint, render_rays


def psnr(picture, truth):
    error = np.asarray(picture) - np.asarray(truth)
    return -10 * float(np.log10(np.average(np.square(error))))


def ray_batch(views, chosen):
    shape = views["pictures"].shape
    view, row, column = np.unravel_index(chosen, shape[:3])
    x = (column + 0.5) - shape[2] / 2
    y = (row + 0.5) - shape[1] / 2
    points = np.stack([x / views["focal"], y / views["focal"], np.ones(len(chosen))], axis=1)
    R = views["world_from_camera"][view, :3, :3]
    o = views["world_from_camera"][view, :3, 3]
    world = (R @ points[:, :, None])[:, :, 0] + o
    return o, world - o, views["pictures"].reshape(-1, 3)[chosen]


def mse_and_cotangent(pixels, truth):
    off = pixels - truth
    return float(np.mean(np.sum(off * off, axis=1))), 2.0 * off / off.shape[0]


def delta(grid, axis):
    wide = [(0, 1) if a == axis else (0, 0) for a in range(4)]
    return np.pad(np.diff(grid, axis=axis), wide)


def delta_adjoint(p, axis):
    wide = [(1, 0) if a == axis else (0, 0) for a in range(4)]
    cut = [slice(None)] * 4
    cut[axis] = slice(0, -1)
    return np.pad(p[tuple(cut)], wide) - p


def tv_loss_adjoint(grid, eps):
    voxels = np.prod(grid.shape[:3])
    parts = [delta(grid, axis) for axis in range(3)]
    ell = np.sqrt(eps**2 + sum(part**2 for part in parts))
    d = sum(delta_adjoint(part / ell, axis) for axis, part in enumerate(parts))
    return float((ell - eps).sum() / voxels), d / voxels


def loss_and_slope(grid, views, chosen):
    o, d, truth = ray_batch(views, chosen)
    rays = (views["low"], views["high"], o, d, SAMPLES, views["background"])
    pixels = render_rays(grid, *rays)
    loss, d_pixels = mse_and_cotangent(pixels, truth)
    return loss, render_adjoint(grid, *rays, d_pixels)[0]


def gradient_sign_map(grid, views):
    total = views["pictures"].shape[0] * views["pictures"].shape[1] * views["pictures"].shape[2]
    half = (total + 1) // 2
    s = half * loss_and_slope(grid, views, np.arange(half))[1][..., 3]
    if total > half:
        rest = np.arange(half, total)
        s = s + len(rest) * loss_and_slope(grid, views, rest)[1][..., 3]
    clear = np.abs(s) > FLOOR * np.max(np.abs(s))
    return np.where(clear, np.where(s > 0, 1.0, -1.0), 0.0)


def fit_volume(views, grid, steps, rng):
    adam, noted, grid = Adam(), [], grid + 0.0
    for _ in range(steps):
        loss, slope = loss_and_slope(grid, views, draw(views, rng))
        tv, d_tv = tv_loss_adjoint(grid, SMOOTH)
        noted += [loss + TV * tv]
        grid = adam.step(grid, slope + TV * d_tv)
        grid[..., :3] = np.minimum(1.0, np.maximum(0.0, grid[..., :3]))
        grid[..., 3] = np.maximum(0.0, grid[..., 3])
    return grid, np.array(noted).reshape(steps)

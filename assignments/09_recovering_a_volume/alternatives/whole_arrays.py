"""Whole arrays throughout: homogeneous matrices, slices, all photographs in one batch."""

import numpy as np
from volume_recovery import FLOOR, SAMPLES, SMOOTH, TV, Adam, draw
from volume_rendering import render_adjoint, render_rays


def psnr(picture, truth):
    return float(10 * np.log10(picture.size) - 20 * np.log10(np.linalg.norm(picture - truth)))


def ray_batch(views, chosen):
    V, H, W, _ = views["pictures"].shape
    f = views["focal"]
    K = np.array([[f, 0, W / 2, 0], [0, f, H / 2, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    world_from_picture = views["world_from_camera"] @ np.linalg.inv(K)
    v, u = np.meshgrid(np.arange(H) + 0.5, np.arange(W) + 0.5, indexing="ij")
    seen = np.stack([u, v, np.ones((H, W)), np.zeros((H, W))], axis=-1)
    directions = np.einsum("vij,hwj->vhwi", world_from_picture, seen)[..., :3]
    directions = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    origins = np.broadcast_to(views["world_from_camera"][:, None, None, :3, 3], (V, H, W, 3))
    every = (origins, directions, views["pictures"])
    return tuple(np.ascontiguousarray(each).reshape(-1, 3)[chosen] for each in every)


def mse_and_cotangent(pixels, truth):
    d = (pixels - truth) / len(truth)
    return float(len(truth) * np.vdot(d, d)), 2 * d


def tv_loss_adjoint(grid, eps):
    n = grid[..., 0].size
    dx, dy, dz = np.zeros(grid.shape), np.zeros(grid.shape), np.zeros(grid.shape)
    dx[:-1] = grid[1:] - grid[:-1]
    dy[:, :-1] = grid[:, 1:] - grid[:, :-1]
    dz[:, :, :-1] = grid[:, :, 1:] - grid[:, :, :-1]
    squares = dx**2 + dy**2 + dz**2
    root = np.sqrt(eps**2 + squares)
    d = -(dx + dy + dz) / root
    d[1:] += (dx / root)[:-1]
    d[:, 1:] += (dy / root)[:, :-1]
    d[:, :, 1:] += (dz / root)[:, :, :-1]
    return float(np.sum(squares / (root + eps))) / n, d / n


def gradient_sign_map(grid, views):
    o, d, truth = ray_batch(views, np.arange(views["pictures"].size // 3))
    given = (grid, views["low"], views["high"], o, d, SAMPLES, views["background"])
    s = render_adjoint(*given, render_rays(*given) - truth)[0][..., 3]
    return (s > FLOOR * np.abs(s).max()) * 1.0 - (s < -FLOOR * np.abs(s).max())


def fit_volume(views, grid, steps, rng):
    low, high = np.zeros(4), np.array([1, 1, 1, np.inf])
    optimizer, losses = Adam(), np.zeros(steps)
    volume = grid.copy()
    for k in range(steps):
        o, d, truth = ray_batch(views, draw(views, rng))
        given = (volume, views["low"], views["high"], o, d, SAMPLES, views["background"])
        loss, back = mse_and_cotangent(render_rays(*given), truth)
        tv, d_tv = tv_loss_adjoint(volume, SMOOTH)
        losses[k] = loss + TV * tv
        slopes = render_adjoint(*given, back)[0] + TV * d_tv
        volume = np.clip(optimizer.step(volume, slopes), low, high)
    return volume, losses

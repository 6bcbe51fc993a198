"""Loops over pixels, rays and planes of voxels; sums written out."""

import numpy as np
from volume_recovery import FLOOR, SAMPLES, SMOOTH, TV, Adam, draw
from volume_rendering import render_adjoint, render_rays


def psnr(picture, truth):
    total, count = 0.0, 0
    for a, b in zip(np.ravel(picture), np.ravel(truth), strict=True):
        total += (a - b) * (a - b)
        count += 1
    if total == 0:
        return float("inf")
    return 10 * np.log10(count / total)


def ray_batch(views, chosen):
    _, H, W, _ = views["pictures"].shape
    origins, directions, truth = [], [], []
    for number in chosen.tolist():
        k, inside = number // (H * W), number % (H * W)
        i, j = inside // W, inside % W
        pose = views["world_from_camera"][k]
        x, y = (2 * j + 1 - W) / 2, (2 * i + 1 - H) / 2
        f = views["focal"]
        directions.append(x * pose[:3, 0] + y * pose[:3, 1] + f * pose[:3, 2])
        origins.append(pose[:3, 3])
        truth.append(views["pictures"][k, i, j])
    return np.array(origins), np.array(directions), np.array(truth)


def mse_and_cotangent(pixels, truth):
    R = len(pixels)
    total, d = 0.0, np.zeros((R, 3))
    for r in range(R):
        for c in range(3):
            off = pixels[r, c] - truth[r, c]
            total += off * off
            d[r, c] = 2 * off / R
    return total / R, d


def tv_loss_adjoint(grid, eps):
    X, Y, Z, C = grid.shape
    total, d = 0.0, np.zeros(grid.shape)
    for i in range(X):
        here = grid[i]
        dx = grid[i + 1] - here if i + 1 < X else np.zeros((Y, Z, C))
        dy, dz = np.zeros((Y, Z, C)), np.zeros((Y, Z, C))
        dy[:-1] = here[1:] - here[:-1]
        dz[:, :-1] = here[:, 1:] - here[:, :-1]
        root = np.sqrt(eps * eps + dx * dx + dy * dy + dz * dz)
        total += np.sum(root) - root.size * eps
        x, y, z = dx / root, dy / root, dz / root
        d[i] -= x + y + z
        if i + 1 < X:
            d[i + 1] += x
        d[i, 1:] += y[:-1]
        d[i, :, 1:] += z[:, :-1]
    return float(total) / (X * Y * Z), d / (X * Y * Z)


def gradient_sign_map(grid, views):
    V, H, W, _ = views["pictures"].shape
    total = np.zeros(grid.shape[:3])
    for k in range(V):
        for i in range(H):
            row = np.arange(W) + (k * H + i) * W
            o, d, truth = ray_batch(views, row)
            box = views["low"], views["high"]
            seen = render_rays(grid, *box, o, d, SAMPLES, views["background"])
            g = 2 * (seen - truth)
            back = render_adjoint(grid, *box, o, d, SAMPLES, views["background"], g)
            total = total + back[0][..., 3]
    signs = np.sign(total)
    signs[np.abs(total) <= FLOOR * np.max(np.abs(total))] = 0.0
    return signs


def fit_volume(views, grid, steps, rng):
    now, losses, adam = np.array(grid), [], Adam()
    for _ in range(steps):
        o, d, truth = ray_batch(views, draw(views, rng))
        box = views["low"], views["high"]
        seen = render_rays(now, *box, o, d, SAMPLES, views["background"])
        loss, g = mse_and_cotangent(seen, truth)
        back = render_adjoint(now, *box, o, d, SAMPLES, views["background"], g)[0]
        more, d_more = tv_loss_adjoint(now, SMOOTH)
        losses.append(loss + TV * more)
        moved = adam.step(now, back + TV * d_more)
        now = np.empty(moved.shape)
        for c in range(3):
            now[..., c] = np.minimum(np.maximum(moved[..., c], 0), 1)
        now[..., 3] = np.where(moved[..., 3] > 0, moved[..., 3], 0)
    return now, np.array(losses, dtype=float)

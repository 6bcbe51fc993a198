"""From the handout alone: what is seen from each step on, farthest first; no subtraction."""

import numpy as np
from volume_rendering import ray_samples


def composite(sigma, color, dt, background):
    R, S = sigma.shape
    seen = np.tile(background, (R, 1))
    T = np.ones(R)
    for k in range(S - 1, -1, -1):
        x = sigma[:, k] * dt[:, k]
        seen = -np.expm1(-x)[:, None] * color[:, k] + np.exp(-x)[:, None] * seen
        T = T * np.exp(-x)
    return seen, T


def composite_adjoint(sigma, color, dt, background, d_pixel, d_T_end):
    R, S = sigma.shape
    # What an eye behind step k would see, and how much light would come through to it.
    seen, through = [np.tile(background, (R, 1))], [np.ones(R)]
    for k in range(S - 1, 0, -1):
        x = sigma[:, k] * dt[:, k]
        seen.append(-np.expm1(-x)[:, None] * color[:, k] + np.exp(-x)[:, None] * seen[-1])
        through.append(np.exp(-x) * through[-1])
    seen, through = seen[::-1], through[::-1]
    d_seen, d_through = d_pixel, d_T_end
    d_sigma, d_color = np.zeros((R, S)), np.zeros(color.shape)
    for k in range(S):
        x = sigma[:, k] * dt[:, k]
        passed = np.exp(-x)
        change = np.sum(d_seen * (color[:, k] - seen[k]), axis=1) - d_through * through[k]
        d_sigma[:, k] = dt[:, k] * passed * change
        d_color[:, k] = -np.expm1(-x)[:, None] * d_seen
        d_seen, d_through = passed[:, None] * d_seen, passed * d_through
    return d_sigma, d_color, d_seen.sum(axis=0)


def ray_box(low, high, origins, directions):
    R = len(origins)
    near, far = np.zeros(R), np.full(R, np.inf)
    missed = np.zeros(R, dtype=bool)
    for axis in range(3):
        o, d = origins[:, axis], directions[:, axis]
        moving = d != 0
        missed |= ~moving & ((o < low[axis]) | (o > high[axis]))
        safe = np.where(moving, d, 1.0)
        one, two = (low[axis] - o) / safe, (high[axis] - o) / safe
        near = np.where(moving, np.maximum(near, np.minimum(one, two)), near)
        far = np.where(moving, np.minimum(far, np.maximum(one, two)), far)
    hit = (near < far) & ~missed
    return near * hit, np.where(hit, far, 0.0)


def _hats(n, place):
    """Weight of each of n voxels in a row at each clamped coordinate: (N, n)."""
    x = np.clip(n * place - 0.5, 0.0, n - 1.0)
    return np.maximum(0.0, 1.0 - np.abs(x[:, None] - np.arange(n)))


def trilinear(grid, u):
    X, Y, Z, C = grid.shape
    x, y, z = _hats(X, u[:, 0]), _hats(Y, u[:, 1]), _hats(Z, u[:, 2])
    rows = (x @ grid.reshape(X, -1)).reshape(len(u), Y, Z * C)
    rows = np.sum(y[:, :, None] * rows, axis=1).reshape(len(u), Z, C)
    return np.sum(z[:, :, None] * rows, axis=1)


def trilinear_adjoint(shape, u, g):
    X, Y, Z = shape
    x, y, z = _hats(X, u[:, 0]), _hats(Y, u[:, 1]), _hats(Z, u[:, 2])
    outer = y[:, :, None, None] * z[:, None, :, None] * g[:, None, None, :]
    return (x.T @ outer.reshape(len(u), -1)).reshape(X, Y, Z, g.shape[1])


def render_adjoint(grid, low, high, origins, directions, n, background, d_pixel):
    R = len(origins)
    u, dt = ray_samples(low, high, origins, directions, n)
    u = u.reshape(R * n, 3)
    samples = trilinear(grid, u).reshape(R, n, 4)
    sigma, color = samples[:, :, 3], samples[:, :, 0:3]
    d_sigma, d_color, d_background = composite_adjoint(
        sigma, color, dt, background, d_pixel, np.zeros(R)
    )
    d_samples = np.zeros((R, n, 4))
    d_samples[:, :, 0:3] = d_color
    d_samples[:, :, 3] = d_sigma
    return trilinear_adjoint(grid.shape[:3], u, d_samples.reshape(R * n, 4)), d_background

"""Transmittance by products; for each step the later ones are summed anew. Accepted on purpose.

That is quadratic in the number of steps, but in slices of NumPy: at 160 steps it costs about as
much as a loop over steps. Written with a second loop over steps it is a mutant (adjoint_quadratic).
"""

import numpy as np
from volume_rendering import ray_samples


def composite(sigma, color, dt, background):
    passed = np.exp(-(sigma * dt))
    T = np.cumprod(passed, axis=1)
    weights = np.concatenate([np.ones((len(T), 1)), T[:, :-1]], axis=1) * -np.expm1(-(sigma * dt))
    total = np.zeros((len(sigma), color.shape[2]))
    for k in reversed(range(sigma.shape[1])):
        total = total + weights[:, k, None] * color[:, k]
    return total + T[:, -1:] * background[None], T[:, -1]


def composite_adjoint(sigma, color, dt, background, d_pixel, d_T_end):
    passed = np.exp(-(sigma * dt))
    T = np.cumprod(passed, axis=1)
    weights = np.concatenate([np.ones((len(T), 1)), T[:, :-1]], axis=1) * -np.expm1(-(sigma * dt))
    light = weights * np.sum(color * d_pixel[:, None, :], axis=2)
    last = T[:, -1] * (np.sum(background * d_pixel, axis=1) + d_T_end)
    d_sigma = np.zeros(sigma.shape)
    for k in range(sigma.shape[1]):
        mine = T[:, k] * np.sum(color[:, k] * d_pixel, axis=1)
        d_sigma[:, k] = (mine - np.sum(light[:, k + 1 :], axis=1) - last) * dt[:, k]
    d_color = np.einsum("rs,rc->rsc", weights, d_pixel)
    return d_sigma, d_color, np.sum(T[:, -1:] * d_pixel, axis=0)


def ray_box(low, high, origins, directions):
    near, far = [], []
    for r in range(len(origins)):
        o, d = origins[r], directions[r]
        crossings = [
            sorted(((low[a] - o[a]) / d[a], (high[a] - o[a]) / d[a])) for a in range(3) if d[a] != 0
        ]
        outside = any(d[a] == 0 and not low[a] <= o[a] <= high[a] for a in range(3))
        t0, t1 = max([0.0] + [c[0] for c in crossings]), min(c[1] for c in crossings)
        if outside or t1 <= t0:
            t0 = t1 = 0.0
        near.append(t0)
        far.append(t1)
    return np.array(near), np.array(far)


def _mixed(a, b, t):
    return a + t[:, None] * (b - a)


def trilinear(grid, u):
    X, Y, Z, _ = grid.shape
    x, y, z = (np.clip(u[:, a] * n - 0.5, 0, n - 1) for a, n in enumerate((X, Y, Z)))
    i, j, k = (np.floor(c).astype(int) for c in (x, y, z))
    ii, jj, kk = np.minimum(i + 1, X - 1), np.minimum(j + 1, Y - 1), np.minimum(k + 1, Z - 1)
    low = _mixed(
        _mixed(grid[i, j, k], grid[ii, j, k], x - i),
        _mixed(grid[i, jj, k], grid[ii, jj, k], x - i),
        y - j,
    )
    high = _mixed(
        _mixed(grid[i, j, kk], grid[ii, j, kk], x - i),
        _mixed(grid[i, jj, kk], grid[ii, jj, kk], x - i),
        y - j,
    )
    return _mixed(low, high, z - k)


def trilinear_adjoint(shape, u, g):
    X, Y, Z = shape
    x, y, z = (np.clip(u[:, a] * n - 0.5, 0, n - 1) for a, n in enumerate((X, Y, Z)))
    i, j, k = (np.floor(c).astype(int) for c in (x, y, z))
    out = np.zeros((X, Y, Z, g.shape[1]))
    for ci, wx in ((i, 1 - (x - i)), (np.minimum(i + 1, X - 1), x - i)):
        for cj, wy in ((j, 1 - (y - j)), (np.minimum(j + 1, Y - 1), y - j)):
            for ck, wz in ((k, 1 - (z - k)), (np.minimum(k + 1, Z - 1), z - k)):
                np.add.at(out, (ci, cj, ck), (wx * wy * wz)[:, None] * g)
    return out


def render_adjoint(grid, low, high, origins, directions, n, background, d_pixel):
    points, dt = ray_samples(low, high, origins, directions, n)
    points = points.reshape(-1, 3)
    values = trilinear(grid, points).reshape(-1, n, 4)
    slopes = composite_adjoint(
        values[:, :, 3], values[:, :, :3], dt, background, d_pixel, np.zeros(len(d_pixel))
    )
    d_color = trilinear_adjoint(grid.shape[:3], points, slopes[1].reshape(-1, 3))
    d_sigma = trilinear_adjoint(grid.shape[:3], points, slopes[0].reshape(-1, 1))
    return np.concatenate([d_color, d_sigma], axis=3), slopes[2]

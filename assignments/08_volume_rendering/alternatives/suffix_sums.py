"""Whole arrays throughout: a ray is kept whole, sums run from its end, np.bincount."""

import numpy as np
from volume_rendering import ray_samples


def _weights(sigma, dt):
    """Weights (R, S), and T in front of each step and at the end (R, S + 1)."""
    x = sigma * dt
    T = np.exp(-np.concatenate([np.zeros((len(x), 1)), np.cumsum(x, axis=1)], axis=1))
    return -T[:, :-1] * np.expm1(-x), T


def composite(sigma, color, dt, background):
    weights, T = _weights(sigma, dt)
    return (weights[:, None, :] @ color)[:, 0] + np.outer(T[:, -1], background), T[:, -1].copy()


def composite_adjoint(sigma, color, dt, background, d_pixel, d_T_end):
    weights, T = _weights(sigma, dt)
    own = np.einsum("rsc,rc->rs", color, d_pixel)
    last = (d_pixel @ background + d_T_end) * T[:, -1]
    light = np.concatenate([weights * own, last[:, None]], axis=1)
    from_here = np.cumsum(light[:, ::-1], axis=1)[:, ::-1]
    d_sigma = dt * (T[:, 1:] * own - from_here[:, 1:])
    return d_sigma, weights[:, :, None] * d_pixel[:, None, :], T[:, -1] @ d_pixel


def ray_box(low, high, origins, directions):
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / directions
        a, b = (low - origins) * inverse, (high - origins) * inverse
    still = directions == 0.0
    misses = (still & ((origins < low) | (origins > high))).any(axis=1)
    near = np.where(still, 0.0, np.minimum(a, b)).max(axis=1, initial=0.0)
    far = np.where(still, np.inf, np.maximum(a, b)).min(axis=1)
    empty = misses | (far <= near)
    return np.where(empty, 0.0, near), np.where(empty, 0.0, far)


def _corners(shape, u):
    """Flat numbers (8, N) of the voxels of each place and their weights (8, N)."""
    size = np.array(shape)
    place = u * size - 0.5
    cell = np.floor(place)
    above = place - cell
    numbers, weights = [], []
    for offset in np.ndindex(2, 2, 2):
        index = np.clip(cell + offset, 0, size - 1).astype(np.int64)
        numbers.append((index[:, 0] * size[1] + index[:, 1]) * size[2] + index[:, 2])
        weights.append(np.where(offset, above, 1 - above).prod(axis=1))
    return np.stack(numbers), np.stack(weights)


def trilinear(grid, u):
    numbers, weights = _corners(grid.shape[:3], u)
    return np.einsum("kn,knc->nc", weights, grid.reshape(-1, grid.shape[3])[numbers])


def trilinear_adjoint(shape, u, g):
    numbers, weights = _corners(shape, u)
    voxels = int(np.prod(shape))
    channels = [
        np.bincount(numbers.ravel(), (weights * g[:, c]).ravel(), minlength=voxels)
        for c in range(g.shape[1])
    ]
    return np.stack(channels, axis=-1).reshape(*shape, g.shape[1])


def render_adjoint(grid, low, high, origins, directions, n, background, d_pixel):
    u, dt = ray_samples(low, high, origins, directions, n)
    u = u.reshape(-1, 3)
    samples = trilinear(grid, u).reshape(len(origins), n, 4)
    d_sigma, d_color, d_background = composite_adjoint(
        samples[..., 3], samples[..., :3], dt, background, d_pixel, np.zeros(len(origins))
    )
    d_samples = np.dstack([d_color, d_sigma]).reshape(-1, 4)
    return trilinear_adjoint(grid.shape[:3], u, d_samples), d_background

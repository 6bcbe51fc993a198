"""Small helpers for the marcher's tests: settings, one ray, and a march on plain arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd._compiled import _core

CODES = {"origin": 0, "entry": 1, "alpha": 0, "riemann": 1, "clamp": 0, "zero": 1}


def settings(**changes: Any) -> Any:
    """March settings with identity activations, so that parameters are densities and colors."""
    values: dict[str, Any] = {
        "box": [[-1, -1, -1], [1, 1, 1]],
        "dt": 0.05,
        "stop": 0.0,
        "lattice": 0,
        "quadrature": 0,
        "border": 0,
        "density_activation": 0,
        "color_activation": 0,
        "density_scale": 1.0,
    }
    values.update({k: CODES.get(v, v) if isinstance(v, str) else v for k, v in changes.items()})
    return _core.MarchSettings(**values)


def constant_grid(sigma_t: float, color: tuple[float, float, float], n: int = 4) -> Any:
    grid = np.empty((n, n, n, 4))
    grid[..., :3] = color
    grid[..., 3] = sigma_t
    return grid


def field_grid(function: Any, n: int) -> Any:
    """Values of function(x, y, z) -> (..., 4) at the voxel centers of [-1, 1]^3."""
    c = (np.arange(n) + 0.5) / n * 2 - 1
    return np.ascontiguousarray(function(*np.meshgrid(c, c, c, indexing="ij")))


def bundle(count: int, seed: int, dtype: Any = np.float64) -> tuple[Any, Any]:
    """Rays from a sphere of radius 3 through the box, none of them along an axis."""
    g = np.random.default_rng(seed)
    origins = g.standard_normal((count, 3))
    origins *= 3 / np.linalg.norm(origins, axis=1, keepdims=True)
    directions = g.uniform(-0.7, 0.7, (count, 3)) - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return origins.astype(dtype), directions.astype(dtype)


def along_x(origin: float = -3.0) -> tuple[Any, Any]:
    """One ray along +X through the middle of the box."""
    return np.array([[origin, 0.1, -0.2]]), np.array([[1.0, 0.0, 0.0]])


def march(grid: Any, s: Any, rays: tuple[Any, Any], *, fused: bool = True) -> tuple[Any, ...]:
    t0, samples = _core.place_samples(s, *rays)
    return (*_core.march("dense_grid", grid, s, (*rays, t0, samples), fused), t0, samples)


def march_backward(
    grid: Any,
    s: Any,
    rays: tuple[Any, Any],
    out: tuple[Any, ...],
    d: tuple[Any, Any, Any],
    *,
    fused: bool = True,
) -> Any:
    color, transmittance, depth, t0, samples = out
    d_grid = np.zeros_like(grid)
    outputs = color, transmittance, depth
    _core.march_backward(
        "dense_grid", grid, s, (*rays, t0, samples), outputs, d, d_grid, fused=fused
    )
    return d_grid

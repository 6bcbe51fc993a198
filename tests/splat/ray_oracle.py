"""Rays through Gaussians one by one in NumPy: no tree, no rounds, no whitening. Small scenes."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd import sh
from photograd.splats.rays import RayOptions
from photograd.splats.splatting import Gaussians

from tests.splat import oracle

Array = Any


def crossing(g: Gaussians, i: int, origin: Array, n: Array) -> tuple[Array, Array]:
    """Where the density of Gaussian i is largest on each ray, and q there."""
    R = oracle.rotation(g.quats[i])
    precision = R @ np.diag(np.exp(-2 * g.log_scales[i])) @ R.T
    away = g.means[i] - origin
    t = np.einsum("ri,ij,rj->r", n, precision, away) / np.einsum("ri,ij,rj->r", n, precision, n)
    x = origin + t[:, None] * n - g.means[i]
    return t, np.einsum("ri,ij,rj->r", x, precision, x)


def render(
    g: Gaussians, origins: Array, directions: Array, background: Array, o: RayOptions
) -> dict[str, Array]:
    """color (R, 3), opacity (R,), depth (R,), crossings (R,)."""
    n = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    found = [crossing(g, i, origins, n) for i in range(len(g))]
    t = np.stack([f[0] for f in found], 1)
    q = np.stack([f[1] for f in found], 1)
    raw = np.exp(-0.5 * q) / (1 + np.exp(-g.opacity_logits))
    alpha = np.minimum(raw, o.alpha_max)
    # exp(-80) is nothing to the core, whatever alpha_min says.
    seen = (t >= o.t_min) & (raw >= o.alpha_min) & (q < 160)
    rgb = np.maximum(np.einsum("rk,nkc->rnc", sh.basis(n, g.degree), g.sh) + 0.5, 0)
    out = {"color": np.zeros((len(n), 3)), "opacity": np.zeros(len(n)), "depth": np.zeros(len(n))}
    count = np.zeros(len(n), int)
    for r in range(len(n)):
        T = 1.0
        for i in np.argsort(t[r], kind="stable"):
            if not seen[r, i]:
                continue
            if T * (1 - alpha[r, i]) < o.stop:
                break
            out["color"][r] += T * alpha[r, i] * rgb[r, i]
            out["depth"][r] += T * alpha[r, i] * t[r, i]
            T *= 1 - alpha[r, i]
            count[r] += 1
        out["color"][r] += T * background
        out["opacity"][r] = 1 - T
    return {**out, "crossings": count}


def rays(count: int, seed: int) -> tuple[Array, Array]:
    """Rays from all around towards the middle, directions of any length; some start inside."""
    g = np.random.default_rng(seed)
    origins = g.standard_normal((count, 3))
    origins *= (g.choice([0.3, 3.0], count, p=[0.2, 0.8]) / np.linalg.norm(origins, axis=1))[
        :, None
    ]
    directions = g.uniform(-0.7, 0.7, (count, 3)) - origins
    return origins, directions * g.uniform(0.3, 3, (count, 1))

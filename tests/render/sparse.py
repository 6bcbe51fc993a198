"""Sparse spherical-harmonic scenes for tests, and the march through them in plain NumPy.

The oracle takes complex parameters, so that its derivative along a direction v is exact:
J v = Im f(x + i h v) / h, with nothing cancelled.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from photograd import sh
from photograd._compiled import _core
from photograd.fields.active_voxels import ActiveVoxels

from tests.render.rays import bundle, settings

GROUPS = ("density", "sh", "background")


@dataclass(frozen=True)
class Scene:
    """A field, rays through it, and how it is marched."""

    active: ActiveVoxels
    place: dict[str, Any]  # density (N,), sh (N, K, 3), background (1 + 3 K,)
    rays: tuple[Any, Any]
    options: dict[str, Any]
    offset: float = 0.0

    @property
    def settings(self) -> Any:
        return settings(**self.options)

    def samples(self) -> tuple[Any, Any]:
        return _core.place_samples(self.settings, *self.rays)


def scene(
    seed: int,
    *,
    degree: int = 2,
    shape: tuple[int, int, int] = (11, 9, 10),
    dense: float = 0.6,
    count: int = 20,
    dtype: Any = np.float64,
    offset: float = 0.0,
    **options: Any,
) -> Scene:
    """Random values on a random part of the voxels; many cells are half active."""
    g = np.random.default_rng(seed)
    active = ActiveVoxels(g.random(shape) < dense)
    k = sh.count(degree)
    place = {
        "density": g.uniform(-0.5, 2.0, len(active)),
        "sh": g.uniform(-0.5, 0.5, (len(active), k, 3)),
        "background": g.uniform(-0.3, 0.3, 1 + 3 * k),
    }
    place = {name: value.astype(dtype) for name, value in place.items()}
    options = {"dt": 0.07, "density_activation": 2, "color_activation": 4, **options}
    return Scene(active, place, bundle(count, seed, dtype), options, offset)


def march(s: Scene, place: dict[str, Any], *, fused: bool = True, skip: bool = True) -> Any:
    """Color, transmittance, depth, and the number of samples looked up."""
    return _core.march_sparse_sh(
        s.active.table,
        [place[g] for g in GROUPS],
        s.settings,
        s.offset,
        (*s.rays, *s.samples()),
        fused=fused,
        skip=skip,
    )


def march_backward(
    s: Scene,
    place: dict[str, Any],
    d: tuple[Any, ...],
    *,
    fused: bool = True,
    into: dict[str, Any] | None = None,
    camera: tuple[Any, Any] | None = None,
) -> dict[str, Any]:
    """{group: gradient}; with `camera`, dL/d origins and directions are added to its arrays."""
    out = march(s, place, fused=fused)[:3]
    gradients = into or {g: np.zeros_like(place[g]) for g in GROUPS}
    _core.march_sparse_sh_backward(
        s.active.table,
        [place[g] for g in GROUPS],
        s.settings,
        s.offset,
        (*s.rays, *s.samples()),
        out,
        d,
        [gradients[g] for g in GROUPS],
        camera,
        fused=fused,
    )
    return gradients


def with_rays(s: Scene, origins: Any, directions: Any) -> Scene:
    return replace(s, rays=(origins, directions))


ACTIVATIONS: dict[int, Any] = {
    0: lambda x: x,
    1: lambda x: np.where(x.real > 0, x, 0),
    2: lambda x: np.where(x.real > 0, x, 0) + np.log1p(np.exp(np.where(x.real > 0, -x, x))),
    3: np.exp,
    4: lambda x: 1 / (1 + np.exp(-x)),
}


def oracle(s: Scene, place: dict[str, Any]) -> dict[str, Any]:
    """Color (R, 3), transmittance (R,), depth (R,) of the scene, sample by sample."""
    shape = np.array(s.active.shape)
    rows = np.full(shape + 3, -1)  # one voxel of nothing in front, two behind
    rows[1:-2, 1:-2, 1:-2] = s.active.rows
    t0, samples = s.samples()
    dt = s.options["dt"]
    color, through, depth = [], [], []
    for ray, (o, d) in enumerate(zip(*s.rays, strict=True)):
        t = t0[ray] + (np.arange(samples[ray]) + 0.5) * dt
        q = (o + t[:, None] * d + 1) / 2 * shape - 0.5
        base = np.floor(q).astype(int)
        f = q - base
        Y = sh.basis(d[None], sh.degree_of(place["sh"].shape[1]))[0]
        raw, rgb = np.zeros(len(t), complex), np.zeros((len(t), 3), complex)
        any_row = np.zeros(len(t), bool)
        for corner in np.ndindex(2, 2, 2):
            row = rows[tuple((base + corner + 1).T)]
            w = np.prod(np.where(corner, f, 1 - f), axis=1)
            here = row >= 0
            any_row |= here
            raw += w * np.where(here, place["density"][row], place["background"][0])
            spread = place["background"][1:].reshape(-1, 3)
            values = np.where(here[:, None, None], place["sh"][row], spread)
            rgb += w[:, None] * np.einsum("k,nkc->nc", Y, values)
        sigma = ACTIVATIONS[s.options["density_activation"]](raw)
        sigma = np.where(any_row, sigma, 0) * s.options.get("density_scale", 1.0)
        rgb = ACTIVATIONS[s.options["color_activation"]](rgb + s.offset)
        tau = np.cumsum(sigma * dt)
        front = np.exp(-(tau - sigma * dt))
        alpha = sigma * dt if s.options.get("quadrature") == "riemann" else -np.expm1(-sigma * dt)
        w = front * alpha
        color.append(w @ rgb)
        depth.append(w @ t)
        through.append(np.exp(-tau[-1]) if len(t) else 1.0)
    return {"color": np.array(color), "transmittance": np.array(through), "depth": np.array(depth)}

"""A second implementation of the model `standard`, and of pictures of balls made of it.

Plain NumPy in double, written from the formulas as Filament prints them [Guy2018, Sec. 4]: one f0
of dielectric and metal together, Smith's function by its Lambda, world space instead of a shading
frame. Nothing of the core is used: not its reflectance, rays, spheres, shadows, lights or lookups.

    f = (1 - metalness) base_color / pi + D G F / (4 <n,wi> <n,wo>)
    D = a^2 / (pi (<n,h>^2 (a^2 - 1) + 1)^2),  a = roughness^2
    G = 1 / (1 + Lambda(wi) + Lambda(wo)),       Lambda(w) = (sqrt(1 + a^2 tan^2 w) - 1) / 2
    F = f0 + (1 - f0) (1 - <wo,h>)^5,           f0 = 0.16 reflectance^2 (1 - m) + base_color m
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.random import uniform

Array = Any
FAULTS = {
    "alpha is the roughness": {"power": 1.0},
    "a denominator of 2 for 4": {"denominator": 2.0},
    "no masking": {"smith": "none"},
    "f0 of glass for metals": {"tinted": False},
    "a ground below metals": {"ground": "always"},
    "the angle to the normal in Schlick's ramp": {"ramp": "nv"},
}
"""Mistakes that are often made: what each changes in `Form`."""


@dataclass(frozen=True)
class Form:
    """The formula; other values than these are mistakes, which pictures have to show."""

    power: float = 2.0
    denominator: float = 4.0
    smith: str = "correlated"
    tinted: bool = True
    ground: str = "dielectric"
    ramp: str = "vh"


RIGHT = Form()


@dataclass(frozen=True)
class Balls:
    """B balls: centers (B, 3), radii (B,), and one value a ball of each parameter of the model."""

    centers: Array
    radii: Array
    base_color: Array
    metalness: Array
    roughness: Array
    reflectance: Array


def dot(a: Array, b: Array) -> Array:
    return (a * b).sum(axis=-1)


def unit(a: Array) -> Array:
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def ground(balls: Balls, k: Array, form: Form = RIGHT) -> Array:
    """f of the diffuse part, (..., 3)."""
    rest = (1 - balls.metalness[k])[..., None] if form.ground == "dielectric" else 1.0
    return rest * balls.base_color[k] / np.pi


def lobe(balls: Balls, k: Array, n: Array, wo: Array, wi: Array, form: Form = RIGHT) -> Array:
    """f of the glossy part, (..., 3), for wi and wo above the surface."""
    h = unit(wo + wi)
    nl, nv, nh, vh = dot(n, wi), dot(n, wo), dot(n, h), dot(wo, h)
    a = balls.roughness[k] ** form.power
    D = facets(a, nh)
    G = 1.0 if form.smith == "none" else 1 / (1 + hidden(a, nl) + hidden(a, nv))
    metal = balls.metalness[k][..., None] if form.tinted else 0.0
    dielectric = 0.16 * balls.reflectance[k][..., None] ** 2
    f0 = dielectric * (1 - metal) + balls.base_color[k] * metal
    ramp = (1 - (vh if form.ramp == "vh" else nv))[..., None] ** 5
    F = f0 + (1 - f0) * ramp
    return F * (D * G / (form.denominator * nl * nv))[..., None]


def facets(a: Array, nh: Array) -> Array:
    """GGX."""
    return a**2 / (np.pi * (nh**2 * (a**2 - 1) + 1) ** 2)


def hidden(a: Array, cosine: Array) -> Array:
    """Smith's Lambda."""
    return (np.sqrt(1 + a**2 * (1 / cosine**2 - 1)) - 1) / 2


def rays(camera: Any, columns: Array, rows: Array) -> tuple[Array, Array]:
    """Origins and unit directions through points of the picture, in pixels."""
    pose = camera.world_from_camera
    x, y = (columns - camera.cx) / camera.fx, (rows - camera.cy) / camera.fy
    d = np.stack([x, y, np.ones_like(x)], axis=-1) @ pose[:3, :3].T
    return np.broadcast_to(pose[:3, 3], d.shape), unit(d)


def nearest(balls: Balls, o: Array, d: Array) -> tuple[Array, Array]:
    """Number of the ball that each ray meets first, and how far away: infinity if none."""
    gap = balls.centers - o[..., None, :]
    along = dot(gap, d[..., None, :])
    aside = dot(gap, gap) - along**2
    inside = balls.radii**2 - aside
    t = along - np.sqrt(np.where(inside > 0, inside, np.nan))
    t = np.where(t > 1e-6, t, np.inf)
    k = t.argmin(axis=-1)
    return k, np.take_along_axis(t, k[..., None], -1)[..., 0]


def free(balls: Balls, k: Array, x: Array, wi: Array, reach: Array = np.inf) -> Array:
    """Whether nothing stands between points on balls k and what lies in directions wi."""
    gap = balls.centers - x[..., None, :]
    along = dot(gap, wi[..., None, :])
    inside = balls.radii**2 - dot(gap, gap) + along**2
    enter = along - np.sqrt(np.maximum(inside, 0))
    others = np.arange(len(balls.radii)) != k[..., None]  # a ball hides nothing above itself
    blocked = others & (inside > 0) & (enter > 0) & (enter < np.expand_dims(reach, -1))
    return ~blocked.any(axis=-1)


def lamps_at(x: Array, lamps: Any) -> Any:
    """(direction, irradiance of a surface that faces it, distance) of each light at (..., 3)."""
    for kind, place, color in lamps:
        if kind == "directional":
            wi = np.broadcast_to(unit(np.asarray(place, float)), x.shape)
            yield wi, np.broadcast_to(color, x.shape), np.inf
        else:
            to = np.asarray(place, float) - x
            r = np.linalg.norm(to, axis=-1)
            yield unit(to), np.asarray(color) / r[..., None] ** 2, r


def lamp_picture(
    balls: Balls, lamps: Any, camera: Any, *, spp: int, seed: int, form: Form = RIGHT
) -> Array:
    """Direct light of point lights, black background, (H, W, 3).

    Pixels are averaged over the points of samples that address (seed, pixel, sample) gives.
    """
    pixel = np.arange(camera.width * camera.height)[:, None]
    u, v = (uniform(seed, pixel=pixel, sample=np.arange(spp), dimension=d) for d in (0, 1))
    o, d = rays(camera, pixel % camera.width + u, pixel // camera.width + v)
    k, t = nearest(balls, o, d)
    seen = np.isfinite(t)
    k, o, d, t = k[seen], o[seen], d[seen], t[seen]
    x = o + t[:, None] * d
    n = unit(x - balls.centers[k])
    found = np.zeros((len(x), 3))
    for wi, irradiance, reach in lamps_at(x, lamps):
        lit = (dot(n, wi) > 0) & free(balls, k, x, wi, np.broadcast_to(reach, t.shape))
        f = ground(balls, k, form) + lobe(balls, k, n, -d, np.where(lit[:, None], wi, n), form)
        found += np.where(lit[:, None], f * irradiance * dot(n, wi)[:, None], 0)
    image = np.zeros((*seen.shape, 3))
    image[seen] = found
    return image.mean(axis=1).reshape(camera.height, camera.width, 3)

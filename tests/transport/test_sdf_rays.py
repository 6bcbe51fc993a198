"""Where rays meet signed distance functions in the tracer, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.geometry import Body
from photograd.geometry.mesh import Hits
from photograd.geometry.sdf import box, placed, sphere
from photograd.transport import PathTracer, Scene, SdfShape

from tests.geometry.shapes import random_rays
from tests.transport.scenes import GRAY, view

Array = Any
CENTER, RADIUS = np.array([0.4, 0.2, -0.3]), 0.5
HALF, SHIFT = np.array([0.3, 0.5, 0.2]), np.array([-0.5, 0.3, 0.4])


def hits(scene: Scene, origins: Array, directions: Array) -> tuple[Array, ...]:
    """Whether rays meet anything, and t, which the tracer knows as float32."""
    bvh = PathTracer(scene).wide_arguments()["geometry"].bvh
    found = Hits.empty(len(origins), np.dtype(np.float64))
    everywhere = np.zeros(1), np.array([np.inf])
    bvh.trace(
        origins,
        directions,
        *everywhere,
        found.t,
        found.primitive,
        found.instance,
        found.barycentrics,
    )
    return found.hit, found.t


def known_scene() -> Scene:
    shapes = (
        SdfShape("ball", placed(sphere(RADIUS), CENTER), "gray"),
        SdfShape("box", placed(box(HALF), SHIFT), "gray"),
    )
    return Scene("known", shapes, {"gray": GRAY}, view(4))


def ball_hit(origins: Array, directions: Array, radius: float) -> Array:
    """First t (R,) > 0 at a ball around CENTER, from outside or inside; infinite without one."""
    offset = origins - CENTER
    b, c = (offset * directions).sum(1), (offset**2).sum(1) - radius**2
    rest = b * b - c
    half = np.sqrt(np.maximum(rest, 0))
    t = np.where(c > 0, -b - half, -b + half)
    return np.where((rest > 0) & (t > 0), t, np.inf)


def box_hit(origins: Array, directions: Array, half: Array) -> Array:
    """The same at a box around SHIFT."""
    with np.errstate(divide="ignore"):
        sides = np.stack([s * half + SHIFT - origins for s in (-1, 1)]) / directions
    near, far = sides.min(axis=0).max(axis=1), sides.max(axis=0).min(axis=1)
    t = np.where(near > 0, near, far)
    return np.where((near < far) & (t > 0), t, np.inf)


def known_hit(origins: Array, directions: Array, swell: float) -> Array:
    ball = ball_hit(origins, directions, RADIUS + swell)
    return np.minimum(ball, box_hit(origins, directions, HALF + swell))


def apart(origins: Array, gap: float) -> Array:
    """Whether origins (R, 3) are farther than this from all surfaces."""
    ball = np.abs(np.linalg.norm(origins - CENTER, axis=1) - RADIUS)
    return (ball > gap) & (np.abs(Body(placed(box(HALF), SHIFT)).distance(origins)) > gap)


def test_a_million_rays_stop_at_the_first_surface() -> None:
    scene, slack = known_scene(), 2e-6  # m: the tolerance of the march, and float's rounding
    met = 0
    for seed in range(4):
        origins, directions = random_rays(250_000, seed=seed, spread=0.9)
        clear = apart(origins, 2 * slack)
        assert clear.mean() > 0.9999
        origins, directions = origins[clear], directions[clear]
        found, t = hits(scene, origins, directions)
        ways = np.stack([known_hit(origins, directions, s) for s in (-slack, 0.0, slack)])
        low, high = ways.min(axis=0), ways.max(axis=0)
        # Rays between a surface that is a little smaller and one that is a little larger: no ray
        # that meets both passes, none that misses both is stopped, and t lies between theirs.
        assert found[np.isfinite(high)].all()
        assert not found[np.isinf(low)].any()
        rounding = 1e-9
        assert (t[found] >= low[found] - rounding).all()
        assert (t[found] <= high[found] + rounding).all()
        met += int(found.sum())
    assert 150_000 < met < 750_000

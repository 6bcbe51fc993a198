"""The tree of mirrored and refracted rays [Whitted1980], of which a path tracer follows one branch.

A tree splits at every smooth surface and adds up both branches by their weights; a path chooses one
and divides by its probability. Cut at the same depth, their means are the same.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.transport import Environment, Material, PathOptions, PathTracer, Scene, SphereShape

from support.glass_ball import fresnel

ETA = 1.5
ZENITH, HORIZON, GROUND = ([1.0, 2.0, 4.0], [0.5, 0.4, 0.3], [0.1, 0.2, 0.1])
EYE = np.array([0.0, 0.0, 3.0])
SIDES = (0.0, 0.3, 0.6, 0.9, 1.3)  # tangent of the angle to the axis, thirds; the last misses


def sky(w: Any) -> Any:
    up, down = max(w[1], 0.0), max(-w[1], 0.0)
    return (1 - up - down) * np.array(HORIZON) + up * np.array(ZENITH) + down * np.array(GROUND)


def tree(origin: Any, w: Any, depth: int, inside: bool = False) -> Any:
    """Radiance along -w of a unit ball of glass under the sky, by at most `depth` segments."""
    if depth == 0:
        return np.zeros(3)
    middle = -float(origin @ w)
    rest = middle**2 - float(origin @ origin) + 1.0
    if not inside and (rest <= 0 or middle <= 0):
        return sky(w)
    t = 2 * middle if inside else middle - np.sqrt(rest)
    hit = origin + t * w
    hit /= np.linalg.norm(hit)
    n = -hit if inside else hit
    e = 1 / ETA if inside else ETA
    c = -float(n @ w)
    mirrored = w + 2 * c * n
    cos2 = 1 - (1 - c * c) / e**2
    if cos2 <= 0:
        return tree(hit, mirrored, depth - 1, inside)
    # Reflection is the same from both sides of a boundary.
    F = float(fresnel(ETA, np.array(np.sqrt(cos2) if inside else c)))
    through = w / e + (c / e - np.sqrt(cos2)) * n
    straight = tree(hit, through, depth - 1, not inside)
    return F * tree(hit, mirrored, depth - 1, inside) + (1 - F) / e**2 * straight


def needle(side: float) -> Camera:
    """One pixel, so narrow that all its rays are one."""
    w = np.array([side / 3, 0.1 * side, -1.0])
    w /= np.linalg.norm(w)
    x = np.cross(w, [0.0, 1.0, 0.0])
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3] = np.stack([x, np.cross(w, x), w, EYE], axis=1)
    return Camera(1, 1, 1e7, 1e7, 0.5, 0.5, pose)


def ball() -> PathTracer:
    clear = Material("glass", {"eta": ETA, "tint": [1.0, 1.0, 1.0]})
    dome = Environment(np.array(ZENITH), np.array(HORIZON), np.array(GROUND))
    shapes = (SphereShape("ball", np.zeros(3), 1.0, "glass"),)
    scene = Scene("ball", shapes, {"glass": clear}, needle(0.0), dome)
    return PathTracer(scene, dtype=np.float64)


@pytest.mark.parametrize("depth", [1, 2, 3, 5, 8])
def test_one_branch_at_a_time_has_the_mean_of_the_tree(depth: int) -> None:
    tracer = ball()
    options = PathOptions(max_depth=depth, roulette_from=None, sampler="independent")
    for side in SIDES:
        camera = needle(side)
        found = tracer.render(spp=4096, seed=depth, options=options, camera=camera)
        expected = tree(EYE, camera.world_from_camera[:3, 2], depth)
        error = np.maximum(found.standard_error[0, 0], 1e-9)
        assert (np.abs(found.mean[0, 0] - expected) < 4.5 * error + 1e-5).all(), (side, depth)


def test_no_light_is_lost_and_more_depth_shows_more() -> None:
    # R + T = 1, radiance being smaller by 1 / eta^2 outside: under an even sky of 1 the ball cannot
    # be seen. On the same paths every depth adds, never takes away.
    tracer = ball()
    tracer.params["environment"] = np.ones((3, 3))
    pictures = []
    for depth in (1, 2, 3, 4, 6, 40):
        options = PathOptions(max_depth=depth, roulette_from=None, sampler="independent")
        pictures.append(
            [
                tracer.render(spp=4096, seed=1, options=options, camera=needle(s)).mean[0, 0, 0]
                for s in SIDES
            ]
        )
    grown = np.diff(np.array(pictures), axis=0)
    assert (grown >= 0).all()
    assert (grown[:, :4].sum(axis=0) > 0.9).all()
    np.testing.assert_allclose(pictures[-1], 1.0, rtol=0.02)
    assert pictures[0][-1] == 1.0  # beside the ball

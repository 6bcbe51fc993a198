"""Path tracing against results that are known in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.transport import (
    Accumulation,
    Environment,
    Material,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
)
from photograd.transport.builtin import camera_at, furnace_box, white_ball
from photograd.transport.shapes import box, rectangle

from tests.transport.scenes import BLACK, FLOOR, GRAY, LAMP, bent_floor, stage, view

WHITE = Material("lambert", {"albedo": [1.0, 1.0, 1.0]})


@pytest.mark.parametrize(
    ("strategy", "albedo", "spp"),
    [
        ("bsdf", 0.3, 512),
        ("bsdf", 0.5, 512),
        ("bsdf", 0.8, 1024),
        ("mis", 0.3, 512),
        ("mis", 0.5, 512),
        ("mis", 0.8, 1024),
    ],
)
def test_furnace(strategy: str, albedo: float, spp: int) -> None:
    # Geometric series: e + a e + a^2 e + ... = e / (1 - a), from everywhere. Asking lights alone is
    # not tried: where walls meet, 1 / d^2 gives it an infinite variance.
    tracer = PathTracer(furnace_box(16, albedo, 0.7))
    options = PathOptions(strategy, max_depth=200)
    found = tracer.render(spp=spp, seed=1, options=options)
    expected = 0.7 / (1 - albedo)
    error = np.sqrt((found.standard_error[..., 0] ** 2).sum()) / 256 / expected
    assert error < 0.0017  # half a percent is three of these
    assert found.mean.mean() == pytest.approx(expected, rel=0.005)


def test_without_reflection_only_what_shines_is_seen() -> None:
    found = PathTracer(furnace_box(8, 0.0, 0.7)).render(spp=4, seed=1)
    np.testing.assert_array_equal(found.mean, np.float32(0.7))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_white_ball_cannot_be_seen(dtype: Any) -> None:
    # Every bounce off a convex white ball ends in the sky of 1: sampled by the BSDF, no variance.
    options = PathOptions("bsdf")
    found = PathTracer(white_ball(16), dtype=dtype).render(spp=8, seed=2, options=options)
    np.testing.assert_allclose(found.mean, 1.0, rtol=2e-6 if dtype == np.float32 else 1e-12)


def polygon_irradiance(corners: Any, point: Any, normal: Any) -> float:
    """Lambert's formula: E / L = 1/2 sum over edges of the angle times its plane's cosine."""
    rays = np.asarray(corners, float) - point
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    total = 0.0
    for a, b in zip(rays, np.roll(rays, -1, axis=0), strict=True):
        turn = np.cross(a, b)
        total += np.arccos(a @ b) * (turn @ normal) / np.linalg.norm(turn)
    return abs(0.5 * total)


@pytest.mark.parametrize("strategy", ["light", "bsdf", "mis"])
@pytest.mark.parametrize("heuristic", ["balance", "power"])
def test_direct_light_of_a_rectangle(strategy: str, heuristic: str) -> None:
    # One pixel of 0.01 degrees looks at a gray floor: radiance = 0.5 E / pi.
    corner, u, v = (np.array(x, float) for x in LAMP)
    lamp = [corner, corner + u, corner + u + v, corner + v]
    point = np.array([0.5, 0.0, 0.3])
    scene = stage(GRAY, ball=False)
    camera = camera_at([0.5, 1.0, 2.5], point, 0.01, 1, 1)
    options = PathOptions(strategy, heuristic, max_depth=2)
    found = PathTracer(scene, dtype=np.float64).render(
        spp=40000, seed=3, options=options, camera=camera
    )
    expected = 0.5 * 4.0 * polygon_irradiance(lamp, point, np.array([0, 1, 0])) / np.pi
    assert expected > 0.1
    error = found.standard_error[0, 0, 0]
    assert error < (0.015 if strategy == "bsdf" else 0.006) * expected
    assert abs(found.mean[0, 0, 0] - expected) < 4 * error  # false alarm: 6e-5


def test_a_mirror_shows_what_lies_behind() -> None:
    # Camera above a mirror floor: the image of the light times the reflectance; nothing else emits.
    mirror = Material("mirror", {"reflectance": [0.9, 0.5, 0.1]})
    scene = stage(GRAY, ball=False, floor=mirror)
    camera = camera_at([0.0, 1.4, 2.0], [0.0, 0.0, 1.0], 1.0, 4, 4)
    found = PathTracer(scene).render(spp=4, seed=4, camera=camera).mean
    # From (0, 1.4, 2) by y = 0 at z = 1: the reflected ray has y = 1.5 at z = -0.07, in the light.
    np.testing.assert_allclose(
        found, np.broadcast_to([4 * 0.9, 3.6 * 0.5, 3.2 * 0.1], (4, 4, 3)), rtol=1e-6
    )


def test_a_clear_ball_of_glass_neither_gains_nor_loses() -> None:
    # Under an even sky every path through clear glass ends in the sky; entering and leaving, the
    # factors 1 / eta^2 and eta^2 cancel, so the ball shows the sky's radiance.
    glass = Material("glass", {"eta": 1.5, "tint": [1.0, 1.0, 1.0]})
    ball = SphereShape("ball", np.zeros(3), 1.0, "glass")
    scene = Scene(
        "g", (ball,), {"glass": glass}, view(8, (0, 0, 4), (0, 0, 0)), Environment.constant(1.0)
    )
    found = PathTracer(scene).render(spp=512, seed=5, options=PathOptions(max_depth=200))
    total = found.standard_error.mean() / 8
    assert total < 0.002
    assert abs(found.mean.mean() - 1.0) < 4 * total


def test_a_camera_within_glass_sees_eta_squared() -> None:
    # Radiance over index squared is what a boundary keeps: inside, a sky of 1 has radiance eta^2.
    glass = Material("glass", {"eta": 1.5, "tint": [1.0, 1.0, 1.0]})
    ball = SphereShape("ball", np.zeros(3), 1.0, "glass")
    scene = Scene(
        "g",
        (ball,),
        {"glass": glass},
        view(8, (0.1, 0, 0.2), (0, 0, -1)),
        Environment.constant(1.0),
    )
    found = PathTracer(scene).render(spp=512, seed=6, options=PathOptions(max_depth=200))
    total = found.standard_error.mean() / 8
    assert total < 0.01
    assert abs(found.mean.mean() - 2.25) < 4 * total


def test_a_camera_within_a_solid_box_sees_its_inside() -> None:
    # Opaque surfaces have two sides, but only the outside of this one shines: it is dark within.
    dark = box("box", [0, 0, 0], [1, 1, 1], "gray", [1, 1, 1])
    scene = Scene("b", (dark,), {"gray": GRAY}, view(8, (0.2, 0.1, 0.1), (0, 0, -1)))
    assert not PathTracer(scene).render(spp=8, seed=7).radiance.any()
    shining = box("box", [0, 0, 0], [1, 1, 1], "gray", [1, 1, 1], inward=True)
    scene = Scene("b", (shining,), {"gray": GRAY}, view(8, (0.2, 0.1, 0.1), (0, 0, -1)))
    assert PathTracer(scene).render(spp=64, seed=7).mean.mean() == pytest.approx(2.0, rel=0.02)


def test_no_light_leaks_through_closed_walls() -> None:
    # A black room under a bright sky, with a light outside: nothing gets in, whatever the corner.
    room = box("room", [0, 0, 0], [2, 2, 2], "gray", inward=True)
    lamp = rectangle("lamp", *LAMP, "black", [1e6, 1e6, 1e6])
    for target in ([1, 1, 1], [-1, -1, 1], [1, 0, 0]):
        scene = Scene(
            "r",
            (room, lamp),
            {"gray": GRAY, "black": BLACK},
            camera_at([0, 0.1, 0], target, 60.0, 16, 16),
            Environment.constant(1e6),
        )
        assert not PathTracer(scene).render(spp=32, seed=8).radiance.any()


def test_bent_normals_do_not_create_light() -> None:
    # A white floor under a sky of 1 shows 1 with its own normals; with bent ones less, never more.
    tracer = PathTracer(bent_floor(8))
    found = tracer.render(spp=512, seed=9, options=PathOptions("bsdf"))
    floor = found.mean[4:]
    assert (floor <= 1.0 + 1e-5).all()
    assert 0.6 < floor.mean() < 0.999
    straight = PathTracer(bent_floor(8, tilt=0.0)).render(
        spp=16, seed=9, options=PathOptions("bsdf")
    )
    np.testing.assert_allclose(straight.mean[4:], 1.0, rtol=1e-5)


def test_occlusion_in_a_corner_and_in_the_open() -> None:
    # An endless wall of height h at the distance d takes (1 - c) / 2 of the weighted hemisphere,
    # where c = d / sqrt(d^2 + h^2) is the cosine of the angle under which it is seen.
    wall_height, distance = 1.0, 0.75
    shapes = (
        rectangle("floor", [-500, 0, 500], [1000, 0, 0], [0, 0, -1000], "gray"),
        rectangle("wall", [-500, 0, 0], [1000, 0, 0], [0, wall_height, 0], "gray"),
    )
    camera = camera_at([0.0, 1.0, 2.0], [0.0, 0.0, distance], 0.05, 1, 1)
    tracer = PathTracer(Scene("w", shapes, {"gray": GRAY}, camera))
    sums = Accumulation.empty(1, 1)
    tracer.add_occlusion(sums, 20000, seed=10)
    expected = 0.5 * (1 + distance / np.hypot(distance, wall_height))
    assert abs(sums.mean[0, 0, 0] - expected) < 4 * sums.standard_error[0, 0, 0]
    open_floor = Scene("f", (rectangle("floor", *FLOOR, "gray"),), {"gray": GRAY}, view(4))
    tracer = PathTracer(open_floor)
    sums = Accumulation.empty(4, 4)
    tracer.add_occlusion(sums, 20, seed=11)
    np.testing.assert_array_equal(sums.mean, 1.0)

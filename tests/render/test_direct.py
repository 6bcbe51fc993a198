"""Direct light: closed forms, the adjoint of all parameters, the same bits on any threads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.core import _core
from photograd.data.camera import Camera
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.orbit import look_at
from photograd.scenes.description import (
    SceneDescription,
    SceneMesh,
    SkyDescription,
    SunDescription,
)
from photograd.tracer import TracedScene
from photograd_course.gradcheck import check_gradient
from photograd_course.mutants import check_mutants

BLACK = np.zeros(3)
BOX = np.array([[-2.0, -2.0, -2.0], [2.0, 2.0, 2.0]])


def square(y: float, half: float, albedo: Any, *, uv: bool = False) -> SceneMesh:
    """A horizontal square that faces up."""
    corners = [[-half, y, half], [half, y, half], [half, y, -half], [-half, y, -half]]
    coordinates = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32) if uv else None
    return SceneMesh(
        np.array(corners, np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
        np.asarray(albedo, np.float32), coordinates,
    )  # fmt: skip


def scene(
    *meshes: SceneMesh, sun: Any = BLACK, sky: Any = BLACK, radius: float = 0.1,
    towards: Any = (0.0, 1.0, 0.0),
) -> SceneDescription:  # fmt: skip
    direction = np.asarray(towards) / np.linalg.norm(towards)
    light = SunDescription(direction, np.asarray(sun, float), radius)
    dome = SkyDescription(*(np.asarray(sky, float) for _ in range(3)))
    return SceneDescription("test", meshes, light, dome, BOX)


def camera(size: int = 8, eye: Any = (0.0, 1.6, 0.02)) -> Camera:
    pose = look_at(np.array(eye), np.zeros(3))
    return Camera(size, size, 2.0 * size, 2.0 * size, size / 2, size / 2, pose)


def lively(dtype: Any = np.float64) -> TracedScene:
    """A textured floor, a square with vertex colours above it that casts a shadow, sun and sky."""
    g = np.random.default_rng(3)
    floor = square(-0.2, 1.0, g.uniform(0.2, 0.8, (5, 4, 3)), uv=True)
    lid = square(0.2, 0.25, g.uniform(0.2, 0.8, (4, 3)))
    plain = square(0.0, 0.1, [0.3, 0.6, 0.2])
    sky = SkyDescription(*(g.uniform(0.2, 1.0, 3) for _ in range(3)))
    sun = SunDescription(np.array([0.6, 0.8, 0.0]), np.array([9.0, 8.0, 6.0]), 0.2)
    return TracedScene(SceneDescription("t", (floor, lid, plain), sun, sky, BOX), dtype=dtype)


def test_white_sky_gives_back_the_albedo() -> None:
    # An open plane under a dome of radiance 1 has irradiance pi: radiance = albedo, no variance.
    image = TracedScene(scene(square(0, 1.5, [0.7, 0.4, 0.1]), sky=[1, 1, 1])).render(
        camera(), spp=16, seed=1
    )
    np.testing.assert_allclose(image.alpha, 1, atol=1e-6)
    expected = np.broadcast_to([0.7, 0.4, 0.1], image.radiance.shape)
    np.testing.assert_allclose(image.radiance, expected, rtol=1e-5)


@pytest.mark.parametrize("tilt", [0.0, 0.5, 1.0])
def test_sun_irradiance_follows_the_cosine(tilt: float) -> None:
    # A disc wholly above the horizon gives E = pi L sin^2(r) cos(tilt); radiance = albedo E / pi.
    radius = 0.2
    towards = [np.sin(tilt), np.cos(tilt), 0.0]
    traced = TracedScene(
        scene(square(0, 1.5, [0.5] * 3), sun=[10, 10, 10], radius=radius, towards=towards)
    )
    image = traced.render(camera(), spp=256, seed=2)
    expected = 0.5 * 10 * np.sin(radius) ** 2 * np.cos(tilt)
    # Over 64 pixels of 256 samples the cosine varies by at most tan(tilt) r / sqrt(16384) = 0.25 %.
    assert image.radiance.mean() == pytest.approx(expected, rel=0.01)


def test_penumbra_is_between_light_and_shadow() -> None:
    # A lid of half size 0.25 m hangs 1 m above a floor under a sun of radius 0.2 rad, straight
    # above: full shadow in the middle (0.25 > tan 0.2), full light far outside, neither between.
    floor, lid = square(0, 1.5, [0.8] * 3), square(1.0, 0.25, [0.0] * 3)
    traced = TracedScene(scene(floor, lid, sun=[10, 10, 10], radius=0.2))
    under = Camera(64, 1, 40.0, 40.0, 32.0, 0.5, look_at(np.array([0, 0.7, 1e-3]), np.zeros(3)))
    row = traced.render(under, spp=256, seed=3).radiance[0, :, 0]
    full = 0.8 * 10 * np.sin(0.2) ** 2
    assert row[32] == 0
    assert row[0] == pytest.approx(full, rel=0.05)
    inside = row[(row > 0.1 * full) & (row < 0.9 * full)]
    assert len(inside) >= 8
    left = row[:32]
    assert np.corrcoef(left, np.sort(left)[::-1])[0, 1] > 0.98  # falls steadily into the shadow


def test_pixels_beside_the_object_are_empty() -> None:
    image = TracedScene(scene(square(0, 0.2, [0.5] * 3), sky=[1, 1, 1])).render(
        camera(16), spp=4, seed=4
    )
    assert image.alpha[0, 0] == 0
    assert image.alpha[8, 8] == 1
    assert not image.radiance[image.alpha == 0].any()
    assert image.depth[8, 8] == pytest.approx(1.6, rel=0.02)


@pytest.mark.parametrize("seed", [1, 2])
def test_gradient_of_every_colour_and_light(seed: int) -> None:
    traced, view = lively(), camera(6, eye=(0.3, 1.4, 0.9))

    def function(p: dict[str, Any]) -> Any:
        traced.params = {k: np.ascontiguousarray(v) for k, v in p.items()}
        return traced.render(view, spp=16, seed=seed).radiance

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        traced.params = {k: np.ascontiguousarray(v) for k, v in p.items()}
        return traced.render_backward(view, d, spp=16, seed=seed)

    start = {k: v.copy() for k, v in traced.params.items()}
    report = check_gradient(function, backward, start, seed=seed)
    assert report, str(report)
    if seed == 1:
        d = 0.2 + np.random.default_rng(5).random((6, 6, 3))
        deaths = check_mutants(
            lambda b: check_gradient(function, b, start, seed=1, coordinates=6, directions=2),
            backward, start, d,
        )  # fmt: skip
        assert deaths, str(deaths)


def test_image_and_adjoint_are_transposes() -> None:
    # The image is linear in the albedo: <J v, w> needs no derivative, only another rendering.
    traced, view = lively(), camera(6, eye=(0.3, 1.4, 0.9))
    g = np.random.default_rng(6)
    w = g.uniform(-1, 1, (6, 6, 3))
    gradient = traced.render_backward(view, w, spp=16, seed=7)["albedo"]
    v = g.uniform(-1, 1, gradient.shape)
    traced.params["albedo"] = v
    forward = traced.render(view, spp=16, seed=7).radiance
    assert np.abs(gradient).max() > 0
    assert (forward * w).sum() == pytest.approx((gradient * v).sum(), rel=1e-10)


def test_thread_count_changes_nothing() -> None:
    view = camera(24, eye=(0.3, 1.4, 0.9))
    d = np.random.default_rng(8).uniform(-1, 1, (24, 24, 3)).astype(np.float32)
    found = []
    for threads in (1, 2, 3):
        _core.set_thread_count(threads)
        traced = lively(np.float32)
        image = traced.render(view, spp=20, seed=9)
        gradient = traced.render_backward(view, d, spp=20, seed=9)
        found.append([image.radiance, image.alpha, gradient["albedo"], gradient["lights"]])
    _core.set_thread_count(0)
    for other in found[1:]:
        for a, b in zip(found[0], other, strict=True):
            assert np.array_equal(a, b)


def test_float_agrees_with_double() -> None:
    # Float rounds the sample directions: a shadow ray at an edge may fall the other way, so single
    # samples may differ; 1e-3 of the mean leaves room for a few of 36 x 16.
    view = camera(6, eye=(0.3, 1.4, 0.9))
    narrow = lively(np.float32).render(view, spp=16, seed=1).radiance
    wide = lively().render(view, spp=16, seed=1).radiance
    assert np.abs(narrow - wide).mean() < 1e-3 * wide.mean()


def test_bad_arguments_are_named() -> None:
    traced = lively()
    with pytest.raises(RangeError, match="spp: expected at least 1"):
        traced.render(camera(), spp=0, seed=0)
    with pytest.raises(ShapeError, match="d_radiance"):
        traced.render_backward(camera(8), np.zeros((4, 4, 3)), spp=1, seed=0)
    with pytest.raises(DtypeError, match="dtype"):
        TracedScene(scene(square(0, 1, [0.5] * 3)), dtype=np.float16)

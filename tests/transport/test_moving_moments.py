"""Shapes that move: every part of a path sees one and the same moment."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.lights import DirectionalLight
from photograd.transport import (
    BOUNDARY,
    Environment,
    Material,
    PathOptions,
    PathTracer,
    Scene,
    Shutter,
    SphereShape,
)
from photograd.transport.builtin import camera_at
from photograd.transport.motion import moved_on
from photograd.transport.shapes import box, rectangle
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from tests.transport.media_scenes import FOG, INK, pencil, smoke, with_interior
from tests.transport.scenes import BLACK, FLOOR, GRAY, any_material, view
from tests.transport.test_adjoint import proof
from tests.transport.test_moving_shapes import at, moving

pytestmark = pytest.mark.usefixtures("core")
Array = Any
SKY = Environment.constant(1.0)
SIGMA = np.array(INK.sigma_t)
OPTIONS = PathOptions(max_depth=5, roulette_from=2, sampler="independent")


def shift(*way: float) -> Array:
    """(4, 4)."""
    matrix = np.eye(4)
    matrix[:3, 3] = way
    return matrix


def brushed() -> Scene:
    """The dome of a metal that is brushed along its texture."""
    scene = moving()
    metal = any_material("ggx_anisotropic")
    return replace(scene, materials={**scene.materials, "gloss": metal}, textures={})


def filled(medium: Any) -> Scene:
    """A moving ball of a medium behind a moving occluder."""
    scene = moving(alpha=True)
    fog = SphereShape(
        "fog",
        np.array([-0.4, 0.6, 0.6]),
        0.5,
        BOUNDARY,
        interior="fog",
        closing=np.array([0.3, 0.7, 0.2]),
    )
    return replace(scene, shapes=(*scene.shapes, fog), media={"fog": medium})


KINDS = {
    "paint": moving,
    "veil": lambda: moving(alpha=True),
    "brushed": brushed,
    "fog": lambda: filled(FOG),
    "smoke": lambda: filled(smoke()),
}


def told(path: list[dict[str, Any]]) -> list[float]:
    """All numbers of a path, one after another."""
    parts = [path[k][key] for k in range(len(path)) for key in sorted(path[k])]
    return [float(x) for part in parts for x in flat(part)]


def flat(part: Any) -> list[Any]:
    if isinstance(part, tuple | list | np.ndarray):
        return [x for inner in part for x in flat(inner)]
    return [part]


@pytest.mark.parametrize("kind", KINDS)
def test_a_path_is_that_of_a_still_scene(kind: str) -> None:
    # The same numbers decide both: what they meet, whom they ask, and what is between, agree.
    scene = KINDS[kind]()
    tracer, seed = PathTracer(scene, dtype=np.float64), 5
    opening = PathTracer(at(scene, 0.0), dtype=np.float64)
    others = longest = 0
    for sample in range(24):
        pixel = 18 + sample  # the rows where something moves
        where = {"pixel": pixel, "sample": sample, "seed": seed, "options": OPTIONS}
        moment = _core.uniform(seed, 0, np.array([pixel], np.uint32), sample, 4 << 16)[0]
        still = PathTracer(at(scene, float(moment)), dtype=np.float64)
        found, expected = told(tracer.path(**where)), told(still.path(**where))
        np.testing.assert_allclose(found, expected, rtol=2e-4, atol=2e-5, err_msg=f"{where}")
        other = told(opening.path(**where))
        others += len(other) != len(found) or not np.allclose(other, found, 1e-2, 1e-3)
        longest = max(longest, len(tracer.path(**where)))
    assert others >= 12
    assert longest >= 3


RADIUS, WAY = 0.2, 1.5


def ball(material: str = "black", height: float = 0.0) -> SphereShape:
    """It crosses the line x = z = 0, and covers it for 2 RADIUS / WAY of the time."""
    start, end = np.array([-0.6, height, 0.0]), np.array([WAY - 0.6, height, 0.0])
    return SphereShape("ball", start, RADIUS, material, closing=end)


def test_a_ball_that_crosses_a_pixel() -> None:
    scene = Scene("c", (ball(),), {"black": BLACK}, pencil((0, 0, 3), (0, 0, 0)), SKY)
    found = PathTracer(scene).render(spp=4096, seed=1).mean
    # 4096 even moments: at most one too many or too few at each end.
    np.testing.assert_allclose(found, 1 - 2 * RADIUS / WAY, atol=2 / 4096)


def test_a_moving_edge() -> None:
    # Black up to x = e(t), which goes from -0.7 to 0.55 in a picture of -1 to 1.
    card = rectangle("card", [-3, -2, 0], [2.3, 0, 0], [0, 4, 0], "black")
    angle = 2 * np.degrees(np.arctan(1 / 1000))
    camera = camera_at([0, 0, 1000], [0, 0, 0], angle, 16, 16)
    scene = Scene("e", (moved_on(card, shift(1.25, 0, 0)),), {"black": BLACK}, camera, SKY)
    found = PathTracer(scene).render(spp=64, seed=1).mean[..., 0]
    edge = -0.7 + 1.25 * (np.arange(5000) + 0.5) / 5000
    left = -1 + np.arange(16) / 8
    expected = 1 - np.clip(8 * (edge[:, None] - left), 0, 1).mean(axis=0)
    assert ((expected > 0.05) & (expected < 0.95)).sum() == 9
    assert np.abs(found.mean(axis=0) - expected).max() < 0.01  # of the brightest
    assert np.abs(found - expected).max() < 0.05


def test_a_box_that_is_stretched() -> None:
    # Its right face goes from x = 0.5 to 1.5, seen at x = 1: half of the time it covers the pixel.
    grown = np.diag([3.0, 1.0, 1.0, 1.0])
    shape = moved_on(box("b", [0, 0, 0], [1, 1, 1], "black"), grown)
    scene = Scene("g", (shape,), {"black": BLACK}, pencil((1, 0, 3), (1, 0, 0)), SKY)
    found = PathTracer(scene).render(spp=1024, seed=1).mean
    np.testing.assert_allclose(found, 0.5, atol=1 / 1024)


def shadowed(shape: Any, materials: dict[str, Material], **more: Any) -> Array:
    """What of a sun's light a point of the floor gets while something passes overhead."""
    camera = pencil((0, 1, 3), (0, 0, 0))
    sun = DirectionalLight([0.0, 1.0, 0.0], [2.0, 2.0, 2.0])
    floor = rectangle("floor", *FLOOR, "gray")
    scene = Scene("s", (floor, shape), {"gray": GRAY, **materials}, camera, None, (sun,), **more)
    options = PathOptions(max_depth=2)
    found = PathTracer(scene, dtype=np.float64).render(spp=4096, seed=2, options=options).mean
    full = 2.0 * 0.5 / np.pi
    return found[0, 0] / full


def test_its_shadow_passes() -> None:
    found = shadowed(ball(height=3.0), {"black": BLACK})
    # At the opening, the shadow is elsewhere: 1.
    np.testing.assert_allclose(found, 1 - 2 * RADIUS / WAY, atol=2 / 4096)


def test_the_shadow_of_a_veil_passes() -> None:
    veil = Material("lambert", {"albedo": [0.5, 0.5, 0.5], "alpha": 0.6})
    found = shadowed(ball("veil", 3.0), {"veil": veil})
    through = 0.4**2  # it is entered and left
    np.testing.assert_allclose(found, 1 - 2 * RADIUS / WAY * (1 - through), atol=2 / 4096)


def test_the_shadow_of_a_medium_passes() -> None:
    ink = with_interior(box("ink", [-0.6, 3, 0], [0.4, 0.5, 1], BOUNDARY), "ink")
    found = shadowed(moved_on(ink, shift(WAY, 0, 0)), {}, media={"ink": INK})
    through = np.exp(-0.5 * SIGMA)
    np.testing.assert_allclose(found, 1 - 0.4 / WAY * (1 - through), atol=2 / 4096)


def test_a_medium_that_flies_over_the_camera() -> None:
    # 1 m of ink comes from 1 m before the camera until its middle is there.
    ink = with_interior(box("ink", [0, 0, 0], [1, 1, 1], BOUNDARY), "ink")
    camera = pencil((0, 0, 1.5), (0, 0, 0))
    flown = moved_on(ink, shift(0, 0, 1.5))
    scene = Scene("into", (flown,), {}, camera, SKY, media={"ink": INK})
    found = PathTracer(scene, dtype=np.float64).render(spp=4096, seed=1).mean
    inside = (np.exp(-SIGMA / 2) - np.exp(-SIGMA)) / (SIGMA / 2)
    expected = (2 * np.exp(-SIGMA) + inside) / 3
    np.testing.assert_allclose(found[0, 0], expected, rtol=1e-4)
    assert (np.abs(expected / np.exp(-SIGMA) - 1) > 0.02).all()


def test_a_camera_and_what_it_is_in_fly_together() -> None:
    ink = with_interior(box("ink", [0, 0, 0], [1, 1, 1], BOUNDARY), "ink")
    away = shift(5, 1, -2)
    camera = pencil((0, 0, 0), (0, 0, -1))
    scene = Scene(
        "along",
        (moved_on(ink, away),),
        {},
        camera,
        SKY,
        media={"ink": INK},
        shutter=Shutter(away @ camera.world_from_camera),
    )
    found = PathTracer(scene, dtype=np.float64).render(spp=64, seed=1).mean
    np.testing.assert_allclose(found[0, 0], np.exp(-SIGMA / 2), rtol=1e-5)


def test_grids_of_densities_stay() -> None:
    # A window moves over smoke that does not: where it is, the smoke of that place is seen.
    grid = smoke(np.linspace(0.2, 1.0, 4)[:, None, None] * np.ones((4, 2, 2)))
    ink = replace(grid, albedo=None)
    window = with_interior(box("window", [-0.6, 0.7, 0], [0.4, 1, 1], BOUNDARY), "ink")
    camera = pencil((0, 0.7, 3), (0, 0.7, 0))
    fixed = replace(window, vertices=window.vertices + np.array([0.6, 0, 0], np.float32))
    scene = Scene("w", (moved_on(window, shift(WAY, 0, 0)),), {}, camera, SKY, media={"ink": ink})
    blurred, still = (
        PathTracer(s, dtype=np.float64).render(spp=4096, seed=1).mean[0, 0]
        for s in (scene, replace(scene, shapes=(fixed,)))
    )
    assert (still < 0.6).all()
    # Estimates of transmittance by chance: the errors found are a tenth of this.
    np.testing.assert_allclose(blurred, 1 - 0.4 / WAY * (1 - still), atol=0.01)


def test_derivatives_by_media_that_move() -> None:
    scene = replace(filled(smoke()), camera=view(4))
    function, backward, start = proof(scene, OPTIONS)
    black = ("materials.black.albedo",)
    report = check_gradient(
        function, backward, start, seed=2, coordinates=1, directions=1, may_be_zero=black
    )
    assert report, str(report)


@same_bits("media that move")
def picture_of_moving_media() -> list[Any]:
    tracer = PathTracer(replace(filled(smoke()), camera=view(16)))
    return [tracer.render(spp=4, seed=3).radiance]

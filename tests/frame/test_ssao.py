"""Ambient occlusion in screen space: flat walls, corners, the traced truth, derivatives."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import Any

import numpy as np
import pytest
from photograd.frame import FrameScene, SsaoSettings, draw_surfaces, ssao, ssao_backward
from photograd.transport import PathTracer
from photograd.transport.accumulation import Accumulation
from photograd.transport.builtin import builtin_scene
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
WIDE = SsaoSettings(radius=0.6, strength=2.0)


def surfaces(scene: Any, **options: Any) -> Any:
    return draw_surfaces(FrameScene(scene, dtype=np.float64, **options), scene.camera, "opaque")[1]


def functions() -> tuple[Any, Any, dict[str, Any]]:
    visible = surfaces(replace(scenes.room(None), camera=scenes.camera(24, 16)))
    names = list(asdict(WIDE))

    def settings(p: dict[str, Any]) -> SsaoSettings:
        return SsaoSettings(**{name: float(p[name][0]) for name in names})

    def forward(p: dict[str, Any]) -> Any:
        return ssao(visible.depth, visible.shading, visible.camera, settings(p), samples=8)

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        found = ssao_backward(
            visible.depth, visible.shading, visible.camera, d, settings(p), samples=8
        )
        return {name: np.array([found[name]]) for name in names}

    return forward, backward, {name: np.array([value]) for name, value in asdict(WIDE).items()}


def test_the_settings_agree_with_central_differences() -> None:
    forward, backward, place = functions()
    assert forward(place).std() > 0.05
    report = check_gradient(forward, backward, place, seed=1)
    assert report, str(report)


def test_wrong_gradients_are_noticed() -> None:
    forward, backward, place = functions()
    cotangent = np.random.default_rng(2).uniform(-1, 1, (16, 24))
    report = check_gradient_mutants(forward, backward, place, cotangent, seed=1)
    assert report, str(report)


@pytest.mark.parametrize("size", [(96, 64), (81, 35), (17, 3), (1, 40), (33, 1)])
def test_lanes_agree_with_one_pixel_after_the_other(size: tuple[int, int]) -> None:
    """float32 goes through the kernel of lanes, float64 through its scalar form."""
    scene = replace(scenes.room(None), camera=scenes.camera(*size))
    visible = surfaces(scene)
    for samples in (1, 5, 16):
        exact = ssao(visible.depth, visible.shading, visible.camera, WIDE, samples=samples)
        depth, normals = (a.astype(np.float32) for a in (visible.depth, visible.shading))
        found = ssao(depth, normals, visible.camera, WIDE, samples=samples)
        # A sample beside an edge of the bias or the radius may fall to the other side.
        assert np.median(np.abs(found - exact)) < 1e-5
        assert np.mean(np.abs(found - exact) > 1e-3) < 0.01
        assert (found[~visible.covered] == 1).all()
    if min(size) > 16:
        assert exact.std() > 0.03


def test_depths_out_of_range_do_no_harm() -> None:
    depth = np.full((5, 20), 1e-38, np.float32)
    depth[:, ::3] = np.inf
    normals = np.zeros((5, 20, 3), np.float32)
    normals[..., 2] = -1.0
    camera = scenes.camera(20, 5)
    assert ssao(depth, normals, camera, WIDE).shape == (5, 20)


def test_a_flat_wall_does_not_occlude_itself() -> None:
    scene = replace(scenes.room(None), shapes=(scenes.floor(),))
    for bias in (0.0, 0.05):
        visible = surfaces(scene)
        found = ssao(visible.depth, visible.shading, visible.camera, replace(WIDE, bias=bias))
        if bias:
            np.testing.assert_array_equal(found, 1.0)
        else:
            np.testing.assert_allclose(found, 1.0, atol=1e-7)


@pytest.mark.parametrize(
    ("name", "part"), [("room", 0.25), ("cornell-box", 0.1), ("cornell-spheres", 0.1)]
)
def test_it_is_dark_where_the_traced_truth_is(name: str, part: float) -> None:
    scene = scenes.room(None) if name == "room" else builtin_scene(name, 64)
    ready = FrameScene(scene, dtype=np.float64)
    visible = draw_surfaces(ready, scene.camera, "opaque", "glass")[1]
    radius = part * ready.radius
    settings = SsaoSettings(radius=radius, falloff=0.25, bias=0.05, strength=2.0)
    found = ssao(visible.depth, visible.shading, scene.camera, settings, samples=32)
    sums = Accumulation.empty(scene.camera.height, scene.camera.width)
    PathTracer(scene, allow_incomplete=True).add_occlusion(sums, 64, seed=0, radius=radius)
    truth = sums.mean[..., 0]
    inside = visible.covered
    assert np.corrcoef(found[inside], truth[inside])[0, 1] > 0.7


def test_corners_are_darker_than_what_is_around_them() -> None:
    visible = surfaces(scenes.room(None))
    found = ssao(visible.depth, visible.shading, visible.camera, WIDE, samples=64)
    ball = np.linalg.norm(visible.position - [0.5, 0.0, 0.0], axis=-1)
    on_floor = visible.covered & (np.abs(visible.position[..., 1]) < 1e-6)
    near, far = on_floor & (ball < 0.35), on_floor & (ball > 1.0)
    assert found[near].mean() < found[far].mean() - 0.1
    assert (found[~visible.covered] == 1.0).all()

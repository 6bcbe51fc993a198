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

"""Emitters in smooth surfaces: points on them show gaps, directions of the reflectance do not."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd.frame import FrameOptions, FrameScene, ScreenRaySettings, ShadowSettings, frame_graph
from photograd.frame.against import compare_with_paths
from photograd.transport import Material
from photograd.transport.shapes import rectangle

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
SMOOTH = Material("ggx_metal", {"roughness": 0.2, "f0": [0.9, 0.8, 0.7]})
POINTS = FrameOptions(
    surface_points=9,
    supersampling=2,
    shadows=ShadowSettings(size=128),
    screen_rays=ScreenRaySettings(length=2.0, thickness=0.1, steps=16),
)
GATHERED = replace(POINTS, gather_samples=8)
MANY = replace(POINTS, gather_samples=32)
"""More of the light comes by the reflectance's directions than by the points."""


def lit_by_a_square(material: Material) -> Any:
    """The room under a square that emits downwards."""
    scene = scenes.room(None, material)
    square = rectangle(
        "light", [-0.8, 2.0, -1.2], [1.6, 0.0, 0.0], [0.0, 0.0, 1.6], "gray", [2.0, 1.8, 1.6]
    )
    return replace(scene, shapes=(*scene.shapes, square), camera=scenes.camera(48, 32))


@cache
def truth(smooth: bool) -> Any:
    scene = lit_by_a_square(SMOOTH if smooth else scenes.GRAY)
    (found,) = compare_with_paths(scene, POINTS, spp=256, max_depth=2)
    assert found.technique == "direct light"
    return scene, found


def against_truth(scene: Any, options: FrameOptions) -> float:
    (found,) = compare_with_paths(scene, options, spp=256, max_depth=2)
    return found.rms


def test_a_square_in_smooth_metal_is_that_of_paths() -> None:
    scene, points = truth(True)
    gathered = against_truth(scene, GATHERED)
    assert gathered < 0.03
    assert points.rms > 3 * gathered


def test_rough_surfaces_keep_the_light_of_the_points() -> None:
    """Both kinds of samples share the light; were it counted twice, it would be twice as bright."""
    scene, points = truth(False)
    assert points.rms < 0.02
    assert against_truth(scene, MANY) < 0.02


def test_light_that_is_not_shared_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The mistake: points keep their weight beside the samples."""
    scene, _ = truth(False)
    monkeypatch.setattr(
        "photograd.frame._light_passes.patch_share",
        lambda _scene, surfaces, _patch, _samples: np.ones_like(surfaces.alpha),
    )
    assert against_truth(scene, MANY) > 0.03


def test_forward_shading_keeps_to_the_points() -> None:
    scene, _ = truth(False)
    frames = [
        frame_graph(FrameScene(scene), replace(options, shading="forward", supersampling=1)).run(
            {"camera": scene.camera}
        )
        for options in (POINTS, replace(GATHERED, gather_frame=False))
    ]
    np.testing.assert_array_equal(frames[0]["direct"], frames[1]["direct"])
    assert not frames[1]["gathered"].any()

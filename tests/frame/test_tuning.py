"""Settings of the ambient occlusion come nearer to the traced truth by descent."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import FrameScene, SsaoSettings, ssao
from photograd.frame.gbuffer import draw_surfaces
from photograd.frame.tuning import traced_occlusion, tune_occlusion

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
START = SsaoSettings(radius=0.2, falloff=2.0, strength=1.0)


def test_descent_finds_better_settings_than_the_start() -> None:
    scene = FrameScene(scenes.room(None), dtype=np.float64)
    camera = scenes.camera(48, 32)
    found = tune_occlusion(scene, [camera], START, steps=40, samples=16, spp=64)
    assert found.after < 0.7 * found.before
    assert len(found.history) == 41
    assert found.settings != START
    # Rays that the descent did not have agree.
    surfaces = draw_surfaces(scene, camera, "opaque")[1]
    truth = traced_occlusion(scene, camera, spp=64, seed=9)[surfaces.covered]
    errors = []
    for settings in (START, found.settings):
        open_part = ssao(surfaces.depth, surfaces.shading, camera, settings)[surfaces.covered]
        errors.append(np.sqrt(np.mean((np.clip(open_part, 0, 1) - truth) ** 2)))
    assert errors[1] < 0.75 * errors[0]
    assert all(value > 0 for value in asdict(found.settings).values())


def test_it_needs_a_view() -> None:
    with pytest.raises(RangeError, match=r"tune_occlusion: len\(cameras\)"):
        tune_occlusion(FrameScene(scenes.room(None)), [], START)

"""The graph of a frame: each optional pass does nothing unless it is asked for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import FrameOptions, FrameScene, frame_graph
from photograd.transport.lens import Lens
from photograd.transport.scene import Environment

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
PLAIN = FrameOptions(sky_directions=0)


def displayed(options: FrameOptions, lens: Lens | None = None) -> Any:
    scene = scenes.room(scenes.LIGHTS["directional"])
    if lens is not None:
        scene = replace(scene, lens=lens)
    return frame_graph(FrameScene(scene), options).run({"camera": scene.camera})


def test_a_plain_frame_shows_its_radiance() -> None:
    found = displayed(PLAIN)
    for name in (
        "opaque",
        "layered",
        "fogged",
        "focused",
        "radiance",
        "bloom",
        "lens",
        "toned",
        "smoothed",
    ):
        np.testing.assert_array_equal(found[name], found["display"])


@pytest.mark.parametrize(
    ("change", "before", "after"),
    [
        ({"bloom_weights": (0.2, 0.1)}, "radiance", "bloom"),
        ({"aberration": 0.02}, "bloom", "lens"),
        ({"vignette": 1.0}, "bloom", "lens"),
        ({"tone_curve": "agx"}, "lens", "toned"),
        ({"exposure": 1.0}, "lens", "toned"),
        ({"fxaa": True}, "toned", "smoothed"),
        ({"dither_levels": 64}, "smoothed", "display"),
        ({"depth_of_field": 32}, "layered", "focused"),
    ],
)
def test_an_option_changes_what_its_pass_makes(
    change: dict[str, Any], before: str, after: str
) -> None:
    found = displayed(replace(PLAIN, **change), Lens(0.1, 3.0))
    assert np.abs(found[before] - found[after]).max() > 1e-3
    assert found["radiance"].shape == found["display"].shape == (64, 96, 3)


@pytest.mark.parametrize("visibility", ["occlusion", "horizon", "disks", "directional"])
def test_each_technique_hides_some_of_the_sky(visibility: Any) -> None:
    """Light under a sky is between that of nothing hidden and half of it."""
    sky = Environment([0.6, 0.8, 1.0], [0.9, 0.9, 0.9], [0.2, 0.2, 0.2])
    scene = replace(scenes.room(None), environment=sky, camera=scenes.camera(48, 32))
    found = {
        name: frame_graph(FrameScene(scene), FrameOptions(sky_directions=16, sky_visibility=name))
        .run({"camera": scene.camera}, ["sky_light", "gbuffer"])
        .buffers
        for name in ("none", visibility)
    }
    covered = found["none"]["gbuffer"].covered
    part = found[visibility]["sky_light"][covered] / found["none"]["sky_light"][covered]
    assert 0.5 < part.mean() < 0.99
    assert part.max() < 1.0 + 1e-5
    assert part.min() < 0.75


def test_a_frame_does_not_depend_on_the_one_before() -> None:
    scene = scenes.room(scenes.LIGHTS["point"])
    ready = FrameScene(scene)
    pose = scene.camera.world_from_camera.copy()
    pose[:3, 3] += [1.2, 0.3, 0.0]
    cameras = (scene.camera, replace(scene.camera, world_from_camera=pose))
    graph = frame_graph(ready, PLAIN)
    found = [graph.run({"camera": cameras[k]}, ["display"])["display"] for k in (0, 1, 0)]
    np.testing.assert_array_equal(found[0], found[2])
    assert (found[0] != found[1]).any()
    alone = frame_graph(FrameScene(scene), PLAIN).run({"camera": cameras[1]}, ["display"])
    np.testing.assert_array_equal(found[1], alone["display"])


def test_fog_hides_the_background() -> None:
    found = displayed(replace(PLAIN, fog=0.5, fog_color=(0.2, 0.3, 0.4)))
    covered = found["visibility"].covered
    assert np.abs(found["fogged"][~covered] - [0.2, 0.3, 0.4]).max() < 1e-6
    assert (found["fogged"] != found["layered"])[covered].any()


def test_options_out_of_range_are_refused() -> None:
    wrong_ones: tuple[dict[str, Any], ...] = (
        *({"layers": 65}, {"vignette": 2.0}, {"shading": "later"}, {"exposure": np.nan}),
        *({"sky_visibility": "rays"}, {"transparency": "none"}, {"fog": -1.0}),
        *({"gather_samples": -1}, {"disk_edge": 0.0}),
    )
    for wrong in wrong_ones:
        with pytest.raises(RangeError, match="FrameOptions: "):
            FrameOptions(**wrong)

"""The graph of a frame: each optional pass does nothing unless it is asked for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import FrameOptions, FrameScene, frame_graph
from photograd.transport.lens import Lens

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
    for name in ("layered", "focused", "radiance", "bloom", "lens", "toned"):
        np.testing.assert_array_equal(found[name], found["display"])


@pytest.mark.parametrize(
    ("change", "before", "after"),
    [
        ({"bloom_weights": (0.2, 0.1)}, "radiance", "bloom"),
        ({"aberration": 0.02}, "bloom", "lens"),
        ({"vignette": 1.0}, "bloom", "lens"),
        ({"tone_curve": "agx"}, "lens", "toned"),
        ({"exposure": 1.0}, "lens", "toned"),
        ({"fxaa": True}, "toned", "display"),
        ({"depth_of_field": 32}, "layered", "focused"),
    ],
)
def test_an_option_changes_what_its_pass_makes(
    change: dict[str, Any], before: str, after: str
) -> None:
    found = displayed(replace(PLAIN, **change), Lens(0.1, 3.0))
    assert np.abs(found[before] - found[after]).max() > 1e-3
    assert found["radiance"].shape == found["display"].shape == (64, 96, 3)


def test_options_out_of_range_are_refused() -> None:
    for wrong in ({"layers": 65}, {"vignette": 2.0}, {"shading": "later"}, {"exposure": np.nan}):
        with pytest.raises(RangeError, match="FrameOptions: "):
            FrameOptions(**wrong)

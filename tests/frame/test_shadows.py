"""Shadow maps beside shadow rays, and what too little or too much bias does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import (
    FrameScene,
    ShadowSettings,
    delta_lights,
    draw_shadow_map,
    draw_surfaces,
    look_up_shadow,
)
from photograd.geometry.mesh import Bvh, Mesh

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")


class Shadowed:
    """Points that a camera sees, their shadows by a map, and by rays."""

    def __init__(self, name: str) -> None:
        self.scene = FrameScene(scenes.room(scenes.LIGHTS[name]), dtype=np.float64)
        camera = scenes.camera(192, 128)
        visible = draw_surfaces(self.scene, camera, "opaque")[1]
        self.points, self.normals = (
            visible.position[visible.covered],
            visible.normal[visible.covered],
        )
        (self.light,) = delta_lights(self.scene)
        wi, irradiance = self.light.arriving(self.points)
        self.reached = (irradiance.sum(axis=1) > 0) & ((wi * self.normals).sum(axis=1) > 1e-3)

    def by_map(self, settings: ShadowSettings) -> Any:
        views = self.light.views(self.scene, settings.size)
        shadow = draw_shadow_map(self.scene, views)
        return look_up_shadow(shadow, self.points, self.normals, settings)[self.reached]

    def by_rays(self) -> Any:
        """Against the triangles that the map has drawn."""
        wi, _ = self.light.arriving(self.points)
        far = self.light.light.sample(self.points, np.full((len(self.points), 2), 0.5)).distance
        mesh = Mesh(self.scene.vertices, self.scene.faces)
        starts = self.points + 2e-3 * self.normals
        hits = Bvh([mesh]).trace(starts.astype(np.float32), wi.astype(np.float32))
        return ~(hits.t < far - 1e-2)[self.reached]


@pytest.mark.parametrize("name", scenes.LIGHTS)
def test_a_map_of_1024_differs_from_rays_at_one_pixel_of_a_hundred(name: str) -> None:
    shadowed = Shadowed(name)
    rays = shadowed.by_rays()
    assert 0.02 < 1 - rays.mean() < 0.9
    wrong = (shadowed.by_map(ShadowSettings(filter_radius=0)) > 0.5) != rays
    assert wrong.mean() <= 0.01


def test_the_sweep_of_the_bias_has_its_least_error_in_the_middle() -> None:
    shadowed = Shadowed("point")
    rays = shadowed.by_rays()
    wrong = {
        bias: ((shadowed.by_map(ShadowSettings(512, 0, 0.0, bias)) > 0.5) != rays).mean()
        for bias in (0.0, 1.5, 60.0)
    }
    assert wrong[0.0] > 5 * wrong[1.5]  # acne
    assert wrong[60.0] > 2 * wrong[1.5]  # shadows that are detached
    depth = ((shadowed.by_map(ShadowSettings(512, 0, -0.05, 0.0)) > 0.5) != rays).mean()
    assert depth > 0.3  # a bias of the wrong sign puts everything that is lit into shadow


def test_filtering_makes_steps_of_its_taps() -> None:
    values = np.unique(Shadowed("directional").by_map(ShadowSettings(256, 1)))
    np.testing.assert_allclose(9 * values, np.round(9 * values), atol=1e-12)
    assert len(values) > 4


def test_settings_out_of_range_are_refused() -> None:
    with pytest.raises(RangeError, match="ShadowSettings: filter_radius"):
        ShadowSettings(filter_radius=17)

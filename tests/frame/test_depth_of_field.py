"""Depth of field after the fact beside paths through a thin lens."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photograd.frame import FrameScene, circle_of_confusion, depth_of_field, draw_surfaces
from photograd.transport import PathOptions, PathTracer
from photograd.transport.lens import Lens

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")


def test_a_pinhole_and_the_plane_of_focus_are_sharp() -> None:
    picture = np.random.default_rng(1).uniform(0, 1, (64, 96, 3))
    depth = np.full((64, 96), 3.0)
    np.testing.assert_array_equal(
        depth_of_field(picture, depth, scenes.camera(), Lens(0.0, 2.0)), picture
    )
    np.testing.assert_array_equal(
        depth_of_field(picture, depth, scenes.camera(), Lens(0.1, 3.0)), picture
    )


def test_a_point_becomes_a_disk_of_the_circle_of_confusion() -> None:
    camera, lens = scenes.camera(96, 96), Lens(0.2, 2.0)
    picture, depth = np.zeros((96, 96, 3)), np.full((96, 96), 6.0)
    picture[48, 48] = 1.0
    radius = float(circle_of_confusion(6.0, camera, lens))
    assert radius == pytest.approx(camera.fx * 0.2 * (1 / 2 - 1 / 6))
    found = depth_of_field(picture, depth, camera, lens, samples=1024)[..., 0]
    assert found.sum() == pytest.approx(1.0, rel=0.05)
    y, x = np.indices(found.shape) - 48
    away = np.hypot(x, y)
    assert found[away > radius + 1.5].max() == 0
    inside = found[away < radius - 1.5]
    np.testing.assert_allclose(inside.mean(), 1 / (np.pi * radius * radius), rtol=0.1)


def test_it_resembles_paths_through_the_lens() -> None:
    scene = scenes.room(scenes.LIGHTS["directional"])
    lens = Lens(0.08, 3.2)
    options = PathOptions(max_depth=2)
    sharp = PathTracer(scene).render(spp=64, seed=0, options=options).mean
    truth = PathTracer(replace(scene, lens=lens)).render(spp=256, seed=1, options=options).mean
    depth = draw_surfaces(FrameScene(scene), scene.camera, "opaque")[0].depth
    found = depth_of_field(sharp, depth, scene.camera, lens, samples=128)
    before, after = (np.sqrt(np.mean((p - truth) ** 2)) for p in (sharp, found))
    assert after < 0.6 * before

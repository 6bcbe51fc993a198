"""What hides the sky: horizons, disks and rays in screen space, against closed forms and rays."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.errors import RangeError
from photograd.frame import (
    FrameScene,
    HorizonSettings,
    ScreenRaySettings,
    draw_surfaces,
    follow_screen_rays,
    horizon_occlusion,
    scene_disks,
    traced_occlusion,
)
from photograd.frame.screen_rays import LEFT_FRAME, MISSED
from photograd.transport import Scene, builtin_scene
from photograd.transport.shapes import rectangle

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
TECHNIQUES = ("horizon", "disks", "screen rays")


def surfaces(scene: Scene) -> Any:
    return draw_surfaces(FrameScene(scene, dtype=np.float64), scene.camera, "opaque", "glass")[1]


def corner() -> Scene:
    """A floor before a long wall 1 m high."""
    floor = rectangle(
        "floor", [-9.0, 0.0, 3.0], [18.0, 0.0, 0.0], [0.0, 0.0, -3.0], "gray", [0] * 3
    )
    wall = rectangle("wall", [-9.0, 0.0, 0.0], [18.0, 0.0, 0.0], [0.0, 1.0, 0.0], "gray", [0] * 3)
    return Scene("corner", (floor, wall), {"gray": scenes.GRAY}, scenes.camera(192, 128))


def cosine_directions(count: int) -> Any:
    """Around the y axis, by the cosine."""
    i = np.arange(count)
    r, phi = np.sqrt((i + 0.5) / count), np.pi * (3 - np.sqrt(5)) * i
    return np.stack([r * np.cos(phi), np.sqrt(1 - r * r), r * np.sin(phi)], axis=1)


def visible_sky(technique: str, scene: Scene, radius: float = 5.0) -> Any:
    shown = surfaces(scene)
    if technique == "horizon":
        settings = HorizonSettings(radius=radius, falloff=0.0, slices=8, steps=32)
        return horizon_occlusion(shown.depth, shown.shading, shown.camera, settings)
    if technique == "disks":
        disks = scene_disks(FrameScene(scene, dtype=np.float64), edge=0.1)
        points, normals = shown.position.reshape(-1, 3), shown.shading.reshape(-1, 3)
        return disks.occlusion(points, normals, radius=radius).reshape(shown.depth.shape)
    rays = ScreenRaySettings(length=radius, thickness=10.0, steps=64)
    directions = cosine_directions(64)
    args = (shown.depth, shown.shading, shown.camera)
    return sum((follow_screen_rays(*args, wi, rays) < 0).astype(float) for wi in directions) / 64


@pytest.mark.parametrize("technique", TECHNIQUES)
def test_nothing_hides_the_sky_from_a_flat_wall(technique: str) -> None:
    scene = replace(scenes.room(None), shapes=(scenes.floor(),))
    np.testing.assert_allclose(visible_sky(technique, scene), 1.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("technique", TECHNIQUES)
def test_a_wall_hides_what_its_form_factor_says(technique: str) -> None:
    """(1 - z / sqrt(z^2 + h^2)) / 2 of the light of a floor, at the distance z from a wall."""
    shown = surfaces(corner())
    z, around = shown.position[..., 2], np.abs(shown.position[..., 0]) < 0.5
    on_floor = shown.covered & around & (np.abs(shown.position[..., 1]) < 1e-6) & (z > 0.1)
    truth = 1 - 0.5 * (1 - z / np.sqrt(z * z + 1))
    assert truth[on_floor].min() < 0.6
    found = visible_sky(technique, corner())
    assert np.abs(found / truth - 1)[on_floor].max() < 0.1


@pytest.mark.parametrize("technique", ["horizon", "disks"])
@pytest.mark.parametrize("name", ["room", "cornell-box", "cornell-spheres"])
def test_it_is_dark_where_the_traced_truth_is(technique: str, name: str) -> None:
    scene = scenes.room(None) if name == "room" else builtin_scene(name, 64)
    ready = FrameScene(scene, dtype=np.float64)
    radius = 0.25 * ready.radius
    truth = traced_occlusion(ready, scene.camera, spp=64, radius=radius)
    inside = surfaces(scene).covered
    found = visible_sky(technique, scene, radius)
    assert np.corrcoef(found[inside], truth[inside])[0, 1] > 0.8


def stack(plates: int) -> Scene:
    """Plates of 2 m above one another, over a floor."""
    shapes = [scenes.floor()]
    for k in range(plates):
        at = 0.4 + 0.2 * k
        sides = ([0.0, 0.0, -2.0], [2.0, 0.0, 0.0])  # facing down
        shapes.append(rectangle(f"plate {k}", [-1.0, at, 1.0], *sides, "gray", [0] * 3))
    return replace(scenes.room(None), shapes=tuple(shapes))


def test_disks_behind_others_hide_less_after_a_pass() -> None:
    point, up = np.array([[0.9, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])
    found = {}
    for passes in (0, 1, 2):
        disks = [
            scene_disks(FrameScene(stack(n), dtype=np.float64), edge=0.1, passes=passes)
            for n in (1, 3)
        ]
        found[passes] = [float(each.occlusion(point, up)[0]) for each in disks]
    # Plates above the first hide little that it does not hide.
    assert found[0][0] - found[0][1] > 0.25
    assert found[1][0] - found[1][1] < 0.5 * (found[0][0] - found[0][1])


def test_rays_meet_what_they_would_meet_in_the_scene() -> None:
    """The pixel that a ray meets shows a point on the ray, to the length of a step."""
    shown = surfaces(scenes.room(None))
    wi = np.array([0.6, 0.3, -0.4]) / np.linalg.norm([0.6, 0.3, -0.4])
    rays = ScreenRaySettings(length=1.5, thickness=0.3, steps=256)
    hit = follow_screen_rays(shown.depth, shown.shading, shown.camera, wi, rays)
    met = (hit >= 0) & shown.covered
    assert met.sum() > 100
    away = shown.position.reshape(-1, 3)[hit[met]] - shown.position[met]
    beside = away - (away @ wi)[:, None] * wi
    assert np.median(np.linalg.norm(beside, axis=1)) < 0.04
    assert ((away @ wi) > 0).mean() > 0.97
    assert (hit[~shown.covered] == MISSED).all()
    assert (shown.shading.reshape(-1, 3)[hit[met]] @ wi < 0).all()


def test_rays_that_leave_the_picture_say_so() -> None:
    shown = surfaces(scenes.room(None))
    args = (shown.depth, shown.shading, shown.camera)
    up = follow_screen_rays(*args, np.array([0.0, 1.0, 0.0]), ScreenRaySettings(length=100.0))
    assert (up[shown.covered] == LEFT_FRAME).mean() > 0.5
    behind = -shown.camera.forward
    past = follow_screen_rays(*args, behind, ScreenRaySettings(length=100.0))
    assert (past[shown.covered] < 0).mean() > 0.9


def test_disks_cover_the_area_of_the_surfaces() -> None:
    scene = FrameScene(builtin_scene("cornell-box", 16))
    corners = scene.vertices[scene.faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.linalg.norm(cross, axis=1).sum()
    for edge in (10.0, 0.3, 0.07):
        disks = scene_disks(scene, edge=edge)
        assert disks.areas.sum() == pytest.approx(area, rel=1e-6)


def test_numbers_out_of_range_are_refused() -> None:
    scene = FrameScene(builtin_scene("cornell-box", 16))
    with pytest.raises(RangeError, match=r"scene_disks: edge.*raise edge"):
        scene_disks(scene, edge=1e-4)
    with pytest.raises(RangeError, match="HorizonSettings: radius"):
        HorizonSettings(radius=0.0)
    with pytest.raises(RangeError, match="ScreenRaySettings: steps"):
        ScreenRaySettings(steps=0)
    shown = surfaces(scene.scene)
    camera = Camera(9, 9, 9.0, 9.0, 4.5, 4.5, scene.scene.camera.world_from_camera)
    with pytest.raises(Exception, match="horizon_occlusion: depth"):
        horizon_occlusion(shown.depth, shown.shading, camera)

"""Clusters of triangles that are left out, coarser meshes, and depths that are drawn first."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.errors import RangeError
from photograd.frame import (
    FrameOptions,
    FrameScene,
    SceneDetail,
    ShadowSettings,
    delta_lights,
    draw_shadow_maps,
    draw_surfaces,
    frame_graph,
)
from photograd.frame.lighting import light_forward
from photograd.frame.meshlets import TRIANGLES
from photograd.geometry.icosphere import icosphere
from photograd.transport import Scene
from photograd.transport.builtin import builtin_scene
from photograd.transport.shapes import MeshShape

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
SMALL = ShadowSettings(size=128)


def ball_mesh(divisions: int = 24) -> Scene:
    """A ball of triangles over a floor."""
    mesh = icosphere(divisions)
    points = 0.4 * mesh.vertices + [0.2, 0.4, 0.0]
    ball = MeshShape("ball", points, mesh.faces, "gray", normals=mesh.vertices)
    scene = scenes.room(scenes.LIGHTS["directional"])
    return replace(scene, shapes=(scenes.floor(), ball))


def cameras(count: int) -> list[Camera]:
    """Around and inside of a room, near and far, looking anywhere."""
    g = np.random.default_rng(3)
    found = []
    for _ in range(count):
        eye, target = g.uniform(-2.5, 2.5, 3), g.uniform(-1, 1, 3)
        focal = g.uniform(20, 120)
        found.append(Camera(48, 32, focal, focal, 24, 16, look_at(eye, target)))
    return found


@pytest.mark.parametrize("name", ["room", "cornell-spheres", "ball"])
def test_clusters_outside_of_the_view_change_nothing(name: str) -> None:
    scene = {
        "room": lambda: scenes.room(None),
        "cornell-spheres": lambda: builtin_scene("cornell-spheres", 32),
        "ball": ball_mesh,
    }[name]()
    ready, left_out = FrameScene(scene), 0
    for camera in cameras(40):
        whole = ready.draw(camera, "opaque", "glass")
        found = ready.draw(camera, "opaque", "glass", culling="frustum")
        np.testing.assert_array_equal(found.face, whole.face)
        np.testing.assert_array_equal(found.depth, whole.depth)
        left_out += int((~ready.meshlets.visible(camera, ready.near, "frustum")).sum())
    assert left_out > 0


def test_clusters_have_few_triangles_of_one_shape_each() -> None:
    ready = FrameScene(ball_mesh())
    found = ready.meshlets
    counts = np.bincount(found.number)
    assert counts.max() <= TRIANGLES
    assert len(counts) < 1.2 * len(ready.faces) / TRIANGLES + 3
    for k in range(len(counts)):
        own = found.number == k
        assert len(np.unique(ready.shape[own])) == 1
        points = ready.vertices[ready.faces[own].reshape(-1)]
        assert (points >= found.boxes[k, 0]).all()
        assert (points <= found.boxes[k, 1]).all()
        assert (np.linalg.norm(points - found.center[k], axis=1) <= found.radius[k] + 1e-12).all()
    ball = counts[np.bincount(found.number, ready.shape) > 0]
    assert len(ball) > 100
    # Neighbors lie together: spheres around them are small.
    assert np.median(found.radius[1:]) < 0.4 * 0.4


def test_clusters_that_face_away_have_no_triangle_that_does_not() -> None:
    ready = FrameScene(ball_mesh())
    corners = ready.vertices[ready.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    left_out = 0
    for camera in cameras(200):
        away = ready.meshlets.faces_away(camera.position)[ready.meshlets.number]
        faces = ((corners[:, 0] - camera.position) * normals).sum(axis=1) < 0
        assert not (away & faces).any()
        left_out += away.sum()
        faces_all = FrameScene.draw(ready, camera, "opaque").face
        culled = ready.draw(camera, "opaque", culling="facing").face
        closed = (faces_all < 0) | (ready.shape[np.maximum(faces_all, 0)] == 1)
        inside = np.linalg.norm(camera.position - [0.2, 0.4, 0.0]) < 0.45
        if camera.position[1] > 0 and not inside:  # the floor is open: seen from below, it is gone
            np.testing.assert_array_equal(culled[closed], faces_all[closed])
    assert left_out > 0.2 * 200 * len(corners)


def test_a_spread_with_the_wrong_sign_is_seen() -> None:
    """The classic mistake: the cone narrowed by the spread of its normals, not widened."""
    ready = FrameScene(ball_mesh(6))
    found = ready.meshlets
    corners = ready.vertices[ready.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    wrong = replace(found, spread=np.ones_like(found.spread), radius=np.zeros_like(found.radius))
    lost = 0
    for camera in cameras(50):
        faces = ((corners[:, 0] - camera.position) * normals).sum(axis=1) < 0
        lost += int((wrong.faces_away(camera.position)[found.number] & faces).sum())
    assert lost > 0


def drawn(scene: Scene, **options: Any) -> Any:
    chosen = FrameOptions(sky_directions=0, shadows=SMALL, **options)
    return frame_graph(FrameScene(scene), chosen).run({"camera": scene.camera})


def test_the_frame_is_the_same_with_and_without() -> None:
    scene = ball_mesh()
    whole = drawn(scene, culling="none")
    for culling in ("frustum", "facing"):
        np.testing.assert_array_equal(drawn(scene, culling=culling)["display"], whole["display"])


def test_depths_drawn_first_leave_nothing_hidden_to_be_lit() -> None:
    scene = scenes.room(scenes.LIGHTS["point"])
    ready = FrameScene(scene)
    lights = delta_lights(ready)
    maps = draw_shadow_maps(ready, lights, SMALL)
    visibility, visible = draw_surfaces(ready, scene.camera, "opaque", "mask")
    args = (ready, scene.camera, lights, maps, SMALL)
    plain, shaded = light_forward(*args)
    first, fewer = light_forward(*args, visibility.depth)
    np.testing.assert_array_equal(first, plain)
    assert fewer == visible.covered.sum() < shaded
    found = drawn(scene, shading="forward", depth_prepass=True)
    np.testing.assert_allclose(found["display"], drawn(scene)["display"], atol=1e-5)


def test_far_away_coarser_meshes_are_drawn_and_the_picture_stays() -> None:
    scene = ball_mesh(48)
    detail = SceneDetail(scene)
    assert list(detail.levels) == ["ball"]
    near, counts, errors = scene.camera, [], []
    for distance in (1.0, 8.0, 30.0):
        pose = near.world_from_camera.copy()
        pose[:3, 3] *= distance
        camera = replace(near, world_from_camera=pose)
        coarse = detail.at(camera, 0.5)
        counts.append(len(FrameScene(coarse).faces))
        chosen = FrameOptions(sky_directions=0, shadows=SMALL)
        pictures = [
            frame_graph(FrameScene(s), chosen).run({"camera": camera}, ["radiance", "visibility"])
            for s in (scene, coarse)
        ]
        errors.append(np.sqrt(np.mean((pictures[0]["radiance"] - pictures[1]["radiance"]) ** 2)))
        covers = [p["visibility"].covered.sum() for p in pictures]
        assert abs(covers[0] - covers[1]) <= 0.02 * covers[0] + 2
    assert counts[0] > 4 * counts[2]
    assert counts[0] >= counts[1] >= counts[2]
    assert max(errors) < 0.02


def test_what_has_coordinates_stays_as_it_is() -> None:
    scene = builtin_scene("cornell-box", 16)
    assert SceneDetail(scene).at(scene.camera, 4.0).shapes == scene.shapes
    with pytest.raises(RangeError, match=r"SceneDetail\.at: pixels"):
        SceneDetail(scene).at(scene.camera, 0.0)

"""A camera that moves while its shutter is open."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, SceneError
from photograd.transport import PathOptions, PathTracer, Scene, Shutter, read_scene
from photograd.transport.builtin import camera_at
from photograd_course.gradcheck import check_gradient

from tests.transport.scenes import any_material, stage, view
from tests.transport.test_adjoint import OPTIONS, proof

END = camera_at([0.5, 1.0, 2.8], [0.2, 0.3, 0.0], 40.0, 8, 8).world_from_camera


def moving() -> Scene:
    return replace(stage(any_material("gltf"), sky=0.3), shutter=Shutter(END))


def poses(scene: Scene, count: int) -> list[Any]:
    """The poses in the middle of `count` equal parts of the time, by powers of the rotation."""
    start = scene.camera.world_from_camera
    values, vectors = np.linalg.eig(END[:3, :3] @ start[:3, :3].T)
    made = []
    for s in (np.arange(count) + 0.5) / count:
        part = (vectors @ np.diag(np.exp(s * np.log(values))) @ np.linalg.inv(vectors)).real
        pose = np.eye(4)
        pose[:3, :3] = part @ start[:3, :3]
        pose[:3, 3] = (1 - s) * start[:3, 3] + s * END[:3, 3]
        made.append(pose)
    return made


def test_a_picture_is_the_mean_of_still_ones() -> None:
    scene, options = moving(), PathOptions(max_depth=3, sampler="independent")
    tracer = PathTracer(scene)
    blurred = tracer.render(spp=1536, seed=1, options=options)
    mean, variance = np.zeros((8, 8, 3)), np.zeros((8, 8, 3))
    stills = poses(scene, 48)
    for number, pose in enumerate(stills):
        camera = replace(scene.camera, world_from_camera=pose)
        one = tracer.render(spp=32, seed=100 + number, options=options, camera=camera)
        mean += one.mean / len(stills)
        variance += (one.standard_error / len(stills)) ** 2
    error = np.sqrt(variance + blurred.standard_error**2)
    gap = blurred.mean - mean
    # False alarm: 6e-5 for the whole, and 1e-4 for the worst of 192 numbers at 5 errors.
    assert abs(gap.sum()) < 4 * np.sqrt((error**2).sum())
    assert np.abs(gap / error).max() < 5
    still = tracer.render(spp=512, seed=2, options=options, camera=replace(scene.camera))
    # The still picture is another: 13 errors were measured.
    assert np.abs((still.mean - mean) / error).max() > 10


def test_a_camera_that_does_not_move_takes_the_same_picture() -> None:
    scene = moving()
    bare = PathTracer(replace(scene, shutter=None)).render(spp=4, seed=3)
    closing = scene.camera.world_from_camera
    stood = PathTracer(replace(scene, shutter=Shutter(closing))).render(spp=4, seed=3)
    np.testing.assert_array_equal(stood.radiance, bare.radiance)
    other = replace(scene.camera)  # another camera than the scene's: it stands still
    np.testing.assert_array_equal(
        PathTracer(scene).render(spp=4, seed=3, camera=other).radiance, bare.radiance
    )
    assert (PathTracer(scene).render(spp=4, seed=3).radiance != bare.radiance).any()


def test_derivatives_walk_the_same_paths() -> None:
    scene = replace(moving(), camera=replace(moving().camera))
    function, backward, start = proof(scene, OPTIONS)
    report = check_gradient(function, backward, start, seed=2, coordinates=2, directions=3)
    assert report, str(report)


def test_scene_files_have_a_closing_view(tmp_path: Path) -> None:
    text = """
[camera]
position = [0, 1, 3]
look_at = [0, 0, 0]
field_of_view = 40
size = [4, 4]
closing = { position = [1, 1, 3], look_at = [0, 0, 0] }
[materials.gray]
model = "lambert"
albedo = [0.5, 0.5, 0.5]
[[shapes]]
kind = "sphere"
center = [0, 0, 0]
radius = 1
material = "gray"
"""
    (tmp_path / "s.toml").write_text(text)
    scene = read_scene(tmp_path / "s.toml")
    assert scene.shutter is not None
    expected = camera_at([1, 1, 3], [0, 0, 0], 40.0, 4, 4).world_from_camera
    np.testing.assert_array_equal(scene.shutter.closing, expected)
    way, turn = scene.shutter.motion(scene.camera)
    np.testing.assert_allclose(way, [1, 0, 0])
    assert 0.2 < np.linalg.norm(turn) < 0.4
    (tmp_path / "s.toml").write_text(text.replace("look_at = [0, 0, 0] }", "aim = 1 }"))
    with pytest.raises(SceneError, match="line 7"):
        read_scene(tmp_path / "s.toml")


def test_half_a_turn_is_refused() -> None:
    behind = view(8, (0.0, 1.2, -3.0), (0.0, 1.2, -4.0)).world_from_camera
    ahead = view(8, (0.0, 1.2, 3.0), (0.0, 1.2, 4.0))
    with pytest.raises(RangeError, match="less than half a turn"):
        Shutter(behind).motion(ahead)

"""A mesh as a representation: its camera's derivative, its files, and meshes that are refused."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import photograd
import pytest
from photograd.errors import DtypeError, RangeError, SceneError, ShapeError
from photograd.fields import MeshSurface
from photograd.geometry.icosphere import icosphere
from photograd.transport.mesh_files import read_mesh_surface, read_model

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def test_derivatives_with_respect_to_the_pose_are_proved() -> None:
    checks = photograd.check_gradients(MeshSurface, seed=0, camera=True)
    assert checks, str(checks)
    assert checks.camera is not None


def test_vertices_and_colors_are_those_it_was_made_of() -> None:
    ball = icosphere(4)
    field = MeshSurface.of_mesh(ball.vertices, ball.faces, smoothness=19.0)
    np.testing.assert_allclose(field.vertices, ball.vertices, atol=1e-5)
    assert np.array_equal(field.colors(), np.full((162, 3), 0.5))
    np.testing.assert_allclose(field.box, [[-1] * 3, [1] * 3], atol=0.1)
    assert field.resolution == 4
    assert field.shape == (162, 320)


def test_it_is_written_for_other_programs(tmp_path: Path) -> None:
    field = MeshSurface.example(seed=1, dtype=np.float32)
    (note,) = field.export(tmp_path / "mesh.glb", None)
    assert "vertex colors" in note
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # colors of vertices are not read
        shapes: Any = read_model(tmp_path / "mesh.glb").shapes
        again = read_mesh_surface(tmp_path / "mesh.glb")
    corners = shapes[0].vertices[shapes[0].faces]
    np.testing.assert_allclose(corners, field.vertices[field.faces], atol=1e-6)
    assert again.shape == field.shape
    np.testing.assert_allclose(
        np.sort(again.vertices[:, 0]), np.sort(field.vertices[:, 0]), atol=1e-5
    )
    field.export(tmp_path / "mesh.npz", None)
    with np.load(tmp_path / "mesh.npz") as arrays:
        assert {"vertices", "colors", "faces", "box"} == set(arrays.files)
        assert np.array_equal(arrays["faces"], field.faces)


def of(vertices: Any, faces: Any) -> MeshSurface:
    return MeshSurface.of_mesh(vertices, np.asarray(faces))


def test_an_open_mesh_is_drawn_and_what_is_no_manifold_is_refused() -> None:
    assert of(SQUARE, FACES).shape == (5, 2)
    crowded = [*FACES.tolist(), [2, 0, 4]]
    with pytest.raises(SceneError, match=r"edges of one or two faces, got 1 with more, .* 0 and 2"):
        of(SQUARE, crowded)
    with pytest.raises(SceneError, match=r"three vertices, got 1 with one vertex twice, .* face 1"):
        MeshSurface(SQUARE, SQUARE, np.array([[0, 1, 2], [3, 3, 4]]))
    line = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    with pytest.raises(SceneError, match="triangles with area, got 1 without, the first face 0"):
        of(line, [[0, 1, 2]])
    with pytest.raises(RangeError, match=r"vertices: .*finite"):
        of(np.where(SQUARE == 0.5, np.nan, SQUARE), FACES)
    with pytest.raises(RangeError, match="faces"):
        of(SQUARE, [[0, 1, 5]])
    with pytest.raises(ShapeError, match="color_logits"):
        MeshSurface(SQUARE, SQUARE[:3], FACES)
    with pytest.raises(DtypeError, match="differential"):
        MeshSurface(np.zeros((4, 3), int), np.zeros((4, 3)), FACES)

"""Equal triangles on the same surface: angles, distance, the same bits again, bad input."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from photograd.errors import IoError, RangeError, ShapeError
from photograd.geometry import nearest_on_mesh
from photograd.geometry.icosphere import icosphere
from photograd.geometry.mesh import Mesh
from photograd.geometry.remesh import remesh, surface_area
from photograd.raster import MeshEdges

from support.missing import need_installed

BALL = icosphere(8)
STRETCHED = BALL.vertices.astype(np.float64) * np.array([1.0, 0.25, 0.6])


def smallest_angles(vertices: Any, faces: Any) -> Any:
    corners, found = vertices[faces], []
    for k in range(3):
        a, b = (corners[:, (k + j) % 3] - corners[:, k] for j in (1, 2))
        lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
        found.append(np.degrees(np.arccos(np.clip((a * b).sum(axis=1) / lengths, -1, 1))))
    return np.min(found, axis=0)


def test_triangles_become_equal_and_the_surface_stays() -> None:
    need_installed("gpytoolbox")
    vertices, faces = remesh(STRETCHED, BALL.faces, 0.12)
    edges = MeshEdges.of(faces)
    assert (edges.borders, edges.crowded) == (0, 0)
    assert len(vertices) - len(edges.ends) + len(faces) == 2
    before, after = (smallest_angles(*m) for m in ((STRETCHED, BALL.faces), (vertices, faces)))
    assert before.min() < 20
    assert after.min() > 25
    distance, _ = nearest_on_mesh(vertices, Mesh(STRETCHED, BALL.faces))
    assert distance.max() < 0.01
    a, b = (vertices[edges.ends[:, k]] for k in range(2))
    lengths = np.sqrt(np.square(a - b).sum(axis=1))
    assert 0.09 < lengths.mean() < 0.15
    again = remesh(STRETCHED, BALL.faces, 0.12)
    assert np.array_equal(again[0], vertices)
    assert np.array_equal(again[1], faces)


def test_an_area_in_closed_form() -> None:
    square = np.array([[0.0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]])
    assert surface_area(square, np.array([[0, 1, 2], [0, 2, 3]])) == 6


def test_bad_input_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gpytoolbox", None)
    with pytest.raises(IoError, match=r"pip install 'photograd\[remesh\]'"):
        remesh(STRETCHED, BALL.faces, 0.1)
    with pytest.raises(RangeError, match=r"length: .*at most 2,000,000 triangles"):
        remesh(STRETCHED, BALL.faces, 1e-5)
    with pytest.raises(RangeError, match="length"):
        remesh(STRETCHED, BALL.faces, 0.0)
    with pytest.raises(RangeError, match="faces"):
        remesh(STRETCHED[:5], BALL.faces, 0.1)
    with pytest.raises(ShapeError, match="vertices"):
        remesh(STRETCHED[:, :2], BALL.faces, 0.1)

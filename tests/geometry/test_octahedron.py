"""A sphere that fills a texture: closed, without a fold, its seams where the square ends."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError
from photograd.geometry.octahedron import unwrapped_sphere
from photograd.raster import MeshEdges


@pytest.mark.parametrize("n", [2, 3, 8])
def test_it_is_closed_and_turned_outward(n: int) -> None:
    vertices, uv, corners, vertex = unwrapped_sphere(n)
    faces = vertex[corners]
    edges = MeshEdges.of(faces)
    assert faces.shape == (8 * n * n, 3)
    assert (edges.borders, edges.crowded) == (0, 0)
    assert len(vertices) - len(edges.ends) + len(faces) == 2  # Euler's number of a sphere
    np.testing.assert_allclose(np.square(vertices).sum(axis=1), 1.0, rtol=1e-12)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    assert ((np.cross(b - a, c - a) * (a + b + c)).sum(axis=1) > 0).all()
    assert uv.shape == ((2 * n + 1) ** 2, 2)


def test_the_faces_cover_the_texture_once() -> None:
    _, uv, corners, _ = unwrapped_sphere(4)
    a, b, c = (uv[corners[:, k]] for k in range(3))
    (x1, y1), (x2, y2) = (b - a).T, (c - a).T
    area = (x1 * y2 - y1 * x2) / 2
    assert (area > 0).all() or (area < 0).all()  # no fold
    np.testing.assert_allclose(abs(area).sum(), 1.0, rtol=1e-12)
    assert (uv.min(), uv.max()) == (0, 1)


def test_bad_numbers_are_named() -> None:
    with pytest.raises(RangeError, match="divisions"):
        unwrapped_sphere(1)
    with pytest.raises(DtypeError, match="divisions"):
        unwrapped_sphere(2.5)  # type: ignore[arg-type]

"""Places of a mesh in a texture: every face once, apart from each other, the same bits again."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.geometry.icosphere import icosphere
from photograd.geometry.unwrap import unwrap
from photograd.raster import rasterize

from support.missing import need_module

SPHERE = icosphere(4)


@pytest.fixture(autouse=True)
def _library() -> None:
    need_module("xatlas")


def area(uv: Any, corners: Any) -> Any:
    a, b, c = (uv[corners[:, k]] for k in range(3))
    (x1, y1), (x2, y2) = (b - a).T, (c - a).T
    return np.abs(x1 * y2 - y1 * x2) / 2


@pytest.mark.parametrize("shift", [0.0, 1e5])
def test_faces_keep_their_vertices_and_lie_beside_each_other(shift: float) -> None:
    uv, corners, vertex = unwrap(SPHERE.vertices.astype(np.float64) + shift, SPHERE.faces, 256)
    assert np.array_equal(vertex[corners], SPHERE.faces)
    assert uv.min() >= 0
    assert uv.max() <= 1
    assert len(uv) > len(SPHERE.vertices)  # seams
    covered = area(uv, corners)
    assert covered.min() > 0
    assert 0.4 < covered.sum() < 1
    # Where two faces lay over each other, one would hide the other.
    flat = np.concatenate([512 * uv, np.ones((len(uv), 1))], axis=1)
    seen = rasterize(flat, corners, (512, 512))
    assert seen.overdraw.max() == 1
    assert abs(seen.covered.mean() - covered.sum()) < 0.01


def test_the_same_mesh_is_cut_alike_again() -> None:
    first, again = (unwrap(SPHERE.vertices, SPHERE.faces, 128) for _ in range(2))
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))


def test_bad_input_is_named() -> None:
    with pytest.raises(RangeError, match="unwrap: faces"):
        unwrap(SPHERE.vertices[:5], SPHERE.faces, 64)
    with pytest.raises(ShapeError, match="unwrap: vertices"):
        unwrap(SPHERE.vertices[:, :2], SPHERE.faces, 64)
    with pytest.raises(RangeError, match=r"unwrap: vertices: .*finite"):
        unwrap(np.full((162, 3), np.nan), SPHERE.faces, 64)
    with pytest.raises(RangeError, match="unwrap: size"):
        unwrap(SPHERE.vertices, SPHERE.faces, 2)

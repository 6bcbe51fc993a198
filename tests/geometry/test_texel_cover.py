"""Which point of a mesh each texel shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import RangeError

Array = Any


def by_hand(uv: Array, faces: Array, height: int, width: int) -> tuple[Array, Array]:
    """The definition, texel by texel: the first face none of whose three weights is negative."""
    face, weights = np.full((height, width), -1), np.zeros((height, width, 2))
    for i, j in np.ndindex(height, width):
        q = np.array([(j + 0.5) / width, (i + 0.5) / height])
        for number, corners in enumerate(uv[faces].astype(np.float64)):
            edges = (corners[1:] - corners[0]).T
            if np.linalg.det(edges) == 0:
                continue
            s, t = np.linalg.solve(edges, q - corners[0])
            if min(s, t, 1 - s - t) >= -1e-9:
                face[i, j], weights[i, j] = number, (s, t)
                break
    return face, weights


def test_triangles_of_any_shape_cover_what_they_should() -> None:
    g = np.random.default_rng(1)
    uv = g.uniform(0, 1, (24, 2)).astype(np.float32)
    faces = np.concatenate([np.arange(24).reshape(8, 3), [[0, 0, 1]]]).astype(np.uint32)
    face, weights, contested = _core.cover_texels(uv, faces, 19, 23)
    expected, at = by_hand(uv, faces, 19, 23)
    assert 50 < (expected >= 0).sum() < 19 * 23 - 50
    np.testing.assert_array_equal(face, expected)
    np.testing.assert_allclose(weights, at, atol=1e-12)
    assert contested > 20  # they lie on one another


def test_triangles_that_share_edges_leave_no_gap_and_do_not_overlap() -> None:
    # Centers of texels lie exactly on edges of this fan, and on its diagonals.
    n = 8
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    uv = np.stack([x, y], axis=-1).reshape(-1, 2).astype(np.float32)
    corner = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    halves = [np.stack(half, -1).reshape(-1, 3) for half in ((a, b, c), (a, c, d))]
    faces = np.concatenate(halves).astype(np.uint32)
    for size in (4, 7, 20, 32):
        face, weights, contested = _core.cover_texels(uv, faces, size, size)
        assert (face >= 0).all()
        assert contested == 0
        corners = uv[faces[face]]
        s, t = np.moveaxis(weights, -1, 0)[..., None]
        found = (1 - s - t) * corners[:, :, 0] + s * corners[:, :, 1] + t * corners[:, :, 2]
        center = (np.arange(size) + 0.5) / size
        np.testing.assert_allclose(found[..., 0], np.tile(center, (size, 1)), atol=1e-7)
        np.testing.assert_allclose(found[..., 1], np.tile(center, (size, 1)).T, atol=1e-7)


def test_what_lies_beyond_the_texture_is_cut_off() -> None:
    uv = np.array([[-1, -1], [3, -1], [-1, 3]], np.float32)
    face, _, _ = _core.cover_texels(uv, np.array([[0, 1, 2]], np.uint32), 3, 5)
    assert (face == 0).all()
    face, _, _ = _core.cover_texels(uv + 4, np.array([[0, 1, 2]], np.uint32), 3, 5)
    assert (face == -1).all()


def test_wrong_arguments_are_refused() -> None:
    uv, faces = np.zeros((3, 2), np.float32), np.array([[0, 1, 3]], np.uint32)
    with pytest.raises(RangeError, match="numbers below 3, got 3"):
        _core.cover_texels(uv, faces, 2, 2)
    with pytest.raises(RangeError, match="shape"):
        _core.cover_texels(uv, faces % 3, 0, 2)

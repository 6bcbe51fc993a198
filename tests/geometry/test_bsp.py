"""Polygons of a binary space partition are in order from every eye."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, SceneError, ShapeError
from photograd.geometry import BspTree
from photograd.geometry.mesh import Mesh
from photograd.scenes.shapes import ico_sphere
from photograd_course.random import uniform

from .shapes import Array

VIEWS = 10_000


def circle_of_bars() -> Array:
    """Three triangles (3, 3, 3), each over the next: no order of whole triangles is right."""
    turn = 2 * np.pi / 3 * np.arange(3)
    corners = []
    for angle in turn:
        c, s = np.cos(angle), np.sin(angle)
        bar = np.array([[-1.0, 0.5, -0.3], [1.2, 0.8, 0.3], [1.2, 0.1, 0.3]])
        corners.append(bar @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]).T)
    return np.array(corners)


def tangle(count: int = 36) -> Array:
    """Triangles (N, 3, 3) that pierce each other."""
    u = uniform(8, pixel=np.arange(count)[:, None, None], dimension=np.arange(9).reshape(3, 3))
    return 2.0 * u - 1.0


def mesh_of(corners: Array) -> Mesh:
    return Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def fans(polygons: list[Array]) -> tuple[Array, Array]:
    """Triangles (T, 3, 3) of convex polygons, and the polygon of each."""
    parts = [
        np.stack([np.broadcast_to(p[0], p[2:].shape), p[1:-1], p[2:]], axis=1) for p in polygons
    ]
    owner = np.repeat(np.arange(len(polygons)), [len(part) for part in parts])
    return np.concatenate(parts), owner


def hits(corners: Array, eyes: Array, ways: Array) -> Array:
    """t (E, T) of each eye's ray with each triangle, infinite without a hit; edges belong to it."""
    a, b, c = corners.swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = ((a * normal).sum(1) - eyes @ normal.T) / (ways @ normal.T)
        inside = t > 1e-9
        for p, q in ((a, b), (b, c), (c, a)):
            inward = np.cross(normal, q - p)
            height = eyes @ inward.T + t * (ways @ inward.T) - (p * inward).sum(1)
            inside &= height > 1e-9 * np.linalg.norm(inward, axis=1)
    return np.where(inside, t, np.inf)


def views(seed: int) -> tuple[Array, Array]:
    """Eyes (E, 3) in and around the unit cube, and directions to points in it."""
    u = uniform(seed, pixel=np.arange(VIEWS)[:, None], dimension=np.arange(6))
    eyes = 6.0 * u[:, :3] - 3.0
    return eyes, 1.6 * (u[:, 3:] - 0.5) - eyes


def disorder(
    corners: Array, owner: Array, rank: Array, eyes: Array, ways: Array
) -> tuple[int, int]:
    """Along each ray: pairs of neighbors that were met, and those painted in the wrong order.

    rank (E, P) is when a polygon is painted; owner (T,) says to which a triangle belongs.
    """
    pairs = wrong = 0
    for start in range(0, len(eyes), 500):
        part = slice(start, start + 500)
        t = hits(corners, eyes[part], ways[part])
        order = np.argsort(-t, axis=1)  # infinite ones first, then far to near
        far_to_near = np.take_along_axis(t, order, axis=1)
        painted = np.take_along_axis(rank[part], owner[order], axis=1)
        met = np.isfinite(far_to_near[:, :-1]) & np.isfinite(far_to_near[:, 1:])
        met &= far_to_near[:, :-1] > far_to_near[:, 1:] + 1e-6
        pairs += int(met.sum())
        wrong += int((met & (painted[:, :-1] >= painted[:, 1:])).sum())
    return pairs, wrong


def rank_of(order: Array) -> Array:
    rank = np.empty(order.shape, np.int64)
    np.put_along_axis(rank, order.astype(np.int64), np.arange(order.shape[1])[None], axis=1)
    return rank


@pytest.mark.parametrize("make", [circle_of_bars, tangle])
def test_back_to_front_from_ten_thousand_views(make: Any) -> None:
    whole = make()
    tree = BspTree(mesh_of(whole))
    corners, owner = fans(tree.polygons())
    eyes, ways = views(1)
    order = tree.back_to_front(eyes)
    np.testing.assert_array_equal(
        np.sort(order, axis=1), np.arange(len(tree.face))[None] + 0 * order
    )
    rank = rank_of(order)
    pairs, wrong = disorder(corners, owner, rank, eyes, ways)
    assert pairs > 100
    assert wrong == 0
    # The check sees a wrong order: front to back is always wrong, and whole triangles sorted by the
    # distance of their middles are wrong often enough to be noticed.
    few = disorder(corners, owner, -rank[:2500], eyes[:2500], ways[:2500])
    assert few[1] == few[0] > 20
    distance = np.linalg.norm(whole.mean(axis=1)[None] - eyes[:, None], axis=2)
    by_middle = rank_of(np.argsort(-distance, axis=1))
    pairs, wrong = disorder(whole, np.arange(len(whole)), by_middle, eyes, ways)
    assert wrong > 0.02 * pairs


def polygon_areas(polygons: list[Array]) -> Array:
    return np.array(
        [0.5 * np.linalg.norm(np.cross(p[1:-1] - p[0], p[2:] - p[0]).sum(axis=0)) for p in polygons]
    )


def test_pieces_make_up_their_triangles() -> None:
    whole = tangle().astype(np.float32).astype(np.float64)
    tree = BspTree(mesh_of(whole))
    polygons = tree.polygons()
    assert len(polygons) > 3 * len(whole)
    area = np.bincount(tree.face, polygon_areas(polygons))
    np.testing.assert_allclose(area, polygon_areas(list(whole)), rtol=1e-12)
    normals = np.cross(whole[:, 1] - whole[:, 0], whole[:, 2] - whole[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    for polygon, face in zip(polygons, tree.face, strict=True):
        assert np.abs((polygon - whole[face, 0]) @ normals[face]).max() < 1e-12
    # Every polygon belongs to one node, and lies in its plane.
    assert tree.count.sum() == len(polygons)
    for node in range(len(tree.planes)):
        here = np.concatenate(polygons[tree.first[node] : tree.first[node] + tree.count[node]])
        assert np.abs(here @ tree.planes[node, :3] - tree.planes[node, 3]).max() < 1e-9


def test_a_convex_body_is_never_cut_and_may_be_a_chain() -> None:
    ball = ico_sphere(1.0, subdivisions=3)
    tree = BspTree(Mesh(ball.vertices, ball.faces))
    assert len(tree.face) == len(ball.faces) == 1280
    assert tree.depth.max() > 600
    order = tree.back_to_front([[0.0, 0.0, 5.0]])[0]
    a, b, c = ball.vertices.astype("f4").astype("f8")[ball.faces[tree.face[order]]].swapaxes(0, 1)
    facing = (np.cross(b - a, c - a) * ([0, 0, 5.0] - a)).sum(axis=1) > 0
    # Of a convex body, what faces away is painted before what faces the eye.
    assert not np.diff(facing.astype(int)).min() < 0


def test_more_candidates_cut_less() -> None:
    cuts = [len(BspTree(mesh_of(tangle()), candidates=n).face) for n in (1, 32)]
    assert cuts[1] < 0.9 * cuts[0]


def test_bad_arguments_are_named() -> None:
    mesh = mesh_of(tangle())
    with pytest.raises(RangeError, match=r"max_polygons: expected .* at most 50 polygons"):
        BspTree(mesh, max_polygons=50)
    with pytest.raises(RangeError, match="candidates: expected at least 1, got 0"):
        BspTree(mesh, candidates=0)
    with pytest.raises(SceneError, match="at least one triangle"):
        BspTree(Mesh(mesh.vertices, mesh.faces[:0]))
    broken = mesh.vertices.copy()
    broken[4] = np.nan
    with pytest.raises(SceneError, match="vertex 4"):
        BspTree(Mesh(broken, mesh.faces))
    with pytest.raises(ShapeError, match="eyes"):
        BspTree(mesh).back_to_front([0.0, 0.0, 0.0])
    with pytest.raises(RangeError, match=r"eyes.*row 0"):
        BspTree(mesh).back_to_front([[0.0, np.inf, 0.0]])

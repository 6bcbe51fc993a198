"""The hierarchy that is there to be read: its answers, its shape, and what it spares."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, RangeError, SceneError, ShapeError
from photograd.geometry import BvhHits, ReferenceBvh
from photograd.geometry.mesh import Bvh, Mesh
from photograd_course.random import uniform

from support.bits import same_bits

from .shapes import Array, brute_force, bumpy_sphere, camera_rays, random_rays

BUMPY = Mesh(*bumpy_sphere())


def soup(count: int = 400) -> Mesh:
    """Triangles of all sizes, in all directions, through each other."""
    u = uniform(3, pixel=np.arange(count)[:, None], dimension=np.arange(12)) - 0.5
    size = 10.0 ** (-0.7 - 1.6 * u[:, 9:10])
    corners = [2.0 * u[:, :3] + size * u[:, 3 * k : 3 * k + 3] for k in range(3)]
    return Mesh(np.stack(corners, axis=1).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def tiles(side: int = 8) -> Mesh:
    """A flat floor of squares, whose boxes have no height."""
    x, z = np.meshgrid(np.arange(side + 1.0), np.arange(side + 1.0), indexing="ij")
    vertices = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3) / side * 2 - [1, 0, 1]
    corner = np.arange((side + 1) ** 2).reshape(side + 1, -1)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, d, c), (a, c, b))])
    return Mesh(vertices, faces)


MESHES = {"bumpy": BUMPY, "soup": soup(), "tiles": tiles()}


def assert_same_hits(found: BvhHits, expected: BvhHits) -> None:
    for name in ("primitive", "t", "barycentrics"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("options", [{}, {"leaf_size": 1, "bins": 3}, {"max_depth": 3}])
def test_hits_are_those_of_every_triangle_to_the_bit(name: str, options: dict[str, int]) -> None:
    bvh = ReferenceBvh(MESHES[name], **options)
    origins, directions = random_rays(3000, seed=1)
    every = bvh.trace_all(origins, directions)
    assert 0.05 < every.hit.mean() < 0.95
    assert_same_hits(bvh.trace(origins, directions), every)
    assert_same_hits(
        bvh.trace(origins, 3.0 * directions, 0.05, 0.3),
        bvh.trace_all(origins, 3.0 * directions, 0.05, 0.3),
    )
    # Rays along an axis run in the planes of boxes; here also through corners of tiles.
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 9)] * 2, indexing="ij"), -1).reshape(-1, 2)
    start = np.column_stack([grid[:, 0], np.ones(81), grid[:, 1]])
    for way in ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 1.0]):
        along = np.broadcast_to(way, start.shape)
        assert_same_hits(bvh.trace(start, along), bvh.trace_all(start, along))


def test_a_search_in_numpy_agrees() -> None:
    corners = BUMPY.vertices.astype(np.float64)[BUMPY.faces]
    origins, directions = random_rays(300, seed=2)
    t, face = brute_force(corners, origins, directions)
    found = ReferenceBvh(BUMPY).trace(origins, directions)
    np.testing.assert_array_equal(found.primitive, face)
    np.testing.assert_allclose(found.t, t, rtol=1e-12)


def test_embree_names_the_same_triangles() -> None:
    origins, directions = random_rays(200_000, seed=3)
    origins, directions = (a.astype("f4").astype("f8") for a in (origins, directions))
    found = ReferenceBvh(BUMPY).trace(origins, directions)
    fast = Bvh(BUMPY).trace(origins, directions)
    # A leaf that is never entered would be seen: every triangle is somebody's nearest.
    assert len(np.unique(found.primitive)) == len(BUMPY.faces) + 1
    same = found.primitive == fast.primitive
    # Embree decides in float: rays within 1e-7 of an edge, about 1 in 100,000, may differ.
    assert (~same).sum() <= 10
    np.testing.assert_allclose(found.t[same], fast.t[same], rtol=1e-12)
    any_hit = ReferenceBvh(BUMPY).any_hit(origins, directions, 0.0, 0.8).hit
    np.testing.assert_array_equal(any_hit, found.t <= 0.8)
    assert (any_hit != Bvh(BUMPY).occluded(origins, directions, 0.0, 0.8)).sum() <= 10
    assert 0.1 < any_hit.mean() < 0.9


def test_any_hit_costs_less_than_the_nearest() -> None:
    bvh = ReferenceBvh(BUMPY)
    origins, directions = random_rays(20_000, seed=4)
    nearest, any_hit = bvh.trace(origins, directions), bvh.any_hit(origins, directions)
    np.testing.assert_array_equal(any_hit.hit, nearest.hit)
    assert (any_hit.t >= nearest.t).all()
    assert (any_hit.boxes <= nearest.boxes).all()
    assert any_hit.triangles.sum() < 0.9 * nearest.triangles.sum()


def test_the_shape_of_the_tree() -> None:
    for mesh in MESHES.values():
        bvh = ReferenceBvh(mesh, leaf_size=3)
        leaf = bvh.count > 0
        np.testing.assert_array_equal(np.sort(bvh.order), np.arange(len(mesh.faces)))
        assert bvh.count.max() <= 3
        assert bvh.count.sum() == len(mesh.faces)
        inner = np.flatnonzero(~leaf)
        for child in (inner + 1, bvh.right[inner]):
            assert (bvh.depth[child] == bvh.depth[inner] + 1).all()
            assert (bvh.boxes[child, 0] >= bvh.boxes[inner, 0]).all()
            assert (bvh.boxes[child, 1] <= bvh.boxes[inner, 1]).all()
        corners = mesh.vertices.astype(np.float64)[mesh.faces]
        for node in np.flatnonzero(leaf):
            faces = bvh.order[bvh.first[node] : bvh.first[node] + bvh.count[node]]
            inside = corners[faces].reshape(-1, 3)
            np.testing.assert_array_equal(bvh.boxes[node], [inside.min(0), inside.max(0)])


def test_what_the_hierarchy_spares() -> None:
    tests = []
    for rings, columns in ((12, 20), (24, 40), (48, 80)):
        bvh = ReferenceBvh(Mesh(*bumpy_sphere(rings, columns)))
        origins, directions = random_rays(4000, seed=5)
        found = bvh.trace(origins, directions)
        tests.append(float((found.boxes + found.triangles).mean()))
    # Four times as many triangles cost about two levels more: 12.7, 15.3 and 17.9 tests a ray.
    assert tests[-1] < 0.01 * 2 * 48 * 80
    assert tests[2] - tests[1] < 1.5 * (tests[1] - tests[0]) < 12
    # The heuristic prefers the tree with many candidates, and so do rays.
    fine, coarse = (ReferenceBvh(MESHES["soup"], leaf_size=2, bins=b) for b in (32, 2))
    origins, directions = random_rays(10_000, seed=6)
    work = [b.trace(origins, directions) for b in (fine, coarse)]
    assert fine.cost() < coarse.cost()
    assert (work[0].boxes + work[0].triangles).sum() < (work[1].boxes + work[1].triangles).sum()


@same_bits("reference BVH")
def hits_of_the_reference() -> list[Any]:
    return list(vars(ReferenceBvh(BUMPY).trace(*random_rays(5000, seed=7))).values())


def with_row(array: Array, row: int, value: Any) -> Array:
    changed = np.array(array)
    changed[row] = value
    return changed


V, F = BUMPY.vertices, BUMPY.faces
BAD_MESHES = {
    "nan": (Mesh(with_row(V, 7, np.nan), F), "nan in vertex 7"),
    "flat": (Mesh(V, with_row(F, 5, [3, 3, 4])), "1 without, the first is triangle 5"),
    "empty": (Mesh(V, F[:0]), "at least one triangle"),
    "far": (Mesh(V, with_row(F, 4, [0, 9999, 1])), "9999 in triangle 4"),
}


@pytest.mark.parametrize("case", BAD_MESHES)
def test_bad_meshes_are_named(case: str) -> None:
    mesh, words = BAD_MESHES[case]
    with pytest.raises(SceneError, match=words):
        ReferenceBvh(mesh)


BAD_CALLS: list[tuple[type[Error], str, dict[str, Any]]] = [
    (RangeError, "max_depth: expected 0 to 64, got 65", {"max_depth": 65}),
    (RangeError, "leaf_size: expected 1", {"leaf_size": 0}),
    (RangeError, "bins: expected 2 to 256, got 1", {"bins": 1}),
    (ShapeError, "origins: expected shape", {"origins": np.zeros(3)}),
    (ShapeError, "directions: expected shape", {"directions": np.ones((4, 3))}),
    (RangeError, "nan.*in row 1", {"origins": with_row(np.zeros((2, 3)), 1, np.nan)}),
    (RangeError, "some length, got none in row 1", {"directions": np.eye(2, 3) * [1, 0, 0]}),
    (RangeError, r"^ReferenceBvh\.\w+: t_min", {"t_min": np.nan}),
]


@pytest.mark.parametrize("case", range(len(BAD_CALLS)))
def test_bad_arguments_are_named(case: int) -> None:
    error, words, changes = BAD_CALLS[case]
    rays = {"origins": np.zeros((2, 3)), "directions": np.eye(2, 3)}
    options = {k: v for k, v in changes.items() if k in {"max_depth", "leaf_size", "bins"}}
    with pytest.raises(error) as caught:
        ReferenceBvh(BUMPY, **options).trace(
            **(rays | {k: v for k, v in changes.items() if k not in options})
        )
    assert re.search(words, str(caught.value)), str(caught.value)


def test_coinciding_triangles_share_a_leaf_and_no_rays_are_no_hits() -> None:
    same = Mesh(V, np.repeat(F[:1], 50, axis=0))
    bvh = ReferenceBvh(same, leaf_size=1)
    assert bvh.count.tolist() == [50]
    middle = V[F[0]].astype(np.float64).mean(axis=0)
    assert bvh.trace([3.0 * middle], [-middle]).primitive.tolist() == [0]
    assert bvh.trace(np.zeros((0, 3)), np.zeros((0, 3))).t.shape == (0,)
    origins, directions = camera_rays(4)
    assert ReferenceBvh(BUMPY).trace(origins, directions).hit.any()

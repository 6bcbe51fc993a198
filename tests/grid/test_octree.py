"""Trees answer like the dense array, and rays visit what a test of every leaf finds."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from photograd.grids.octree import Octree, Quadtree
from photograd_course.random import uniform

from support.bits import same_bits

Array = npt.NDArray[Any]
SHAPE = (30, 32, 27)
BOUNDS = np.array([[-1.0, 2.0, 0.0], [0.5, 4.0, 2.7]])


def ball(dtype: npt.DTypeLike = np.float64) -> Array:
    """sigma_a and sigma_s (X, Y, Z, 2) of a ball whose scattering varies."""
    axes = [(np.arange(n) + 0.5) / n - 0.5 for n in SHAPE]
    x, y, z = np.meshgrid(*axes, indexing="ij")
    inside = x**2 + y**2 + z**2 < 0.35**2
    return np.stack([2.0 * inside, (3.0 + x * y) * inside], -1).astype(dtype)


def random_points(count: int, seed: int, dimensions: int = 3) -> Array:
    """(N, D) in a box somewhat larger than BOUNDS."""
    u = uniform(seed, pixel=np.arange(count)[:, None], dimension=np.arange(dimensions))
    lo, hi = BOUNDS[0, :dimensions] - 0.1, BOUNDS[1, :dimensions] + 0.1
    return lo + u * (hi - lo)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_points_equal_the_dense_array(dtype: npt.DTypeLike) -> None:
    dense = ball(dtype)
    tree = Octree.from_dense(dense, BOUNDS)
    assert len(tree.values) < dense[..., 0].size / 3
    points = random_points(1_000_000, seed=1)
    leaf = tree.leaf_at(points)
    cell = np.floor((points - BOUNDS[0]) / tree.cell_size).astype(np.int64)
    inside = ((cell >= 0) & (cell < SHAPE)).all(axis=1)
    assert 0.2 < inside.mean() < 0.95
    expected = np.zeros((len(points), 2), dtype)
    expected[inside] = dense[tuple(cell[inside].T)]
    # Beyond the array: background leaves in the root's cube, and no leaf outside of that.
    got = np.where((leaf >= 0)[:, None], tree.values[leaf], 0.0)
    np.testing.assert_array_equal(got, expected)
    assert (leaf[inside] >= 0).all()


def test_occupancy_and_radiance() -> None:
    full = ball()[..., :1] > 0
    tree = Octree.from_dense(full)
    assert tree.values.dtype == np.bool_
    np.testing.assert_array_equal(tree.expand(), full)
    rgb = np.repeat(full, 3, axis=-1) * np.array([0.1, 0.7, 0.3], np.float32)
    colored = Octree.from_dense(rgb.astype(np.float32), background=(0.0, 0.0, 0.0))
    np.testing.assert_array_equal(colored.expand(), rgb.astype(np.float32))
    # One surface, so the same cells are cut, whatever they hold.
    assert colored.statistics().leaves_per_level == tree.statistics().leaves_per_level


def test_leaves_are_as_many_as_aligned_cubes() -> None:
    """A cube is a leaf if it is uniform and the one around it is not."""
    for tolerance in (0.0, 0.02):
        tree = Octree.from_dense(ball(), tolerance=tolerance)
        low = high = np.pad(ball(), [(0, 32 - n) for n in SHAPE] + [(0, 0)])
        uniform_cubes = []
        for _ in range(6):
            uniform_cubes.append((high - low <= tolerance).all(axis=-1))
            n = len(low) // 2
            low = low.reshape(n, 2, n, 2, n, 2, 2).min((1, 3, 5)) if n else low
            high = high.reshape(n, 2, n, 2, n, 2, 2).max((1, 3, 5)) if n else high
        counts = [
            int((level & ~np.kron(up, np.ones((2, 2, 2), np.bool_))).sum())
            for level, up in pairwise(uniform_cubes)
        ]
        counts.append(int(uniform_cubes[-1].sum()))
        assert tree.statistics().leaves_per_level == tuple(counts[::-1])


def test_statistics_count_what_is_there() -> None:
    tree = Octree.from_dense(ball(np.float32), BOUNDS)
    s = tree.statistics()
    lower, side = tree.leaf_boxes()
    assert s.leaves == len(tree.values) == len(lower)
    per_level = np.bincount(tree.depth - np.log2(side).astype(int), minlength=tree.depth + 1)
    assert s.leaves_per_level == tuple(per_level)
    assert (side.astype(np.int64) ** 3).sum() == (2**tree.depth) ** 3
    assert s.nodes == 1 + 8 * (s.nodes - s.leaves)
    assert s.bytes == 4 * s.nodes + 8 * s.leaves


def test_the_tolerance_bounds_every_cell_and_keeps_the_sum() -> None:
    dense = ball()
    exact, coarse = Octree.from_dense(dense), Octree.from_dense(dense, tolerance=0.03)
    assert len(coarse.values) < 0.8 * len(exact.values)
    error = np.abs(coarse.expand() - dense)
    assert 0.005 < error.max() <= 0.03
    # Means of up to 2^9 numbers in double: rounding only.
    np.testing.assert_allclose(coarse.expand().sum((0, 1, 2)), dense.sum((0, 1, 2)), rtol=1e-13)


def test_expand_backward_is_the_adjoint() -> None:
    tree = Octree.from_dense(ball())
    v = uniform(2, pixel=np.arange(len(tree.values))[:, None], dimension=np.arange(2)) - 0.5
    w = uniform(3, pixel=np.arange(np.prod(SHAPE))[:, None], dimension=np.arange(2)) - 0.5
    w = w.reshape(*SHAPE, 2)
    d_values = tree.expand_backward(w)
    assert np.abs(d_values).min() > 0.0
    forward = float((tree.expand(v) * w).sum())
    assert abs(forward) > 1.0
    # <Jv, w> = <v, J^T w>; 5e4 products of at most 1/4, so rounding stays far below 1e-10.
    assert abs(float((v * d_values).sum()) - forward) < 1e-10


def brute_force(tree: Octree, o: Array, d: Array, t_min: float, t_max: float) -> Array:
    """Leaves by the interval of each of them, sorted along the ray."""
    lower, side = tree.leaf_boxes()
    lo = BOUNDS[0] + lower * tree.cell_size
    hi = lo + side[:, None] * tree.cell_size
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (lo - o) / d, (hi - o) / d
    along = d == 0.0
    held = (lo <= o) & (o < hi)
    near = np.where(along, np.where(held, -np.inf, np.inf), np.minimum(a, b)).max(axis=1)
    far = np.where(along, np.where(held, np.inf, -np.inf), np.maximum(a, b)).min(axis=1)
    near, far = np.maximum(near, t_min), np.minimum(far, t_max)
    met = np.flatnonzero(far - near > 1e-12)
    return met[np.argsort(near[met])]


@pytest.mark.parametrize("kind", ["anywhere", "axis", "plane", "cut"])
def test_rays_visit_the_leaves_of_an_interval_test(kind: str) -> None:
    tree = Octree.from_dense(ball(), BOUNDS)
    count = 300
    o = random_points(count, seed=5)
    d = uniform(6, pixel=np.arange(count)[:, None], dimension=np.arange(3)) - 0.5
    if kind == "axis":
        d[np.arange(3) != (np.arange(count) % 3)[:, None]] = 0.0
    if kind == "plane":
        d[np.arange(count), np.arange(count) % 3] = -0.0
    t_min, t_max = (0.3, 1.7) if kind == "cut" else (-np.inf, np.inf)
    visits = tree.traverse(o, d, t_min=t_min, t_max=t_max)
    assert len(visits.leaf) > 2 * count
    for r in range(count):
        rows = slice(*visits.ray_offset[r : r + 2])
        expected = brute_force(tree, o[r], d[r], t_min, t_max)
        # Leaves that a ray meets for less than 1e-12 are left out on both sides: world coordinates
        # are rounded differently here. The C++ test, in cells, asks for the same bits.
        long = visits.t1[rows] - visits.t0[rows] > 1e-12
        np.testing.assert_array_equal(visits.leaf[rows][long], expected)
        np.testing.assert_array_equal(visits.t1[rows][:-1], visits.t0[rows][1:])


def test_a_function_gives_the_tree_of_its_samples() -> None:
    def inside(x: float, y: float) -> bool:
        return x * x + 2 * y * y < 500.0

    def classify(lower: tuple[int, ...], side: int) -> list[float] | None:
        corners = [
            inside(lower[0] + a, lower[1] + b) for a in (0.5, side - 0.5) for b in (0.5, side - 0.5)
        ]
        return [float(corners[0])] if len(set(corners)) == 1 else None

    tree = Quadtree.from_function(classify, 5)
    grid = np.array([[[float(inside(x + 0.5, y + 0.5))] for y in range(32)] for x in range(32)])
    assert 0.2 < grid.mean() < 0.8
    np.testing.assert_array_equal(tree.expand(), grid)
    # The shape is monotone in x and y, so its corners do decide for a square.
    assert tree.statistics() == Quadtree.from_dense(grid).statistics()


@same_bits("octree traversal")
def visits() -> list[Any]:
    tree = Octree.from_dense(ball(), BOUNDS)
    o, d = random_points(30_000, seed=8), random_points(30_000, seed=9) - [0.0, 3.0, 1.3]
    found = list(vars(tree.traverse(o, d)).values())
    assert found[1].nbytes > 100_000
    return found

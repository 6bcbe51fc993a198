"""The hash table against a dictionary: rows, threads, growth, refusals."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.grids.voxel_hash import MAX_COORDINATE, MIN_COORDINATE, VoxelHash
from photograd_course.random import uniform

from support.bits import same_bits

Array = npt.NDArray[Any]


def random_voxels(count: int, seed: int, half: int = 20) -> Array:
    """(N, 3) with many repetitions, in a cube around the origin."""
    u = uniform(seed, pixel=np.arange(count)[:, None], dimension=np.arange(3))
    return np.floor(u * 2 * half).astype(np.int32) - half


def test_lists_agree_with_a_dictionary() -> None:
    table = VoxelHash()
    oracle: dict[tuple[int, ...], int] = {}
    free: list[int] = []
    for step in range(40):
        voxels = random_voxels(5000, seed=step)
        keys = [tuple(v) for v in voxels.tolist()]
        if step % 3 == 2:
            expected = [oracle.pop(key, -1) for key in keys]
            free += [row for row in expected if row >= 0]
            np.testing.assert_array_equal(table.erase(voxels), expected)
        else:
            for key in keys:
                if key not in oracle:
                    # The row freed last, or the next new one.
                    oracle[key] = free.pop() if free else len(oracle)
            np.testing.assert_array_equal(table.insert(voxels), [oracle[key] for key in keys])
        everywhere = random_voxels(3000, seed=1000 + step, half=25)
        found = [oracle.get(tuple(v), -1) for v in everywhere.tolist()]
        assert -1 in found
        np.testing.assert_array_equal(table.find(everywhere), found)
    voxels, rows = table.items()
    assert {tuple(v): r for v, r in zip(voxels.tolist(), rows.tolist(), strict=True)} == oracle
    assert len(table) == len(oracle)


@same_bits("voxel hash")
def rows_of_distinct_voxels() -> list[Any]:
    voxels = np.unique(random_voxels(20_000, seed=3, half=500), axis=0)[::-1]
    table = VoxelHash(voxels)
    return [table.find(voxels), *table.items()]


def test_distinct_voxels_get_the_rows_of_their_list() -> None:
    voxels = np.unique(random_voxels(20_000, seed=3, half=500), axis=0)[::-1]
    found, items, _ = rows_of_distinct_voxels()
    np.testing.assert_array_equal(found, np.arange(len(voxels)))
    np.testing.assert_array_equal(items, voxels)


def test_python_threads_share_a_table() -> None:
    table = VoxelHash()
    lists = [random_voxels(20_000, seed=s, half=30) for s in range(8)]
    with ThreadPoolExecutor(4) as pool:
        rows = list(pool.map(table.insert, lists))
    for voxels, got in zip(lists, rows, strict=True):
        np.testing.assert_array_equal(table.find(voxels), got)
    distinct = np.unique(np.concatenate(lists), axis=0)
    assert len(table) == len(distinct)
    np.testing.assert_array_equal(np.sort(table.find(distinct)), np.arange(len(distinct)))


def test_statistics_of_a_coarse_lattice() -> None:
    assert VoxelHash().statistics().load == 0.0
    axis = 256 * np.arange(-20, 20)
    voxels = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    s = VoxelHash(voxels).statistics()
    assert (s.count, s.row_limit) == (64_000, 64_000)
    assert 0.25 < s.load <= 0.5
    # Random hashes at load 1/2 need 1.5 slots on average, and fewer in shards that have just grown.
    assert 1.0 < s.mean_probe < 1.55
    assert s.longest_probe < 60


def test_the_corners_of_the_range_fit() -> None:
    corners = np.stack(
        np.meshgrid(*[[MIN_COORDINATE, MAX_COORDINATE]] * 3, indexing="ij"), -1
    ).reshape(-1, 3)
    table = VoxelHash(corners)
    assert len(table) == 8
    np.testing.assert_array_equal(table.items()[0], corners)


@pytest.mark.parametrize("method", ["insert", "find", "erase"])
@pytest.mark.parametrize(
    ("voxels", "kind", "words"),
    [
        (np.zeros((3, 3)), DtypeError, "voxels: expected integers, got float64"),
        (np.zeros((3, 2), int), ShapeError, "voxels: expected shape (N, 3), got (3, 2)"),
        (np.array([[0, 0, MAX_COORDINATE + 1]]), RangeError, "0 1048576] in row 0"),
        (
            np.array([[1, 2, 3], [0, MIN_COORDINATE - 1, 0]]),
            RangeError,
            "-1048577        0] in row 1",
        ),
        (np.array([[2**32, 0, 0]]), RangeError, "got [4294967296"),
        (np.array([[2**63, 0, 0]], np.uint64), RangeError, "9223372036854775808"),
    ],
)
def test_refused(method: str, voxels: Array, kind: type[Error], words: str) -> None:
    table = VoxelHash(np.array([[1, 2, 3]]))
    with pytest.raises(kind) as caught:
        getattr(table, method)(voxels)
    assert words in str(caught.value)
    assert len(table) == 1

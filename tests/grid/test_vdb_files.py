"""Files of sparse grids: what is written comes back; what is no such file is refused."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import IoError, RangeError
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import read_vdb, write_vdb

from grid.solids import ORIGIN, WORLD_FROM_INDEX, spotted, spotted_grid

BOX = np.array([ORIGIN, np.add(ORIGIN, (20, 17, 30))])


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scalar and a vector grid."""
    path = tmp_path_factory.mktemp("vdb") / "good.vdb"
    scalar, vector = spotted_grid(1), spotted_grid(3)
    scalar.set_metadata("author", "a student")
    vector.name = "flow"
    write_vdb(path, [scalar, vector], metadata={"scene": "spots", "frame": 7})
    return path


def test_a_round_trip_is_bit_exact(good: Path, tmp_path: Path) -> None:
    first = read_vdb(good)
    write_vdb(tmp_path / "again.vdb", first.grids, metadata=first.metadata)
    for file in (first, read_vdb(tmp_path / "again.vdb")):
        assert file.metadata == {"scene": "spots", "frame": 7}
        assert [grid.name for grid in file.grids] == ["spots", "flow"]
        assert file.grids[0].metadata["author"] == "a student"
        for channels, grid in zip((1, 3), file.grids, strict=True):
            assert np.array_equal(grid.to_dense(BOX)[0], spotted(channels))
            assert np.array_equal(grid.world_from_index, WORLD_FROM_INDEX)
            assert grid.statistics.active_voxels == spotted_grid(channels).statistics.active_voxels


def test_grids_are_found_by_name(good: Path) -> None:
    assert read_vdb(good).grid().name == "spots"
    assert read_vdb(good).grid("flow").channels == 3
    with pytest.raises(IoError, match="a grid called 'fog', got 'spots', 'flow'"):
        read_vdb(good).grid("fog")


def test_names_may_repeat(tmp_path: Path) -> None:
    grids = [spotted_grid(seed=seed) for seed in (1, 2)]
    write_vdb(tmp_path / "twice.vdb", grids)
    back = read_vdb(tmp_path / "twice.vdb").grids
    assert [grid.name for grid in back] == ["spots", "spots"]
    for seed, grid in zip((1, 2), back, strict=True):
        assert np.array_equal(grid.to_dense(BOX)[0], spotted(seed=seed))


def test_half_precision_rounds_and_is_kept(tmp_path: Path) -> None:
    write_vdb(tmp_path / "half.vdb", [spotted_grid()], half=True)
    half = read_vdb(tmp_path / "half.vdb").grid()
    rounded = spotted().astype(np.float16).astype(np.float32)
    assert np.array_equal(half.to_dense(BOX)[0], rounded)
    assert not np.array_equal(rounded, spotted())
    half.activate(np.array([ORIGIN]), np.array([[0.1]], np.float32))
    write_vdb(tmp_path / "kept.vdb", [half])
    kept, _ = read_vdb(tmp_path / "kept.vdb").grid().values_at(np.array([ORIGIN]))
    assert kept[0, 0] == np.float32(np.float16(0.1)), "stored as it was read, in half precision"
    write_vdb(tmp_path / "float.vdb", [half], half=False)
    full, _ = read_vdb(tmp_path / "float.vdb").grid().values_at(np.array([ORIGIN]))
    assert full[0, 0] == np.float32(0.1)


def test_half_precision_does_not_overflow(tmp_path: Path) -> None:
    grid = SparseGrid.from_dense(np.full((2, 2, 2), -7e4, np.float32))
    with pytest.raises(RangeError, match="values up to 65504, got 70000"):
        write_vdb(tmp_path / "no.vdb", [grid], half=True)
    assert not list(tmp_path.iterdir()), "nothing half-written stays behind"


def test_an_empty_grid_is_a_grid(tmp_path: Path) -> None:
    write_vdb(tmp_path / "empty.vdb", [SparseGrid.from_dense(np.zeros((2, 2, 2), np.float32))])
    s = read_vdb(tmp_path / "empty.vdb").grid().statistics
    assert (s.active_voxels, s.leaves, s.least, s.most) == (0, 0, 0, 0)


def test_real_files(shared_data: Path) -> None:
    fog = read_vdb(shared_data / "volumes" / "houdini_dragon_small_fog.vdb").grid("density")
    assert fog.statistics.active_voxels == 19_660
    assert np.array_equal(fog.statistics.box, [(16, 1, 35), (86, 50, 66)])
    np.testing.assert_allclose(np.diag(fog.world_from_index), [0.1, 0.1, 0.1, 1])
    smoke = read_vdb(shared_data / "volumes" / "lajolla_smoke_derived.vdb").grid()
    raw = (shared_data / "volumes" / "lajolla_smoke.vol").read_bytes()
    truth = np.frombuffer(raw, "<f4", 128 * 128 * 50, len(raw) - 4 * 128 * 128 * 50)
    values, _ = smoke.to_dense(np.array([(0, 0, 0), (128, 128, 50)]))
    assert np.array_equal(values[..., 0], truth.reshape(50, 128, 128).transpose(2, 1, 0))
    with pytest.raises(IoError, match=r"float or vec3s, got grid '.*' of type Tree_ptdataidx32"):
        read_vdb(shared_data / "volumes" / "vtk_sphere_points.vdb")


def replaced(data: bytes, old: bytes, new: bytes) -> bytes:
    assert len(old) == len(new)
    assert old in data
    return data.replace(old, new)


@pytest.mark.parametrize(
    ("damage", "text"),
    [
        (lambda data: data[:0], "an empty file"),
        (lambda data: b"PNG" + data[3:], "one that begins differently"),
        (lambda data: data[:8] + struct.pack("<I", 300) + data[12:], "222 to 224 .*got 300"),
        (lambda data: data[:40], "cut off or damaged"),
        (lambda data: data[:-4000], "cut off or damaged"),
        (lambda data: data[: len(data) // 2], "cut off or damaged"),
        (lambda data: data[:20] + b"\0" + data[21:], "one written to a stream"),
        (
            lambda data: replaced(data, b"Tree_float_5_4_3", b"Tree_int32_5_4_3"),
            "float or vec3s, got grid 'spots' of type Tree_int32",
        ),
        (
            lambda data: replaced(data, struct.pack("<d", 0.125), struct.pack("<d", 0)),
            "singular|can be inverted",
        ),
        (
            lambda data: replaced(data, struct.pack("<d", 0.125), struct.pack("<d", np.nan)),
            "singular|can be inverted",
        ),
    ],
)
def test_what_is_no_good_file_is_refused(
    good: Path, tmp_path: Path, damage: object, text: str
) -> None:
    path = tmp_path / "bad.vdb"
    path.write_bytes(damage(good.read_bytes()))  # type: ignore[operator]
    with pytest.raises(IoError, match=text):
        read_vdb(path)


def test_a_value_that_is_not_finite_is_refused(tmp_path: Path) -> None:
    grid = SparseGrid.from_dense(np.full((1, 1, 1), 7e4, np.float32), background=123.25)
    write_vdb(tmp_path / "good.vdb", [grid])
    nan = struct.pack("<f", np.nan)
    bad = (tmp_path / "good.vdb").read_bytes().replace(struct.pack("<f", 123.25), nan)
    (tmp_path / "bad.vdb").write_bytes(bad)
    with pytest.raises(IoError, match="finite values, got grid 'density' with NaN"):
        read_vdb(tmp_path / "bad.vdb")


def test_a_missing_file_and_one_beyond_memory_are_refused(good: Path) -> None:
    with pytest.raises(IoError, match="expected a file, got none"):
        read_vdb(good.with_name("missing.vdb"))
    with pytest.raises(IoError, match=r"fit into 1000 bytes, got grids of \d{7} bytes"):
        read_vdb(good, memory_limit=1000)

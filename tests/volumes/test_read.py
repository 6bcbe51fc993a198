"""Volume files: the right number in the right place, and damaged files refused by name."""

from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import IoError, RangeError
from photograd.fitting.fog import fog_model, load_fog
from photograd.grids.sparse import SparseGrid
from photograd.grids.volumes import Volume, read_volume
from photograd_course.cli import run
from PIL import Image

from tests.volumes.files import mitsuba, nifti, values, vtk

pytestmark = pytest.mark.usefixtures("core")

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "volumes"


def read(tmp_path: Path, name: str, data: bytes, **more: Any) -> Volume:
    path = tmp_path / name
    path.write_bytes(data)
    return read_volume(path, **more)


def world(volume: Volume, *index: float) -> list[float]:
    return (volume.world_from_index @ [*index, 1.0])[:3].tolist()


@pytest.mark.parametrize("text", [False, True])
@pytest.mark.parametrize(
    ("kind", "dtype"),
    [("unsigned_char", "u1"), ("short", ">i2"), ("float", ">f4"), ("double", ">f8")],
)
def test_vtk(tmp_path: Path, kind: str, dtype: str, text: bool) -> None:
    volume = read(tmp_path, "a.vtk", vtk(values(), kind, dtype, text))
    np.testing.assert_array_equal(volume.values[..., 0], values())
    assert volume.values.dtype == np.float32
    assert world(volume, 0, 0, 0) == [10, 20, 30]
    assert world(volume, 1, 1, 1) == [10.5, 21, 32]


def test_old_vtk_headers_and_channels(tmp_path: Path) -> None:
    colors = np.stack([values(1), values(2), values(3)], axis=-1)
    old = vtk(colors, SPACING="ASPECT_RATIO 1 1 1", ORIGIN="", TITLE="a title\n")
    volume = read(tmp_path, "a.VTK", old)
    np.testing.assert_array_equal(volume.values, colors)
    np.testing.assert_allclose(volume.density, colors.mean(axis=-1), rtol=1e-6)
    assert world(volume, 2, 0, 1) == [2, 0, 1]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("name", ["a.nii", "a.nii.gz"])
def test_nifti_values_and_scaling(tmp_path: Path, name: str, order: str) -> None:
    data = nifti(values(), order + "i2", 4, slope=0.5, shift=-3.0)
    volume = read(tmp_path, name, gzip.compress(data, mtime=0) if name.endswith("gz") else data)
    np.testing.assert_array_equal(volume.values[..., 0], values() * 0.5 - 3)


def test_nifti_places(tmp_path: Path) -> None:
    # Their x right, y front, z up, in millimeters; ours x right, y up, z back, in meters.
    sform = [[2, 0, 0, -90], [0, 3, 0, -120], [0, 0, 4, -70]]
    volume = read(tmp_path, "a.nii", nifti(values(), sform=sform))
    np.testing.assert_allclose(world(volume, 0, 0, 0), [-0.09, -0.07, 0.12], atol=1e-12)
    np.testing.assert_allclose(world(volume, 1, 1, 1), [-0.088, -0.066, 0.117], atol=1e-12)
    # Half a turn about their z as a quaternion (0, 0, 1): x and y change sign.
    half = read(tmp_path, "b.nii", nifti(values(), qform=(0, 0, 1, 5, 6, 7), units=1))
    np.testing.assert_allclose(world(half, 1, 1, 1), [5 - 2, 7 + 4, -(6 - 3)], atol=1e-6)
    # A quarter turn about their x takes y to z; a left-handed file turns the third axis round.
    quarter = (np.sqrt(0.5), 0, 0, 0, 0, 0)
    left = nifti(values(), qform=quarter, pixdim=(-1, 2, 3, 4), units=1)
    turned = read(tmp_path, "c.nii", left)
    np.testing.assert_allclose(world(turned, 0, 1, 0), [0, 3, 0], atol=1e-6)
    np.testing.assert_allclose(world(turned, 0, 0, 1), [0, 0, -4], atol=1e-6)
    plain = read(tmp_path, "d.nii", nifti(values(), units=0))
    np.testing.assert_allclose(world(plain, 1, 1, 1), [2, 4, -3], atol=1e-6)


@pytest.mark.parametrize(
    ("dtype", "encoding", "scale"), [("<f4", 1, 1), ("<f2", 2, 1), ("u1", 3, 255)]
)
def test_mitsuba(tmp_path: Path, dtype: str, encoding: int, scale: int) -> None:
    colors = np.stack([values(1), values(2), values(3)], axis=-1)
    volume = read(tmp_path, "a.vol", mitsuba(colors, dtype, encoding))
    np.testing.assert_allclose(volume.values, colors / scale, rtol=1e-6)
    np.testing.assert_allclose(world(volume, 0, 0, 0), [-0.8, -0.75, -2 / 3], atol=1e-7)
    np.testing.assert_allclose(world(volume, 4, 3, 2), [0.8, 0.75, 2 / 3], atol=1e-7)


NAN = np.full((5, 4, 3, 1), np.nan)
BAD = {
    "no magic.vtk": (vtk(values(), MAGIC="<?xml?>"), "first line"),
    "format.vtk": (vtk(values(), FORMAT="PACKED"), "ASCII or BINARY"),
    "dataset.vtk": (vtk(values(), DATASET="DATASET POLYDATA"), "STRUCTURED_POINTS"),
    "missing.vtk": (vtk(values(), SCALARS=""), "none of SCALARS"),
    "sizes.vtk": (vtk(values(), DIMENSIONS="DIMENSIONS 5 4"), "DIMENSIONS and three"),
    "negative.vtk": (vtk(values(), DIMENSIONS="DIMENSIONS 5 -4 3"), "whole number"),
    "huge.vtk": (vtk(values(), DIMENSIONS="DIMENSIONS 99999 99999 99999"), "fits into"),
    "flat.vtk": (vtk(values(), DIMENSIONS="DIMENSIONS 60 1 1"), "at least 2 voxels"),
    "type.vtk": (vtk(values(), "bit"), "of a type among"),
    "short.vtk": (vtk(values())[:-1], "60 bytes of values, got 59"),
    "short text.vtk": (vtk(values(), text=True)[:-5], "60 values"),
    "words.vtk": (vtk(values(), text=True)[:-1] + b"x", "numbers, got other words"),
    "place.vtk": (vtk(values(), SPACING="SPACING 0 1 1"), "inverted"),
    "empty.vtk": (b"", "a header with"),
    "magic.nii": (nifti(values(), magic=b"ni1\0"), "one file with its values"),
    "time.nii": (nifti(values(), sizes=(4, 5, 4, 3, 2, 1, 1, 1)), "one volume of three axes"),
    "plane.nii": (nifti(values(), sizes=(2, 5, 4, 3, 1, 1, 1, 1)), "one volume of three axes"),
    "complex.nii": (nifti(values(), code=32), "of a type among"),
    "short.nii": (nifti(values())[:-1], "60 bytes of values, got 59"),
    "infinite.nii": (nifti(values(), slope=np.inf), "finite values"),
    "plain.nii.gz": (nifti(values()), "whole"),
    "cut.nii.gz": (gzip.compress(nifti(values()), mtime=0)[:-20], "whole"),
    "magic.vol": (mitsuba(values()[..., None], magic=b"VOL\2"), "'VOL' of version 3"),
    "code.vol": (mitsuba(values()[..., None], encoding=9), "an encoding among"),
    "short.vol": (mitsuba(values()[..., None])[:-1], "240 bytes of values, got 239"),
    "header.vol": (b"VOL\3", "48 bytes, got 4 bytes"),
    "negative.vol": (mitsuba(values()[..., None], sizes=(-5, 4, 3, 1)), "at least 2 voxels"),
    "box.vol": (mitsuba(values()[..., None], box=(1, 1, 1, -1, 2, 2)), "lowest corner first"),
    "nan.vol": (mitsuba(NAN), "finite values, got 60"),
    "picture.png": (b"", "ends in one of"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_refused(tmp_path: Path, name: str) -> None:
    data, words = BAD[name]
    with pytest.raises(IoError, match=words) as failure:
        read(tmp_path, name, data)
    assert name in str(failure.value)


def test_no_file_and_no_room(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="a file, got none"):
        read_volume(tmp_path / "nowhere.vol")
    with pytest.raises(IoError, match="fits into 0 MiB"):
        read(tmp_path, "a.vtk", vtk(values()), memory_limit=100)


def test_a_window_maps_values_to_nothing_and_all() -> None:
    ramp = np.linspace(0, 200, 8, dtype=np.float32).reshape(8, 1, 1).repeat(4, 1).repeat(4, 2)
    grid = SparseGrid.from_dense(ramp + 1)
    model = fog_model(grid, window=(50, 150), sigma_t=3.0)
    expected = np.clip((ramp + 1 - 50) / 100, 0, 1)
    np.testing.assert_allclose(model.field.density, expected, atol=1e-5)
    assert model.field.policy.density_scale == 3.0
    with pytest.raises(RangeError, match="the lower first"):
        fog_model(grid, window=(2, 1))
    with pytest.raises(RangeError, match="above 500 somewhere"):
        fog_model(grid, window=(500, 600))


def test_the_command_draws_a_scan(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solid = np.full((6, 6, 6), 40, np.uint8)
    solid[2:4, 2:4, 2:4] = 240  # what the window leaves
    path = tmp_path / "scan.nii.gz"
    path.write_bytes(gzip.compress(nifti(solid, pixdim=(1, 1, 1, 1))))
    frames = tmp_path / "frames"
    words = ["--frames", "1", "--size", "32", "--window", "100", "200", "--json"]
    assert run(["render", str(path), "--out", str(frames), *words]) == 0
    assert json.loads(capsys.readouterr().out.splitlines()[-1])["frames"] == 1
    picture = np.asarray(Image.open(frames / "frame_0000.png").convert("L"))
    assert picture[16, 16] > 200
    assert picture[16, 6] < 20
    all_of_it = load_fog(path, ramp="white", sigma_t=None, resolution=6)
    assert all_of_it.field.density.min() > 30


REAL = {
    "ironProt.vtk": ((68, 68, 68, 1), 0, 255),
    "mricron_ch2bet.nii.gz": ((181, 217, 181, 1), 0, 133),
    "lajolla_smoke.vol": ((128, 128, 50, 1), 0, 1),
    "lajolla_colored_density.vol": ((80, 80, 40, 3), -0.004004642, 1.5),
}


@pytest.mark.parametrize("name", REAL)
def test_real_files(name: str) -> None:
    if not (DATA / name).exists():
        pytest.skip("no real volumes beside the project")
    volume = read_volume(DATA / name)
    shape, least, most = REAL[name]
    assert volume.values.shape == shape
    assert volume.values.min() == pytest.approx(least)
    assert volume.values.max() == pytest.approx(most)
    # Neighbors along x agree better than far voxels do: the axes are not mixed up.
    v = volume.density
    for axis in range(3):
        near = np.abs(np.diff(v, axis=axis)).mean()
        assert near < 0.5 * np.abs(v - np.roll(v, v.shape[axis] // 3, axis)).mean()

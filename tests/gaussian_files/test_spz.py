"""The bytes of .spz files: what others wrote, and what the format says bit by bit."""

from __future__ import annotations

import gzip
import struct
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import IoError
from photograd.sh import Y_0
from photograd.splats.files import read_gaussians
from photograd.splats.splatting import Gaussians


def three_bytes(value: int) -> bytes:
    return struct.pack("<i", value)[:3]


def zipped(data: bytes) -> bytes:
    """Without the time of day, which would be part of a test's name."""
    return gzip.compress(data, mtime=0)


def payload(version: int, *, degree: int = 1, flags: int = 0, count: int = 1) -> bytes:
    """One Gaussian at (1.5, -2, 0.25) of the file's frame, written by hand."""
    header = struct.pack("<4sIIBBBB", b"NGSP", version, count, degree, 4, flags, 0)
    positions = three_bytes(24) + three_bytes(-32) + three_bytes(4)
    # About half a turn about y, towards x and z: the largest of x y z w is y, at place 1.
    word = 1 << 30 | 100 << 20 | (1 << 9 | 73) << 10 | 0
    rotation = bytes([127, 255, 127]) if version == 2 else struct.pack("<I", word)
    harmonics = bytes([*range(129, 138)]) if degree else b""
    rest = bytes([204]) + bytes([255, 0, 128]) + bytes([160, 0, 255]) + rotation + harmonics
    return header + positions + rest


def read(tmp_path: Path, content: bytes) -> Gaussians:
    (tmp_path / "a.spz").write_bytes(content)
    return read_gaussians(tmp_path / "a.spz").gaussians


@pytest.mark.parametrize("version", [2, 3])
def test_each_byte_means_what_the_format_says(tmp_path: Path, version: int) -> None:
    g = read(tmp_path, zipped(payload(version)))
    assert g.means.tolist() == [[1.5, 2.0, -0.25]]  # y and z point the other way in our frame
    assert g.log_scales.tolist() == [[0.0, -10.0, 5.9375]]
    np.testing.assert_allclose(g.opacity_logits, [np.log(4.0)], rtol=1e-6)  # 204 of 255 is 0.8
    np.testing.assert_allclose(g.sh[0, 0], [0.5 / 0.15, -0.5 / 0.15, 0.5 / 255 / 0.15], rtol=1e-5)
    # Coefficient by coefficient, the channels within; (-1, 0, 1) stand for y, z, x.
    stored = np.arange(1, 10).reshape(3, 3) / 128
    np.testing.assert_allclose(g.sh[0, 1:], stored * [[-1], [-1], [1]], rtol=1e-6)
    if version == 3:
        x, z = 100 / 511 * np.sqrt(0.5), -73 / 511 * np.sqrt(0.5)
        expected = np.array([0.0, x, np.sqrt(1 - x * x - z * z), z]) * [1, 1, -1, -1]
        np.testing.assert_allclose(g.quats[0], expected, atol=1e-6)
    else:
        angle = 2 * np.degrees(np.arccos(abs(g.quats[0, 2])))
        assert angle < 1.0  # 127 is 1/255 below zero


@pytest.mark.parametrize("name", ["minimal-raw", "minimal-v2", "minimal-v3", "minimal-v4"])
def test_small_files_of_another_program(shared_data: Path, name: str) -> None:
    folder = shared_data / "splats/format_fixtures"
    spz, splat = folder / f"{name}.spz", folder / "minimal.splat"
    a, b = read_gaussians(spz).gaussians, read_gaussians(splat).gaussians
    assert len(a) == len(b) == 4
    z = 1.0 if name in ("minimal-raw", "minimal-v2") else -1.0  # older ones were made unturned
    np.testing.assert_array_equal(a.means * [1, 1, -z], b.means)
    np.testing.assert_allclose(a.log_scales, b.log_scales, atol=1 / 32)
    np.testing.assert_allclose(a.opacity_logits, b.opacity_logits, atol=1e-5)
    if z < 0:
        np.testing.assert_allclose(Y_0 * a.sh, Y_0 * b.sh, atol=0.004 + 0.002)


def test_three_files_of_one_scene_agree(shared_data: Path) -> None:
    ply, words, spz = (
        read_gaussians(shared_data / "splats" / f"biker.{end}").gaussians
        for end in ("ply", "compressed.ply", "spz")
    )
    assert len(ply) == len(words) == len(spz) == 152746
    for name, array in ply.arrays().items():  # the .ply was made of the compressed one
        assert np.array_equal(array, words.arrays()[name]), name
    assert np.isinf(ply.opacity_logits).sum() == 198
    assert np.array_equal(ply.opacity_logits, spz.opacity_logits)
    assert np.abs(ply.means - spz.means).max() == 0.5**13  # half a step
    assert np.abs(ply.sh - spz.sh).max() == pytest.approx(0.5 / 255 / 0.15, rel=1e-4)
    inside = ply.log_scales >= -10
    assert (~inside).sum() == 101
    assert np.abs(ply.log_scales - spz.log_scales)[inside].max() == pytest.approx(1 / 32, rel=1e-4)
    assert (spz.log_scales[~inside] == -10).all()
    cosine = np.abs((ply.quats * spz.quats).sum(axis=1))
    assert 2 * np.degrees(np.arccos(cosine.min())) < 0.28  # measured 0.15


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "an empty one"),
        (zipped(b""), "got an empty file"),
        (b"NGSP", "an .spz file"),
        (zipped(payload(3))[:-9], "a gzip stream without its end"),
        (zipped(payload(3)[:-1]), "expected 45 bytes for 1 Gaussians, got 44"),
        (zipped(payload(3) + b"\0"), "the end of the file after 45 bytes, got more"),
        (payload(3) + b"\0", "got more"),
        (zipped(payload(1)), "version 2 or 3 in this envelope, got 1"),
        (zipped(payload(4)), "version 2 or 3 in this envelope, got 4"),
        (payload(5), "version 2 or 3 or 4"),
        (zipped(payload(3, count=1 << 31)), "2,147,483,648 Gaussians stated, which take"),
        (zipped(payload(3)).replace(b"\x1f\x8b\x08\0", b"\x1f\x8b\x08\xe0"), "gzip stream"),
    ],
)
def test_damaged_files_are_refused(tmp_path: Path, content: bytes, words: str) -> None:
    with pytest.raises(IoError, match=words):
        read(tmp_path, content)


def test_extensions_and_degree_four_are_left_aside(tmp_path: Path) -> None:
    # Behind the streams, as version 3 has them.
    read(tmp_path, zipped(payload(3, flags=2) + b"more"))
    four = payload(3, degree=0).replace(b"\x00\x04\x00\x00", b"\x04\x04\x01\x00", 1)
    (tmp_path / "a.spz").write_bytes(zipped(four + bytes(range(72))))
    found = read_gaussians(tmp_path / "a.spz")
    assert found.gaussians.degree == 3
    assert "harmonics of degree 4 dropped: 3 is ours" in found.conversions
    assert "the file says: fitted with antialiasing" in found.conversions


def version_four(shared_data: Path) -> bytearray:
    return bytearray((shared_data / "splats/format_fixtures/minimal-v4.spz").read_bytes())


def test_version_four_is_read_with_suspicion(tmp_path: Path, shared_data: Path) -> None:
    def refused(words: str, **changes: bytes) -> None:
        data = version_four(shared_data)
        for place, change in changes.items():
            data[int(place[1:]) : int(place[1:]) + len(change)] = change
        with pytest.raises(IoError, match=words):
            read(tmp_path, bytes(data))

    refused("5 streams, got 4", _15=b"\x04")
    refused("36 bytes of positions within the file", _40=struct.pack("<Q", 1 << 60))
    refused("36 bytes of positions within the file", _32=struct.pack("<Q", 1 << 60))
    refused("45 bytes of positions within the file, got 36", _8=b"\x05")
    refused("compressed by Zstandard", _112=b"\0\0\0\0")
    refused("a table at byte 32 to 220, got at 8", _16=b"\x08")
    data = version_four(shared_data)
    for cut in range(len(data)):
        with pytest.raises(IoError):
            read(tmp_path, bytes(data[:cut]))
    record = struct.pack("<II4s", 0xADBE0002, 4, b"orbit")
    data[14], data[16] = 2, 32 + len(record)
    (tmp_path / "a.spz").write_bytes(bytes(data[:32]) + record + bytes(data[32:]))
    assert "extensions left aside: 0xadbe0002" in read_gaussians(tmp_path / "a.spz").conversions

"""Radiance .hdr and PFM: what is written comes back, other programs' files are read, bad ones
refused.
"""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import Error, IoError, RangeError, ShapeError
from photograd.images import read_image
from photograd.images.read import read_header, read_radiance
from photograd.images.rgbe import packed_rows, unpacked_rows
from photograd.images.write import write_exr, write_radiance

RNG = np.random.default_rng(3)
HDR = b"#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n"
SIZES = [(1, 1), (3, 7), (5, 8), (2, 300), (9, 1)]  # rows below 8 pixels are not compressed


def radiance(height: int, width: int) -> np.ndarray:
    """Values of all magnitudes, and runs of equal ones."""
    image = np.exp(RNG.uniform(-80, 80, (height, width, 1))) * RNG.random((height, width, 3))
    image[:, width // 3 : width // 2] = image[:, :1]
    image[0, 0] = 0.0
    return image.astype(np.float32)


@pytest.mark.parametrize("size", SIZES)
def test_pfm_keeps_every_bit(tmp_path: Path, size: tuple[int, int]) -> None:
    image = radiance(*size) * np.float32(-1.0)
    image[-1, -1] = [3.4e38, 1e-45, -0.0]
    write_radiance(tmp_path / "a.pfm", image)
    assert read_radiance(tmp_path / "a.pfm").tobytes() == image.tobytes()


def test_pfm_of_others_is_read(tmp_path: Path) -> None:
    rows = np.array([[1.0, -2.0], [3.0, 4.0], [5.0, 0.5]], np.float32)
    for kind, scale, order in ((b"Pf", b"-1.0", "<f4"), (b"Pf", b"1", ">f4"), (b"Pf", b"2", ">f4")):
        body = rows.astype(order).tobytes()
        (tmp_path / "a.pfm").write_bytes(kind + b"\n2 3\n" + scale + b"\n" + body)
        found = read_radiance(tmp_path / "a.pfm")
        assert np.array_equal(found[..., 1], rows[::-1] * abs(float(scale)))
        assert np.array_equal(found[..., 0], found[..., 2])


@pytest.mark.parametrize("size", SIZES)
def test_rgbe_is_off_by_a_256th_of_the_largest_channel(
    tmp_path: Path, size: tuple[int, int]
) -> None:
    image = radiance(*size)
    image[-1, -1] = 128.5  # between the two smallest mantissas
    write_radiance(tmp_path / "a.hdr", image)
    found = read_radiance(tmp_path / "a.hdr")
    error, largest = np.abs(found.astype(np.float64) - image), image.max(axis=2, keepdims=True)
    assert (error <= largest / 256.0).all()
    assert (error[-1, -1] > largest[-1, -1] / 258.0).all()
    write_radiance(tmp_path / "b.hdr", found)
    assert np.array_equal(read_radiance(tmp_path / "b.hdr"), found)
    assert image.size == 3 or (found[0, 0] == 0.0).all()


def test_powers_of_two_and_ends_of_the_range(tmp_path: Path) -> None:
    values = np.array([2.0**-127, 2.0**-130, 1.0, 255.9 / 256, 1e4, 1.69e38], np.float32)
    image = np.repeat(values[None, :, None], 3, axis=2)
    write_radiance(tmp_path / "a.hdr", image)
    expected = np.array([2.0**-127, 0.0, 1.0, 1.0, 1e4, 1.69e38])
    np.testing.assert_allclose(read_radiance(tmp_path / "a.hdr")[0, :, 1], expected, rtol=1 / 256)
    for bad in (-1.0, 2e38):
        with pytest.raises(RangeError, match=r"values from 0 to 1\.7e38, got .*write \.exr or"):
            write_radiance(tmp_path / "b.hdr", image * 0 + np.float32(bad))
    for name in ("b.hdr", "b.pfm"):
        with pytest.raises(ShapeError, match=r"image: expected shape \(H, W, 3\)"):
            write_radiance(tmp_path / name, np.zeros((2, 2, 4), np.float32))
        with pytest.raises(RangeError, match="finite numbers"):
            write_radiance(tmp_path / name, np.full((2, 2, 3), np.inf, np.float32))
    with pytest.raises(IoError, match=r"ends in \.exr or \.hdr or \.pfm"):
        write_radiance(tmp_path / "b.png", image)


def test_each_byte_of_rgbe_means_what_the_format_says(tmp_path: Path) -> None:
    # One row of 8: red 128 eight times, green 1..8, blue 0, exponents 129 and 137.
    row = bytes([2, 2, 0, 8, 136, 128, 8, *range(1, 9), 136, 0, 132, 129, 132, 137])
    (tmp_path / "a.hdr").write_bytes(HDR + b"EXPOSURE=2\nEXPOSURE=0.25\n\n-Y 1 +X 8\n" + row)
    found = read_radiance(tmp_path / "a.hdr")
    np.testing.assert_array_equal(found[0, :, 0], [2.0] * 4 + [512.0] * 4)
    np.testing.assert_array_equal(found[0, :, 1], np.arange(1, 9) * np.repeat([1 / 64, 4.0], 4))
    assert not found[..., 2].any()


@pytest.mark.parametrize("order", ["-Y 2 +X 3", "+Y 2 +X 3", "-Y 2 -X 3", "+X 3 -Y 2", "-X 3 +Y 2"])
def test_rows_may_run_any_way(tmp_path: Path, order: str) -> None:
    pixels = RNG.integers(128, 256, (2, 3, 3)).astype(np.uint8)
    stored = pixels[:: -1 if "+Y" in order else 1, :: -1 if "-X" in order else 1]
    stored = stored.transpose(1, 0, 2) if order[1] == "X" else stored
    body = np.concatenate([stored, np.full((*stored.shape[:2], 1), 136, np.uint8)], axis=2)
    (tmp_path / "a.hdr").write_bytes(HDR + f"\n{order}\n".encode() + body.tobytes())
    np.testing.assert_array_equal(read_radiance(tmp_path / "a.hdr"), pixels)
    assert read_header(tmp_path / "a.hdr").width == 3


def test_repetitions_of_old_files_are_written_out() -> None:
    pixel, other = bytes([200, 100, 50, 130]), bytes([9, 8, 7, 6])
    rows = unpacked_rows(pixel + bytes([1, 1, 1, 3, 1, 1, 1, 1]) + other, 1, 261)
    assert rows.shape == (1, 261, 4)
    assert rows[0, :260].tobytes() == pixel * 260
    assert rows[0, 260].tobytes() == other
    for content in (b"", bytes([1, 1, 1, 4]), pixel + bytes([1, 1, 1, 255] * 5), pixel * 3):
        with pytest.raises(ValueError, match=r"repetitions|pixels"):
            unpacked_rows(content, 1, 4)


def test_runs_save_room() -> None:
    flat = np.full((4, 1000, 4), 7, np.uint8)
    assert len(packed_rows(flat)) == 4 * (4 + 4 * 2 * 8)
    noise = RNG.integers(0, 256, (4, 1000, 4)).astype(np.uint8)
    assert len(packed_rows(noise)) < 1.02 * noise.size
    assert np.array_equal(unpacked_rows(packed_rows(noise), 4, 1000), noise)


@pytest.mark.parametrize(
    ("name", "largest", "sky"),
    [("potsdamer_platz_1k", 11.8125, 1.81), ("rooitou_park_1k", 69120.0, 0.159)],
)
def test_maps_of_others_are_read_and_come_back(
    tmp_path: Path, shared_data: Path, name: str, largest: float, sky: float
) -> None:
    path = shared_data / "envmaps" / f"{name}.hdr"
    header, image = read_header(path), read_radiance(path)
    assert (header.width, header.height, header.color_space) == (1024, 512, "linear")
    assert image.shape == (512, 1024, 3)
    assert image.max() == largest  # 189/256 of 2^4, and 135/128 of 2^16, the sun
    assert image[:128].mean() == pytest.approx(sky, rel=0.01)
    assert image[:128].mean() > 3 * image[-128:].mean() > 0.1
    write_radiance(tmp_path / "a.hdr", image[100:140])
    assert np.array_equal(read_radiance(tmp_path / "a.hdr"), image[100:140])


@pytest.mark.parametrize("suffix", [".exr", ".hdr", ".pfm"])
def test_images_of_radiance_are_linear_and_opaque(tmp_path: Path, suffix: str) -> None:
    image = RNG.random((4, 9, 3), np.float32) * 1e4
    write_radiance(tmp_path / f"a{suffix}", image)
    found, header = read_image(tmp_path / f"a{suffix}"), read_header(tmp_path / f"a{suffix}")
    assert (header.width, header.height, header.has_alpha) == (9, 4, False)
    assert header.color_space == "linear"
    assert (found[..., 3] == 1.0).all()
    step = image.max(-1, keepdims=True) / 256 if suffix == ".hdr" else 0.0
    assert (np.abs(found[..., :3] - image) <= step).all()


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    image = radiance(6, 30)
    image[:, :, 1] = image[0, 0, 1]
    for name in ("a.hdr", "a.pfm"):
        path = tmp_path / name
        write_radiance(path, image)
        whole = path.read_bytes()
        for cut in range(1, len(whole), 29):
            path.write_bytes(whole[:cut])
            with pytest.raises(IoError):
                read_radiance(path)
        for _ in range(60):
            bad = bytearray(whole)
            bad[RNG.integers(len(bad))] = RNG.integers(256)
            path.write_bytes(bytes(bad))
            try:
                assert np.isfinite(read_radiance(path)).all()
            except Error as failure:
                assert isinstance(failure, IoError)  # noqa: PT017


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (HDR + b"\n-Y 70000 +X 8\n" + b"\0" * 99, "1 to 65536 pixels a side, got 8 x 70000"),
        (HDR + b"\n-Y 60000 +X 30000\n", "30000 x 60000 = 1,800,000,000"),
        (HDR + b"\n-Y 4000 +X 30000\n" + bytes([2, 2, 117, 48]) * 9, "36 bytes are too few"),
        (HDR + b"\n-Y 9000 +X 9\n" + bytes([2, 2, 0, 9]) * 9, "36 bytes are too few"),
        (HDR + b"\n-Y 0 +X 8\n", "1 to 65536 pixels a side"),
        (HDR + b"\n-Y 8 +Y 8\n", "a Radiance header"),
        (HDR.replace(b"rgbe", b"xyze") + b"\n-Y 1 +X 1\n1234", "FORMAT=32-bit_rle_rgbe"),
        (HDR + b"EXPOSURE=0\n\n-Y 1 +X 1\n1234", "a positive EXPOSURE"),
        (b"PF\n60000 60000\n-1\n" + b"\0" * 99, "60000 x 60000 = 3,600,000,000 .*PHOTOGRAD_MAX_PI"),
        (b"PF\n10000 10000\n-1\n" + b"\0" * 99, "1,200,000,018 bytes for 10000 x 10000 pixels"),
        (b"PF\n70000 1\n-1\n", "1 to 65536 pixels a side"),
        (b"PF\n1 1\n0\n" + b"\0" * 12, "a PFM header"),
        (b"PF\n1 1\nnan\n" + b"\0" * 12, "a PFM header"),
        (b"Pf\n1 1\n-1\n\0\0\xc0\x7f", "finite values, got others, the first in row 0, column 0"),
    ],
)
def test_headers_without_sense_take_no_memory(tmp_path: Path, content: bytes, words: str) -> None:
    (tmp_path / "a").write_bytes(content)
    tracemalloc.start()
    with pytest.raises(IoError, match=words):
        read_radiance(tmp_path / "a")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4 << 20  # what remains are imports and the texts of tracebacks


def test_radiance_is_not_read_from_clipped_images(tmp_path: Path) -> None:
    write_exr(tmp_path / "named.png", np.full((2, 2, 4), 0.5, np.float32))
    assert (read_radiance(tmp_path / "named.png") == 0.5).all()
    assert (read_image(tmp_path / "named.png")[..., :3] == 1.0).all()
    (tmp_path / "a.hdr").write_bytes(b"\x89PNG\r\n\x1a\n" + b"\0" * 30)
    with pytest.raises(IoError, match=r"a readable image \(EXR, HDR, PFM\), got PNG data"):
        read_radiance(tmp_path / "a.hdr")

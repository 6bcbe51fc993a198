"""PNG files with 16 bits a channel: every bit arrives, in every layout."""

from __future__ import annotations

import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import IoError
from photograd.images import read_image, write_png
from photograd.images.read import read_header

from support.missing import need_module
from support.png import SIGNATURE, chunk, header, sixteen_bits

LEVELS = np.random.default_rng(3).integers(0, 65536, (6, 5, 4))
KEY = chunk(b"tRNS", struct.pack(">HHH", *LEVELS[2, 3, :3]))


def opencv() -> None:
    need_module("cv2")


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_every_bit_of_every_layout(tmp_path: Path, channels: int) -> None:
    if channels > 1:
        opencv()
    (tmp_path / "a.png").write_bytes(sixteen_bits(LEVELS[..., :channels]))
    expected = np.full((6, 5, 4), 65535)
    expected[..., :3] = LEVELS[..., : 3 if channels > 2 else 1]
    if channels in (2, 4):
        expected[..., 3] = LEVELS[..., channels - 1]
        assert read_header(tmp_path / "a.png").has_alpha
    np.testing.assert_array_equal(np.rint(read_image(tmp_path / "a.png") * 65535), expected)


def test_a_transparent_color(tmp_path: Path) -> None:
    opencv()
    (tmp_path / "a.png").write_bytes(sixteen_bits(LEVELS[..., :3], KEY))
    assert read_header(tmp_path / "a.png").has_alpha
    image = read_image(tmp_path / "a.png")
    np.testing.assert_array_equal(np.rint(image[..., :3] * 65535), LEVELS[..., :3])
    assert image[2, 3, 3] == 0.0
    assert image[..., 3].sum() == 29


def test_what_is_written_holds_every_bit(tmp_path: Path) -> None:
    opencv()
    for channels in (3, 4):
        levels = LEVELS[..., :channels]
        write_png(tmp_path / "a.png", (levels / 65535).astype(np.float32), bits=16)
        again = read_image(tmp_path / "a.png")[..., :channels]
        np.testing.assert_array_equal(np.rint(again * 65535), levels)


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    opencv()
    path = tmp_path / "a.png"
    whole = sixteen_bits(LEVELS)
    for stop in range(34, len(whole) - 16, 7):
        path.write_bytes(whole[:stop])
        with pytest.raises(IoError, match=r"a\.png'?: expected"):
            read_image(path)
    broken = bytearray(whole)
    broken[len(whole) // 2] ^= 255  # the checksum is then another
    path.write_bytes(bytes(broken))
    with pytest.raises(IoError, match="damaged data"):
        read_image(path)
    path.write_bytes(SIGNATURE + header(60_000, 60_000, 16, 2) + chunk(b"IDAT", b""))
    with pytest.raises(IoError, match="at most 134,217,728 pixels"):
        read_image(path)


def test_without_opencv_the_command_that_installs_it_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    (tmp_path / "a.png").write_bytes(sixteen_bits(LEVELS))
    with pytest.raises(IoError, match=r"read_image: cv2: .* \(pip install 'photograd\[png16\]'\)"):
        read_image(tmp_path / "a.png")
    with pytest.raises(IoError, match=r"write_png: cv2: expected an installed package, got none"):
        write_png(tmp_path / "b.png", np.zeros((2, 2, 3), np.float32), bits=16)
    assert not (tmp_path / "b.png").exists()

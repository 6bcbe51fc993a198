"""EXR files whose headers state more than they hold: refused before the library allocates."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from photograd.errors import IoError
from photograd.images import exr

WHAT = r"read_exr_header: .*expected pixels that \d+ bytes can hold, got [\d,]+ bytes of them"


@pytest.fixture
def never_decoded(monkeypatch: pytest.MonkeyPatch) -> None:
    """The library opens headers alone."""
    opened = OpenEXR.File

    def file(*args: Any, **named: Any) -> Any:
        assert named.get("header_only") or not isinstance(args[0], str), "pixels are decoded"
        return opened(*args, **named)

    monkeypatch.setattr(exr.OpenEXR, "File", file)


def patched(path: Path, attribute: bytes, values: bytes, part: int = 0) -> Path:
    """Overwrite an attribute's value in the header of a part."""
    data = path.read_bytes()
    at = -1
    for _ in range(part + 1):
        at = data.index(attribute, at + 1)
    at += len(attribute) + 4
    path.write_bytes(data[:at] + values + data[at + len(values) :])
    return path


def written(path: Path, *, tiles: bool = False, parts: int = 1) -> Path:
    kind = OpenEXR.tiledimage if tiles else OpenEXR.scanlineimage
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": kind}
    header |= {"tiles": OpenEXR.TileDescription()} if tiles else {}
    pixels = {"RGB": np.full((4, 4, 3), 0.5, np.float32)}
    made = [OpenEXR.Part(dict(header), dict(pixels), f"p{k}") for k in range(parts)]
    with OpenEXR.File(made) as file:
        file.write(str(path))
    return path


WINDOW, HUGE = b"dataWindow\0box2i\0", struct.pack("<4i", 0, 0, 16383, 8190)


@pytest.mark.usefixtures("never_decoded")
@pytest.mark.parametrize("part", [0, 1])
def test_a_window_beyond_the_bytes_of_a_file_is_refused(tmp_path: Path, part: int) -> None:
    path = patched(written(tmp_path / "a.exr", parts=2), WINDOW, HUGE, part)
    assert path.stat().st_size < 2000
    with pytest.raises(IoError, match=WHAT):
        exr.read_exr(path)


@pytest.mark.usefixtures("never_decoded")
def test_a_tile_beyond_the_bytes_of_a_file_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path / "a.exr", tiles=True)
    patched(path, b"tiles\0tiledesc\0", struct.pack("<2I", 1 << 15, 1 << 13))
    with pytest.raises(IoError, match=WHAT):
        exr.read_exr(path)


@pytest.mark.parametrize("tiles", [False, True])
def test_what_a_file_holds_is_read(tmp_path: Path, tiles: bool) -> None:
    found = exr.read_exr(written(tmp_path / "a.exr", tiles=tiles))
    assert found.shape == (4, 4, 4)
    assert (found[..., :3] == 0.5).all()


def test_pictures_of_one_color_pack_best_and_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    path.write_bytes(exr.encode_exr(np.full((2600, 2600, 4), 0.5, np.float32), half=False))
    assert path.stat().st_size < 2600 * 2600 * 16 / 500
    assert exr.read_exr(path).shape == (2600, 2600, 4)

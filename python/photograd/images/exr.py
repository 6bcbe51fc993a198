"""OpenEXR files: the one door to the OpenEXR library."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenEXR
from photograd_course.input_files import require_file

from photograd.errors import IoError, RangeError, message
from photograd.images.kind import require_size

_CHANNELS = ("R", "G", "B", "A")

MAX_HALF = 65504.0
DEFLATED = 1032
"""Bytes that one byte of a file may become: the most of deflate, which packs most EXR files."""
SMALL = 64 << 20
"""Bytes that any file may take: other methods pack even pictures of one color tighter."""


def read_exr_header(path: Path) -> tuple[int, int, bool]:
    """Width, height and whether there is an alpha channel.

    Raises:
        IoError: no such file, not an EXR file, an empty or absurd window, more pixels than a file
            of this length can hold, deep pixels, or neither R, G, B nor Y channels.
    """
    require_file("read_exr_header", path)  # the library would call it damaged, and write to stderr
    try:
        with OpenEXR.File(str(path), separate_channels=True, header_only=True) as opened:
            headers = [part.header for part in opened.parts]
            lower, upper = headers[0]["dataWindow"]
            names = {channel.name for channel in headers[0]["channels"]}
            stated = sum(map(_decoded_bytes, headers))
            kinds = {header["type"] for header in headers}
    except Exception as error:  # the binding raises RuntimeError, ValueError, TypeError and others
        raise _unreadable("read_exr_header", path, error) from error
    width = int(upper[0]) - int(lower[0]) + 1
    height = int(upper[1]) - int(lower[1]) + 1
    require_size("read_exr_header", str(path), width, height, len(names))
    if not kinds <= {OpenEXR.scanlineimage, OpenEXR.tiledimage}:
        raise IoError(message("read_exr_header", str(path), "scan lines or tiles", "deep pixels"))
    size = path.stat().st_size
    if stated > SMALL + DEFLATED * size:
        expected, got = f"pixels that {size:,} bytes can hold", f"{stated:,} bytes of them stated"
        raise IoError(message("read_exr_header", str(path), expected, got))
    if not (set(_CHANNELS[:3]) <= names or "Y" in names):
        expected = "channels R, G, B or Y"
        raise IoError(message("read_exr_header", str(path), expected, sorted(names)))
    return width, height, "A" in names


def _decoded_bytes(header: dict[str, Any]) -> int:
    """What the library allocates for a part: the pixels of its channels, and a tile."""
    lower, upper = header["dataWindow"]
    pixels = (int(upper[0]) - int(lower[0]) + 1) * (int(upper[1]) - int(lower[1]) + 1)
    tile = header.get("tiles")
    if tile is not None:
        pixels += int(tile.xSize) * int(tile.ySize)
    return 4 * len(header["channels"]) * max(pixels, 0)


def read_exr(path: Path) -> npt.NDArray[np.float32]:
    """Pixels (H, W, 4) float32 as stored: linear, premultiplied; alpha is 1 if the file has none.

    The display window is not applied: the array is the data window.

    Raises:
        IoError: not an EXR file, truncated, or non-finite pixels.
    """
    width, height, _ = read_exr_header(path)
    try:
        with OpenEXR.File(str(path), separate_channels=True) as opened:
            planes = {name: channel.pixels for name, channel in opened.channels().items()}
    except Exception as error:  # as above; a truncated file shows up as a part without channels
        raise _unreadable("read_exr", path, error) from error
    result = np.ones((height, width, 4), dtype=np.float32)
    for index, name in enumerate(_CHANNELS):
        plane = planes.get(name, planes.get("Y") if name != "A" else None)
        if plane is None:
            continue
        if plane.shape != (height, width):
            raise _unreadable("read_exr", path, f"channel {name} has shape {plane.shape}")
        result[..., index] = plane
    if not bool(np.isfinite(result).all()):
        bad = np.argwhere(~np.isfinite(result).all(axis=2))
        got = f"{len(bad)} bad pixels, the first in row {bad[0][0]}, column {bad[0][1]}"
        raise IoError(message("read_exr", str(path), "finite values", got))
    return result


def encode_exr(image: npt.NDArray[np.float32], *, half: bool) -> bytes:
    """(H, W, 3 or 4) as the bytes of a file: scan lines with ZIP compression, which loses nothing.

    Raises:
        RangeError: values that a half cannot hold.
    """
    if half and float(np.abs(image).max()) > MAX_HALF:
        got = f"{float(np.abs(image).max()):.6g}"
        raise RangeError(message("write_exr", "image", "at most 65504 in half", got, "use float"))
    name = "RGB" if image.shape[2] == 3 else "RGBA"
    header: dict[str, Any] = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    pixels = np.ascontiguousarray(image, dtype=np.float16 if half else np.float32)
    with TemporaryDirectory() as folder:  # older versions of the library write to paths alone
        path = Path(folder) / "image.exr"
        with OpenEXR.File(header, {name: pixels}) as opened:
            opened.write(str(path))
        return path.read_bytes()


def _unreadable(function: str, path: Path, error: object) -> IoError:
    text = " ".join(str(error).split())
    return IoError(message(function, str(path), "a readable EXR image", f"damaged data: {text}"))

"""Portable float maps: `PF` (color) or `Pf` (gray), width, height, scale, then float32 samples.

Rows run from the bottom up. A negative scale means little-endian; its size multiplies the samples.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import numpy.typing as npt
from photograd_course.input_files import read_file

from photograd._arrays import Arguments
from photograd.errors import IoError, message
from photograd.images.kind import require_size

_HEADER = re.compile(rb"P([Ff])\s+(\d{1,9})\s+(\d{1,9})\s+(\S{1,40})\s")
_MAX_HEADER_BYTES = 128


def read_pfm_header(path: Path) -> tuple[int, int]:
    """Width and height.

    Raises:
        IoError: no PFM file, a side beyond reason, or another length than its header implies.
    """
    _, width, height, _, _ = _header(path)
    return width, height


def read_pfm(path: Path) -> npt.NDArray[np.float32]:
    """Pixels (H, W, 3) float32, top row first; gray is repeated.

    Raises:
        IoError: as `read_pfm_header`, or samples that are not finite.
    """
    start, width, height, channels, scale = _header(path)
    content = read_file("read_pfm", path)
    samples = np.frombuffer(
        content, "<f4" if scale < 0 else ">f4", width * height * channels, start
    )
    with np.errstate(over="ignore", invalid="ignore"):
        rows = samples.reshape(height, width, channels)[::-1].astype(np.float32)
        rows *= np.float32(abs(scale))
    if not np.isfinite(rows).all():
        row, column = np.argwhere(~np.isfinite(rows))[0][:2]
        got = f"others, the first in row {row}, column {column}"
        raise IoError(message("read_pfm", f"{path}", "finite values", got))
    return np.ascontiguousarray(np.broadcast_to(rows, (height, width, 3)))


def encode_pfm(image: npt.NDArray[np.float32]) -> bytes:
    """(H, W, 3) as the bytes of a little-endian file, to the bit.

    Raises:
        ShapeError: alpha, which the format lacks.
    """
    image = Arguments("write_pfm").array("image", image, ("H", "W", 3))
    height, width = image.shape[:2]
    return b"PF\n%d %d\n-1.0\n" % (width, height) + image[::-1].astype("<f4").tobytes()


def _header(path: Path) -> tuple[int, int, int, int, float]:
    """Where the samples start, width, height, channels and scale."""
    found = _HEADER.match(read_file("read_pfm", path, _MAX_HEADER_BYTES))
    try:
        scale = float(found[4]) if found else 0.0
    except ValueError:
        scale = 0.0
    if not found or scale == 0.0 or not math.isfinite(scale):
        expected = "a PFM header: PF or Pf, width, height, scale"
        raise IoError(message("read_pfm", f"{path}", expected, "another"))
    width, height, channels = int(found[2]), int(found[3]), 3 if found[1] == b"F" else 1
    require_size("read_pfm", str(path), width, height)
    needed, size = found.end() + 4 * width * height * channels, path.stat().st_size
    if size != needed:
        expected = f"{needed:,} bytes for {width} x {height} pixels"
        raise IoError(message("read_pfm", f"{path}", expected, f"{size:,}"))
    return found.end(), width, height, channels, scale

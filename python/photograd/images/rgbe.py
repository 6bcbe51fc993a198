"""Radiance pictures (.hdr): a byte each of red, green and blue, and an exponent that they share.

A pixel is (r, g, b) 2^(e - 136), or 0 where e = 0: the largest of the three keeps 8 bits, and the
error is at most 1/256 of it [Ward1991]. `rgbe_rows` has the compression.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from photograd_course.input_files import read_file

from photograd._memory import available_memory
from photograd.errors import IoError, RangeError, ShapeError, message
from photograd.images.pixel_limit import require_size
from photograd.images.rgbe_rows import packed_rows, unpacked_rows

BIAS = 136
_LONGEST_HEADER = 1 << 14
_SIZE = re.compile(rb"([-+])([XY]) (\d{1,9}) ([-+])([XY]) (\d{1,9})")


@dataclass(frozen=True)
class _Header:
    start: int  # of the pixels
    axes: tuple[bytes, bytes, bytes, bytes]  # sign and name, of the slow axis and the fast one
    slow: int
    fast: int
    exposure: float  # that samples are to be divided by

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return (self.fast, self.slow) if self.axes[1] == b"Y" else (self.slow, self.fast)


def read_rgbe_header(path: Path) -> tuple[int, int]:
    """Width and height.

    Raises:
        IoError: no Radiance picture of RGB, or a side beyond reason.
    """
    return _header(path, read_file("read_rgbe", path, _LONGEST_HEADER)).size


def read_rgbe(path: Path) -> npt.NDArray[np.float32]:
    """Pixels (H, W, 3) float32, linear, top row first.

    Raises:
        IoError: as `read_rgbe_header`, damaged or truncated, or more than memory holds.
    """
    content = read_file("read_rgbe", path)
    header = _header(path, content)
    pixels = header.slow * header.fast
    needed = 64 * pixels  # numbers in double, once more for their product, and the result
    if needed > available_memory():
        raise _damaged(path, "an image that fits into memory", f"{needed:,} bytes needed")
    try:
        rgbe = unpacked_rows(content[header.start :], header.slow, header.fast)
    except ValueError as failure:
        expected = f"{header.slow} rows of {header.fast} pixels"
        raise _damaged(path, expected, f"damaged data: {failure}") from failure
    if header.axes[1] == b"X":
        rgbe = rgbe.transpose(1, 0, 2)
    signs = dict(zip(header.axes[1::2], header.axes[::2], strict=True))
    rgbe = rgbe[:: 1 if signs[b"Y"] == b"-" else -1, :: 1 if signs[b"X"] == b"+" else -1]
    unit = np.ldexp(1.0 / header.exposure, rgbe[..., 3:].astype(np.int32) - BIAS)
    unit[rgbe[..., 3:] == 0] = 0.0
    color = np.asarray(rgbe[..., :3] * unit)
    if color.max() > np.finfo(np.float32).max:
        raise _damaged(path, "radiance that float32 can hold", f"{color.max():.3g}")
    return np.ascontiguousarray(color, np.float32)


def encode_rgbe(image: npt.NDArray[np.float32]) -> bytes:
    """(H, W, 3) as the bytes of a file, mantissas rounded to the nearest.

    Raises:
        ShapeError: alpha, for which there is no place.
        RangeError: values below 0, or beyond the largest exponent (1.7e38).
    """
    if image.shape[2] != 3:
        raise ShapeError(message("write_rgbe", "image", "shape (H, W, 3)", image.shape))
    largest = image.max(axis=2).astype(np.float64)
    mantissa, exponent = np.frexp(largest)
    exponent += np.rint(256.0 * mantissa) > 255  # rounded up to the next power of two
    if float(image.min()) < 0.0 or int(exponent.max()) + 128 > 255:
        got = f"{float(image.min()):.3g} to {float(image.max()):.3g}"
        expected, remedy = "values from 0 to 1.7e38", "write .exr or .pfm"
        raise RangeError(message("write_rgbe", "image", expected, got, remedy))
    kept = (largest > 0.0) & (exponent + 128 > 0)
    rgbe = np.zeros((*image.shape[:2], 4), np.uint8)
    scaled = image.astype(np.float64) * np.ldexp(1.0, 8 - exponent)[..., None]
    rgbe[..., :3] = np.where(kept[..., None], np.rint(scaled), 0.0)
    rgbe[..., 3] = np.where(kept, exponent + 128, 0)
    start = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % image.shape[:2]
    return start + packed_rows(rgbe)


def _header(path: Path, content: bytes) -> _Header:
    """Lines of text to an empty one, then the line with the size."""
    text, blank, rest = content[:_LONGEST_HEADER].partition(b"\n\n")
    line, end, _ = rest.partition(b"\n")
    found = _SIZE.fullmatch(line)
    if not blank or not end or not found or {found[2], found[5]} != {b"X", b"Y"}:
        raise _damaged(path, "a Radiance header that ends in a line such as -Y 512 +X 1024", "none")
    exposure = 1.0
    for entry in text.splitlines():
        name, _, value = entry.partition(b"=")
        if name == b"FORMAT" and value.strip() != b"32-bit_rle_rgbe":
            raise _damaged(path, "FORMAT=32-bit_rle_rgbe", repr(value.decode("latin-1")))
        if name == b"EXPOSURE":
            exposure *= _positive(path, value)
    start, axes = len(text) + len(blank) + len(line) + 1, (found[1], found[2], found[4], found[5])
    header = _Header(start, axes, int(found[3]), int(found[6]), exposure)
    require_size("read_rgbe", str(path), *header.size)
    return header


def _positive(path: Path, value: bytes) -> float:
    try:
        number = float(value)
    except ValueError:
        number = 0.0
    if not 1e-30 < number < 1e30:
        raise _damaged(path, "a positive EXPOSURE", repr(value.decode("latin-1")))
    return number


def _damaged(path: Path, expected: str, got: str) -> IoError:
    return IoError(message("read_rgbe", f"{path}", expected, got))

"""Radiance pictures (.hdr): a byte each of red, green and blue, and an exponent that they share.

A row of 8 to 32767 pixels begins with 2, 2 and its width in two bytes. Its four channels follow one
after the other: a count n up to 128 and n bytes, or 128 + n and one byte that stands n times. Other
rows, and those of old files, are pixels of four bytes, where (1, 1, 1, n) repeats the one before.

A pixel is (r, g, b) 2^(e - 136), or 0 where e = 0: the largest of the three keeps 8 bits, and the
error is at most 1/256 of it [Ward1991].
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from photograd_course.input_files import read_file

from photograd._arrays import Arguments
from photograd._memory import available_memory
from photograd.errors import IoError, RangeError, message
from photograd.images.kind import require_size

Bytes = npt.NDArray[np.uint8]
SHORTEST, LONGEST = 8, 0x7FFF
_RUN = 4
"""Shorter repetitions are not worth a code of their own."""


def unpacked_rows(content: bytes, count: int, width: int) -> Bytes:
    """(count, width, 4) bytes of a picture's rows; nothing may follow.

    Raises:
        ValueError: says what is damaged; more memory than the content can fill is never taken.
    """
    mark = _mark(width)
    if not mark or content[:4] != mark:
        return _flat(content, count * width).reshape(count, width, 4)
    # A code of two bytes stands for 127 at most.
    if len(content) < count * (4 + 8 * (width // 127)):
        raise ValueError(f"{len(content):,} bytes are too few")
    rows, at = np.empty((count, 4, width), np.uint8), 0
    for row in range(count):
        if content[at : at + 4] != mark:
            raise ValueError(f"row {row} does not begin as it should")
        line = bytearray()
        at += 4
        while len(line) < 4 * width:
            channel, code = len(line) // width, content[at] if at + 1 < len(content) else 0
            line += (
                content[at + 1 : at + 2] * (code - 128)
                if code > 128
                else (content[at + 1 : at + 1 + code])
            )
            at += 2 if code > 128 else 1 + code
            if code == 0 or at > len(content) or (len(line) - 1) // width != channel:
                raise ValueError(f"row {row} is cut off, or of another length")
        rows[row] = np.frombuffer(line, np.uint8).reshape(4, width)
    return rows.transpose(0, 2, 1)


def packed_rows(rgbe: Bytes) -> bytes:
    """The bytes of rows (H, W, 4), compressed where the format allows it."""
    mark = _mark(rgbe.shape[1])
    if not mark:
        return rgbe.tobytes()
    parts = []
    for row in rgbe:
        parts += [mark, *(_packed(np.ascontiguousarray(row[:, k])) for k in range(4))]
    return b"".join(parts)


def _mark(width: int) -> bytes:
    """What a compressed row begins with; empty where rows are not compressed."""
    return bytes([2, 2, width >> 8, width & 255]) if SHORTEST <= width <= LONGEST else b""


def _flat(content: bytes, pixels: int) -> Bytes:
    """(pixels, 4), repetitions written out."""
    groups = np.frombuffer(content, np.uint8, len(content) // 4 * 4).reshape(-1, 4)
    repeats = (groups[:, :3] == 1).all(axis=1)
    source = np.maximum.accumulate(np.where(repeats, 0, np.arange(len(groups))))
    # Of several repetitions in a row, each counts 256 times what the one before does.
    digit = np.arange(len(groups)) - source - 1
    if not len(groups) or repeats[0] or (digit[repeats] > 3).any():
        raise ValueError("repetitions of no pixel")
    counts = np.ones(len(groups), np.int64)
    counts[repeats] = groups[repeats, 3].astype(np.int64) << 8 * digit[repeats]
    if int(counts.sum()) != pixels:
        raise ValueError(f"{int(counts.sum()):,} pixels")
    return np.repeat(groups[source], counts, axis=0)


def _packed(channel: Bytes) -> bytes:
    """One channel of a row: runs of four and more, and what lies between them."""
    bounds = np.concatenate([[0], np.flatnonzero(np.diff(channel)) + 1, [len(channel)]])
    lengths = np.diff(bounds)
    data, parts, done = channel.tobytes(), [], 0
    for run in np.flatnonzero(lengths >= _RUN):
        first, length = int(bounds[run]), int(lengths[run])
        parts.append(_literal(data[done:first]))
        value = data[first : first + 1]
        parts += [bytes([128 + min(127, length - at)]) + value for at in range(0, length, 127)]
        done = first + length
    return b"".join([*parts, _literal(data[done:])])


def _literal(data: bytes) -> bytes:
    pieces = [data[at : at + 128] for at in range(0, len(data), 128)]
    return b"".join(bytes([len(piece)]) + piece for piece in pieces)


# Radiance pictures (.hdr): a byte each of red, green and blue, and an exponent that they share.


BIAS = 136
_MAX_HEADER_BYTES = 1 << 14
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
    return _header(path, read_file("read_rgbe", path, _MAX_HEADER_BYTES)).size


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
        ShapeError: alpha, which the format lacks.
        RangeError: values below 0, or beyond the largest exponent (1.7e38).
    """
    image = Arguments("write_rgbe").array("image", image, ("H", "W", 3))
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
    text, blank, rest = content[:_MAX_HEADER_BYTES].partition(b"\n\n")
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

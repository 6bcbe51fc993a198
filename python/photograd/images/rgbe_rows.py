"""Rows of Radiance pictures, compressed by run lengths.

A row of 8 to 32767 pixels begins with 2, 2 and its width in two bytes. Its four channels follow one
after the other: a count n up to 128 and n bytes, or 128 + n and one byte that stands n times. Other
rows, and those of old files, are pixels of four bytes, where (1, 1, 1, n) repeats the one before.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

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
    place = np.arange(len(groups)) - source - 1
    if not len(groups) or repeats[0] or (place[repeats] > 3).any():
        raise ValueError("repetitions of no pixel")
    counts = np.ones(len(groups), np.int64)
    counts[repeats] = groups[repeats, 3].astype(np.int64) << 8 * place[repeats]
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

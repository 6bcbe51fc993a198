"""Work on arrays in pieces that stay in the cache, on one or two threads, with the same bits.

An update reads and writes four arrays a dozen times. Whole arrays would travel from memory each
time; pieces of 32,768 elements travel once. The pieces are fixed and each element is computed from
itself alone, so the number of threads cannot change a result.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from ..checks import FloatArray

CHUNK = 32_768
# Below this, starting threads costs more than it saves.
_THREADED_FROM = 262_144

Scratch = FloatArray
Work = Callable[[Any, Scratch], None]


def dense_pieces(arrays: Sequence[FloatArray]) -> list[tuple[FloatArray, ...]]:
    """Views of arrays of one shape, cut alike into pieces of at most CHUNK elements."""
    if all(array.flags.c_contiguous for array in arrays):
        flat = [array.reshape(-1) for array in arrays]
        starts = range(0, flat[0].size, CHUNK)
        return [tuple(array[start : start + CHUNK] for array in flat) for start in starts]
    return [tuple(array[index] for array in arrays) for index in _boxes(arrays[0].shape)]


def _boxes(shape: tuple[int, ...]) -> Iterator[tuple[Any, ...]]:
    """Indices of boxes of at most CHUNK elements that tile a shape, whatever its strides."""
    if not shape:
        yield (...,)
        return
    inner = int(np.prod(shape[1:], dtype=np.int64))
    if inner > CHUNK:
        for row in range(shape[0]):
            for rest in _boxes(shape[1:]):
                yield (slice(row, row + 1), *rest)
        return
    rows = max(1, CHUNK // max(inner, 1))
    for start in range(0, shape[0], rows):
        yield (slice(start, start + rows), ...)


def row_pieces(rows: FloatArray, row_size: int) -> list[slice]:
    """Slices of a list of rows, so that each piece holds at most CHUNK elements."""
    count = max(1, CHUNK // max(row_size, 1))
    return [slice(start, start + count) for start in range(0, len(rows), count)]


def scratch_like(scratch: Scratch, piece: FloatArray) -> FloatArray:
    """The beginning of a scratch buffer in the shape of a piece."""
    return scratch[: piece.size].reshape(piece.shape)


def run(
    work: Work, pieces: Sequence[Any], *, dtype: Any, size: int, row: int, threads: int
) -> None:
    """Call `work(piece, scratch)` for each piece, each thread with a scratch buffer of its own.

    Args:
        work: may touch nothing but its piece and its scratch.
        pieces: in order; each thread takes one contiguous part.
        dtype: of the scratch buffer.
        size: number of elements in all; small work stays on the calling thread.
        row: elements of one row, in case a single one exceeds CHUNK.
        threads: at most this many.
    """

    def part(some: Sequence[Any]) -> None:
        scratch = np.empty(max(CHUNK, row), dtype=dtype)
        for piece in some:
            work(piece, scratch)

    workers = min(threads, len(pieces)) if size >= _THREADED_FROM else 1
    if workers <= 1:
        part(pieces)
        return
    bounds = [len(pieces) * i // workers for i in range(workers + 1)]
    with ThreadPoolExecutor(workers) as pool:
        spans = [pieces[bounds[i] : bounds[i + 1]] for i in range(workers)]
        for _ in pool.map(part, spans):
            pass

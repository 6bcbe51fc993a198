"""Where each row of a refined representation came from, so that optimizer state can follow it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .checks import FloatArray
from .errors import DtypeError, RangeError, ShapeError, message

FRESH = -1
"""The source of a row that did not exist before: its state starts at zero."""


@dataclass(frozen=True)
class RowMap:
    """Rows after pruning, cloning, splitting or adding, in terms of the rows before.

    Attributes:
        source: (N_after,) int64; the earlier row of each later row, or -1 for a fresh one. A row
            named twice was cloned, a row never named was removed.
        source_count: number of earlier rows, when known; then each array is checked against it.
    """

    source: NDArray[np.int64]
    source_count: int | None = None

    def __post_init__(self) -> None:
        source: object = self.source
        if not isinstance(source, np.ndarray) or source.dtype != np.int64:
            got = getattr(source, "dtype", type(source).__name__)
            raise DtypeError(message("RowMap", "source", "an int64 array", got))
        if source.ndim != 1:
            raise ShapeError(message("RowMap", "source", "shape (N,)", source.shape))
        if source.size and int(source.min()) < FRESH:
            raise RangeError(message("RowMap", "source", "-1 or a row", int(source.min())))
        if self.source_count is not None:
            self._require_rows(self.source_count)

    def apply(self, array: FloatArray, *, fill: float = 0.0) -> FloatArray:
        """A fresh array whose row i is row source[i] of `array`, or `fill` for a fresh row.

        Args:
            array: (N_before, ...).
            fill: value of fresh rows; 0 for moments.

        Raises:
            ShapeError: `array` has another number of rows than the map was made for.
            RangeError: the map names a row that `array` does not have.
        """
        if array.ndim == 0:
            raise ShapeError(message("RowMap.apply", "array", "shape (N, ...)", array.shape))
        if self.source_count is not None and array.shape[0] != self.source_count:
            expected = f"{self.source_count} rows"
            raise ShapeError(message("RowMap.apply", "array", expected, array.shape[0]))
        self._require_rows(array.shape[0])
        result = np.full((self.source.size, *array.shape[1:]), fill, dtype=array.dtype)
        old = self.source != FRESH
        result[old] = array[self.source[old]]
        return result

    def _require_rows(self, count: int) -> None:
        if self.source.size and int(self.source.max()) >= count:
            expected, got = f"rows below {count}", int(self.source.max())
            raise RangeError(message("RowMap", "source", expected, got))

"""Trilinear upsampling of cell-centered grids, for coarse-to-fine recovery.

Entry (i, j, k) is the value at the center of its voxel, so both grids cover the same box and their
borders coincide, while their first centers do not. A fine center i' lies at coarse index
(i' + 0.5) n / n' - 0.5; outside the first and last coarse center the border value is repeated.
"""

from __future__ import annotations

import numpy as np

from .checks import FloatArray, require_float_array, require_integer, require_not_empty
from .errors import RangeError, ShapeError, message


def upsample_trilinear(grid: FloatArray, shape: tuple[int, int, int]) -> FloatArray:
    """Resample a grid to a finer one over the same box.

    Exact for affine fields between the first and last coarse centers, and a weighted mean
    everywhere: it never overshoots, and a second moment stays non-negative. When it is applied to
    optimizer moments, remember that the gradient of a voxel shrinks with its volume.

    Args:
        grid: (X, Y, Z) or (X, Y, Z, C), float32 or float64.
        shape: the new (X', Y', Z'), no axis smaller than before.

    Returns:
        (X', Y', Z') or (X', Y', Z', C), a fresh C-contiguous array of the same dtype.

    Raises:
        ShapeError, DtypeError: not such a grid, or not three new sizes.
        RangeError: an axis would become coarser; point sampling would alias there.
    """
    name = "upsample_trilinear"
    result = require_float_array(name, "grid", grid)
    if grid.ndim not in (3, 4):
        raise ShapeError(message(name, "grid", "shape (X, Y, Z) or (X, Y, Z, C)", grid.shape))
    require_not_empty(name, "grid", grid)
    if not isinstance(shape, tuple) or len(shape) != 3:
        raise ShapeError(message(name, "shape", "a tuple of three sizes", shape))
    for axis, size in enumerate(shape):
        require_integer(name, f"shape[{axis}]", size, least=1)
        if size < grid.shape[axis]:
            expected = f"at least {grid.shape[axis]} along axis {axis}"
            raise RangeError(message(name, "shape", expected, size, "downsample by averaging"))
    for axis, size in enumerate(shape):
        result = _upsample_axis(result, axis, size)
    return np.array(result, order="C", copy=result is grid)


def _upsample_axis(grid: FloatArray, axis: int, size: int) -> FloatArray:
    old = grid.shape[axis]
    if old == size:
        return grid
    position = np.clip((np.arange(size) + 0.5) * (old / size) - 0.5, 0.0, old - 1.0)
    lower = np.minimum(position.astype(np.int64), max(old - 2, 0))
    upper = np.minimum(lower + 1, old - 1)
    extent = [1] * grid.ndim
    extent[axis] = size
    fraction = (position - lower).astype(grid.dtype).reshape(extent)
    low = np.take(grid, lower, axis=axis)
    high = np.take(grid, upper, axis=axis)
    low *= 1.0 - fraction
    high *= fraction
    low += high
    return np.asarray(low)

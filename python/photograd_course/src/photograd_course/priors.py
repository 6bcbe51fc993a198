"""What is believed before any photograph is seen: fields are smooth, and mostly empty.

Total variation compares each voxel with its next neighbor along +X, +Y and +Z (forward
differences in voxel units, none beyond the last voxel); sparsity pulls each density to zero. All
are means over the grid, so that a weight survives a change of resolution in scale, and all sums
run in float64. The backward functions ADD into `d_grid` when they are given one.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .checks import FloatArray, require_float_array, require_like, require_not_empty, require_number
from .errors import ShapeError, message
from .portable_math import log1p

# Elements of one slab of X planes: a few slabs fit into the cache together.
_SLAB = 65_536


def total_variation_squared(grid: FloatArray) -> float:
    """Isotropic squared variation: sum of squared forward differences / N.

    (1/N) sum over voxels and channels of dx^2 + dy^2 + dz^2, N the number of elements of the grid.
    Quadratic: it blurs edges, and its gradient is a discrete Laplacian.

    Args:
        grid: (X, Y, Z) or (X, Y, Z, C), float32 or float64.

    Raises:
        DtypeError, ShapeError: not such a grid.
    """
    _check_grid("total_variation_squared", grid)
    total = 0.0
    for start, stop in _slabs(grid):
        for d in _differences(grid, start, stop):
            np.multiply(d, d, out=d)
            total += float(np.sum(d, dtype=np.float64))
    return total / grid.size


def total_variation_squared_backward(
    grid: FloatArray, d_loss: float = 1.0, d_grid: FloatArray | None = None
) -> FloatArray:
    """Add d_loss * 2/N * (difference to the one before - difference to the next), per axis.

    Args:
        grid: (X, Y, Z) or (X, Y, Z, C).
        d_loss: cotangent of the loss, times its weight.
        d_grid: buffer of the shape and dtype of `grid` to add into; None for fresh zeros.

    Returns:
        `d_grid`.
    """
    name = "total_variation_squared_backward"
    out, share = _buffer(name, grid, d_loss, d_grid)
    for start, stop in _slabs(grid):
        differences = _differences(grid, start, stop)
        for d in differences:
            np.multiply(d, 2.0 * share, out=d)
        _scatter(out, start, stop, differences)
    return out


def total_variation_smoothed(grid: FloatArray, *, epsilon: float) -> float:
    """Isotropic smoothed-L1 variation [Rudin1992]: mean of sqrt(dx^2 + dy^2 + dz^2 + e^2) - e.

    The root couples the three axes and not the channels. Far above e it counts the jump of an edge
    and not its square, so edges stay sharp; far below it is the squared variation over 2 e.
    [FridovichKeil2022] regularise their grids with such a root.

    Args:
        grid: (X, Y, Z) or (X, Y, Z, C).
        epsilon: e > 0, in units of the grid.

    Raises:
        DtypeError, ShapeError, RangeError: not such a grid, or epsilon not positive.
    """
    _check_grid("total_variation_smoothed", grid)
    name = "total_variation_smoothed"
    epsilon = require_number(name, "epsilon", epsilon, least=0.0, open_ends=True)
    total = 0.0
    for start, stop in _slabs(grid):
        root = _root(grid[start:stop], _differences(grid, start, stop), epsilon)
        np.subtract(root, epsilon, out=root)
        total += float(np.sum(root, dtype=np.float64))
    return total / grid.size


def total_variation_smoothed_backward(
    grid: FloatArray, d_loss: float = 1.0, d_grid: FloatArray | None = None, *, epsilon: float
) -> FloatArray:
    """Add d_loss/N * d / root at the far end of each difference d, and subtract it at the near.

    The root is that of the voxel where the difference starts. Arguments as for
    `total_variation_squared_backward`.
    """
    name = "total_variation_smoothed_backward"
    out, share = _buffer(name, grid, d_loss, d_grid)
    epsilon = require_number(name, "epsilon", epsilon, least=0.0, open_ends=True)
    for start, stop in _slabs(grid):
        differences = dx, dy, dz = _differences(grid, start, stop)
        root = _root(grid[start:stop], differences, epsilon)
        np.divide(share, root, out=root)
        dx *= root[: len(dx)]
        dy *= root[:, :-1]
        dz *= root[:, :, :-1]
        _scatter(out, start, stop, differences)
    return out


def sparsity_cauchy(density: FloatArray, *, scale: float) -> float:
    """Cauchy prior: mean of log(1 + (density / scale)^2), after [Hedman2021].

    Grows ever more slowly: small densities are pushed to zero, large ones are left in peace.

    Args:
        density: any shape, float32 or float64.
        scale: density at which the push is strongest, > 0, in units of the density.

    Raises:
        DtypeError, ShapeError, RangeError: not an array with elements, or scale not positive.
    """
    _check_density("sparsity_cauchy", density)
    scale = require_number("sparsity_cauchy", "scale", scale, least=0.0, open_ends=True)
    ratio = density / scale
    np.multiply(ratio, ratio, out=ratio)
    return float(np.mean(log1p(ratio), dtype=np.float64))


def sparsity_cauchy_backward(
    density: FloatArray, d_loss: float = 1.0, d_density: FloatArray | None = None, *, scale: float
) -> FloatArray:
    """Add d_loss/N * 2 density / (scale^2 + density^2) into `d_density` (fresh if None)."""
    name = "sparsity_cauchy_backward"
    _check_density(name, density)
    scale = require_number(name, "scale", scale, least=0.0, open_ends=True)
    out, share = _buffer(name, density, d_loss, d_density, argument="d_density")
    slope = np.asarray(density * density)
    slope += scale * scale
    np.divide(density, slope, out=slope)
    slope *= 2.0 * share
    out += slope
    return out


def sparsity_l1(density: FloatArray) -> float:
    """L1 prior: mean of |density|; the same push towards zero at any size."""
    _check_density("sparsity_l1", density)
    return float(np.mean(np.abs(density), dtype=np.float64))


def sparsity_l1_backward(
    density: FloatArray, d_loss: float = 1.0, d_density: FloatArray | None = None
) -> FloatArray:
    """Add d_loss/N * sign(density) into `d_density` (fresh if None); 0 at zero."""
    _check_density("sparsity_l1_backward", density)
    out, share = _buffer("sparsity_l1_backward", density, d_loss, d_density, argument="d_density")
    slope = np.asarray(np.sign(density))
    slope *= share
    out += slope
    return out


def _slabs(grid: FloatArray) -> Iterator[tuple[int, int]]:
    """Ranges of X planes of about _SLAB elements."""
    planes = max(1, _SLAB // max(1, grid[0].size))
    for start in range(0, len(grid), planes):
        yield start, min(start + planes, len(grid))


def _differences(
    grid: FloatArray, start: int, stop: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Fresh forward differences that start in planes start .. stop - 1, along X, Y and Z."""
    last = min(stop, len(grid) - 1)
    here = grid[start:stop]
    return (
        np.subtract(grid[start + 1 : last + 1], grid[start:last]),
        np.subtract(here[:, 1:], here[:, :-1]),
        np.subtract(here[:, :, 1:], here[:, :, :-1]),
    )


def _scatter(
    out: FloatArray, start: int, stop: int, parts: tuple[FloatArray, FloatArray, FloatArray]
) -> None:
    """Add each part at the far end of its difference and subtract it at the near end."""
    dx, dy, dz = parts
    here = out[start:stop]
    out[start + 1 : start + 1 + len(dx)] += dx
    out[start : start + len(dx)] -= dx
    here[:, 1:] += dy
    here[:, :-1] -= dy
    here[:, :, 1:] += dz
    here[:, :, :-1] -= dz


def _root(
    here: FloatArray, differences: tuple[FloatArray, FloatArray, FloatArray], epsilon: float
) -> FloatArray:
    """sqrt(dx^2 + dy^2 + dz^2 + epsilon^2) for each voxel of a slab."""
    dx, dy, dz = differences
    root = np.full(here.shape, epsilon * epsilon, dtype=here.dtype)
    root[: len(dx)] += dx * dx
    root[:, :-1] += dy * dy
    root[:, :, :-1] += dz * dz
    return np.asarray(np.sqrt(root, out=root))


def _buffer(
    function: str,
    grid: FloatArray,
    d_loss: float,
    d_grid: FloatArray | None,
    *,
    argument: str = "d_grid",
) -> tuple[FloatArray, float]:
    """The buffer to add into, and d_loss / N."""
    if argument == "d_grid":
        _check_grid(function, grid)
    share = require_number(function, "d_loss", d_loss) / grid.size
    if d_grid is None:
        return np.zeros(grid.shape, dtype=grid.dtype), share
    like = "grid" if argument == "d_grid" else "density"
    return require_like(function, argument, d_grid, like, grid), share


def _check_grid(function: str, grid: FloatArray) -> None:
    require_float_array(function, "grid", grid)
    if grid.ndim not in (3, 4):
        expected = "shape (X, Y, Z) or (X, Y, Z, C)"
        raise ShapeError(message(function, "grid", expected, grid.shape))
    require_not_empty(function, "grid", grid)


def _check_density(function: str, density: FloatArray) -> None:
    require_float_array(function, "density", density)
    require_not_empty(function, "density", density)

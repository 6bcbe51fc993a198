"""Light from all around, averaged with a weight that depends on the angle alone.

    out(n) = sum_w K(1 - <n,w>) L(w) dw / sum_w K(1 - <n,w>) dw

Directions w are the cells of a picture of all directions, dw their solid angles. In the rows of two
heights theta and theta' the angle depends on the turn between the cells alone,

    1 - <n,w> = 2 sin^2((theta - theta') / 2) + 2 sin theta sin theta' sin^2((phi - phi') / 2),

so that along a row the sum is a circular correlation: a product of Fourier transforms. Every cell
is counted for every n, and none is missed, however small and bright. A light of one colour comes
out as that colour, whatever K, since the weights are divided by their own sum.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from photograd.errors import RangeError, message
from photograd.lights.base import Light
from photograd.lights.direction_map import DirectionMap, cell_directions
from photograd.lights.environment import EnvironmentMap
from photograd.lights.registered import ConstantLight, SkyLight
from photograd.types import Array

Kernel = Callable[[Array], Array]
"""Weights of 1 - cos(angle), an array of numbers from 0 to 2."""
OnRow = Callable[[int, int], None]
"""Called with the number of rows that are done, and of all."""
AROUND = (EnvironmentMap, ConstantLight, SkyLight)
"""Lights that come from everywhere and have no edges; a sun is painted on a map."""
LEAST_ROWS = 128
"""Fewer cells than this are too few for any light."""
MOST_ROWS = 1 << 13


def zonal_mean(
    light: Light, kernel: Kernel, width: float, rows: int, on_row: OnRow | None = None
) -> DirectionMap:
    """Means (rows, 2 rows, 3) of the radiance around every direction.

    Args:
        light: from all around, one of `AROUND`. Cells follow the texels of an `EnvironmentMap`.
        kernel: the weight.
        width: radians within which it changes by no more than a small factor; cells are no wider.
        rows: of the result.
        on_row: progress.

    Raises:
        RangeError: another light, no rows or too many, or a width that asks for more than
            `MOST_ROWS` rows of cells.
    """
    if not isinstance(light, AROUND):
        expected, got = f"one of {', '.join(c.__name__ for c in AROUND)}", type(light).__name__
        raise RangeError(message("zonal_mean", "light", expected, got))
    if not 2 <= rows <= MOST_ROWS:
        raise RangeError(message("zonal_mean", "rows", f"2 to {MOST_ROWS}", rows))
    turn = light.world_from_map if isinstance(light, EnvironmentMap) else np.eye(3)
    texels = light.texels.shape[0] if isinstance(light, EnvironmentMap) else LEAST_ROWS
    count = _source_rows(texels, width, rows)
    if count > MOST_ROWS:
        expected, remedy = f"at most {MOST_ROWS} rows of cells", "take a wider lobe"
        raise RangeError(message("zonal_mean", "width", expected, count, remedy))
    w = cell_directions(count).reshape(-1, 3) @ turn.T
    radiance = light.L(np.zeros_like(w), w).reshape(count, 2 * count, 3)
    spectrum = np.fft.rfft(radiance, axis=1)
    found = np.empty((rows, 2 * rows, 3))
    for row in range(rows):
        found[row] = _row(spectrum, kernel, (row + 0.5) / rows * np.pi, 2 * rows)
        if on_row is not None:
            on_row(row + 1, rows)
    return DirectionMap(found, turn)


def _source_rows(texels: int, width: float, rows: int) -> int:
    """Rows of cells: a multiple of the result's and, unless there are twice as many, of the texels.

    Between texels radiance is a tent; cells that are wider than half of one must stand in the
    middles, or the sum over a bright texel would depend on where it is.
    """
    least = max(texels, LEAST_ROWS, int(np.ceil(np.pi / width)))
    if texels % rows == 0:
        return texels * -(-least // texels)
    return rows * -(-max(least, 2 * texels) // rows)


def _row(spectrum: Array, kernel: Kernel, theta: float, columns: int) -> Array:
    """(columns, 3): the means in the row at the height theta."""
    count = len(spectrum)
    step = 2 * count // columns
    heights = (np.arange(count) + 0.5) / count * np.pi
    # From the middle of a column of the result to the middles of the columns of cells.
    shift = 0.5 if step % 2 == 0 else 0.0
    turns = (np.arange(2 * count) + shift) * np.pi / count
    drop = 2 * np.sin(0.5 * (theta - heights))[:, None] ** 2
    drop = drop + 2 * np.sin(theta) * np.sin(heights)[:, None] * np.sin(0.5 * turns) ** 2
    weights = kernel(drop) * np.sin(heights)[:, None]  # solid angles but for a factor
    transformed = np.conj(np.fft.rfft(weights, axis=1))
    sums = np.fft.irfft(np.einsum("jf,jfc->fc", transformed, spectrum), 2 * count, axis=0)
    picked = sums[step // 2 :: step]
    return np.asarray(np.maximum(picked, 0) / weights.sum())

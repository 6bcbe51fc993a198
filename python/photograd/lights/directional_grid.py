"""A table over directions: the plain alternative to spherical harmonics, and what each costs.

A voxel whose colour depends on the direction it is seen from can hold a small picture of the
sphere: T rows of the angle theta from +Z, 2 T columns of the azimuth phi. A value sits in the
middle of its cell and lookups blend the four around a direction; phi wraps around, and beyond the
outermost row the blend goes on across the pole, where a half turn of phi away the same row comes
again.

    value(d) = sum_j w_j(d) table_j       dL/dtable_j = w_j dL/dvalue

`best_table` and `best_harmonics` give either representation its least error for the same function,
in the mean over the sphere, so that `grid_bytes` can be compared at equal error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from photograd import sh
from photograd.errors import RangeError, ShapeError, message
from photograd.lights.probes import sphere_quadrature
from photograd.types import Array


def table_numbers(rows: int) -> int:
    """Numbers a channel of a table with this many rows: 2 rows^2.

    Raises:
        RangeError: rows below 1.
    """
    if rows < 1:
        raise RangeError(message("table_numbers", "rows", "at least 1", rows))
    return 2 * rows * rows


def grid_bytes(
    shape: Sequence[int], numbers: int, *, channels: int = 3, bytes_per_number: int = 4
) -> int:
    """Bytes of a grid whose voxels hold a density and a function of direction.

    Args:
        shape: (X, Y, Z) voxels.
        numbers: a channel and voxel: `table_numbers(rows)`, or `sh.count(degree)`; 1 where colour
            does not depend on direction.
        channels: of the colour.
        bytes_per_number: 4 for float32.

    Raises:
        RangeError: anything below 1.
        ShapeError: not three axes.
    """
    if len(shape) != 3:
        raise ShapeError(message("grid_bytes", "shape", "(X, Y, Z)", tuple(shape)))
    if min(*shape, numbers, channels, bytes_per_number) < 1:
        got = (*shape, numbers, channels, bytes_per_number)
        raise RangeError(message("grid_bytes", "sizes", "all at least 1", got))
    voxels = int(np.prod([int(n) for n in shape], dtype=object))
    return voxels * (1 + channels * numbers) * bytes_per_number


def blend(directions: Array, rows: int) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Entries (N, 4) of a flat table, row by row, and their weights (N, 4).

    Args:
        directions: (N, 3) unit vectors.
        rows: of the table, T; it has 2 T columns.
    """
    table_numbers(rows)
    columns = 2 * rows
    theta = np.arccos(np.clip(directions[:, 2], -1, 1))
    phi = np.arctan2(directions[:, 1], directions[:, 0])
    r, c = theta * rows / np.pi - 0.5, phi * columns / (2 * np.pi) - 0.5
    row, column = np.floor(r).astype(np.intp), np.floor(c).astype(np.intp)
    entries, weights = [], []
    for down, right in np.ndindex(2, 2):
        across = (row + down < 0) | (
            row + down >= rows
        )  # over a pole: the same row, half a turn on
        at_row = np.clip(row + down, 0, rows - 1)
        at_column = (column + right + np.where(across, rows, 0)) % columns
        entries.append(at_row * columns + at_column)
        along = (r - row if down else 1 - (r - row)), (c - column if right else 1 - (c - column))
        weights.append(along[0] * along[1])
    return np.stack(entries, axis=1), np.stack(weights, axis=1)


def evaluate(table: Array, directions: Array) -> Array:
    """Values (N, C) of a table (T, 2 T, C) in directions (N, 3)."""
    entries, weights = blend(directions, _rows_of("evaluate", table))
    flat = table.reshape(-1, table.shape[2])
    return np.asarray(np.einsum("nj,njc->nc", weights.astype(table.dtype), flat[entries]))


def evaluate_backward(table: Array, directions: Array, d_values: Array) -> Array:
    """dL/dtable (T, 2 T, C) of dL/dvalues (N, C). Directions are held fixed."""
    entries, weights = blend(directions, _rows_of("evaluate_backward", table))
    d_table = np.zeros_like(table)
    flat = d_table.reshape(-1, table.shape[2])
    np.add.at(flat, entries, weights.astype(table.dtype)[..., None] * d_values[:, None])
    return d_table


Functions = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""Values (N, F) of F functions in unit directions (N, 3)."""


def best_harmonics(functions: Functions, degree: int, *, order: int = 48) -> float:
    """Error of the best harmonics: root of the mean square over the sphere and all functions.

    Args:
        functions: what to represent, each on its own; turned copies of one function average out
            how it happens to lie.
        degree: 0 to 4.
        order: of the quadrature, `sphere_quadrature`.

    Returns:
        The error in shares of the functions' own root mean square.
    """
    directions, weights = sphere_quadrature(order)
    values = functions(directions)
    found = sh.basis(directions, degree) @ sh.project(directions, values, weights, degree)
    return _relative(weights, found, values)


def best_table(functions: Functions, rows: int, *, order: int = 48) -> float:
    """The same error of tables whose entries are the least-squares fit, not samples."""
    directions, weights = sphere_quadrature(order)
    values = functions(directions)
    entries, shares = blend(directions, rows)
    matrix = np.zeros((len(directions), table_numbers(rows)))
    np.add.at(matrix, (np.arange(len(directions))[:, None], entries), shares)
    root = np.sqrt(weights)[:, None]
    tables = np.linalg.lstsq(root * matrix, root * values, rcond=None)[0]
    return _relative(weights, matrix @ tables, values)


def rows_for(functions: Functions, error: float, *, most: int = 12, order: int = 48) -> int | None:
    """Rows of the smallest table that is at most so wrong; None if `most` rows are not enough."""
    for rows in range(1, most + 1):
        if best_table(functions, rows, order=order) <= error:
            return rows
    return None


def _relative(weights: Array, found: Array, values: Array) -> float:
    """Root of the weighted mean square of the difference, in shares of that of `values`."""
    square = (weights @ (found - values) ** 2).sum() / (weights @ values**2).sum()
    return float(np.sqrt(square))


def _rows_of(name: str, table: Array) -> int:
    if table.ndim != 3 or table.shape[1] != 2 * table.shape[0]:
        raise ShapeError(message(name, "table", "shape (T, 2 T, C)", f"shape {table.shape}"))
    return int(table.shape[0])

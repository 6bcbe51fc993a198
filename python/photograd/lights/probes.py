"""Light probes: what light arrives at the points of a grid, nine numbers a color channel each.

A probe holds the coefficients of the radiance that arrives at it (photograd.sh). Between probes
coefficients are blended trilinearly, and the irradiance on a surface of normal n follows from them
in closed form [Ramamoorthi2001]:

    c(p)   = sum_i w_i(p) c_i            the eight probes around p, weights that add up to 1
    E(p,n) = sum_k A_k c_k(p) Y_k(n)     A: Lambert's cosine lobe, one number a degree

    dL/dc_ik = w_i A_k Y_k(n) dL/dE      dL/dn = sum_k A_k <c_k, dL/dE> dY_k/dn

Positions are held fixed: the blend has a kink at every probe. Nothing here knows of walls, so light
leaks through those that are thinner than the distance of probes. A bright, small light makes the
truncated series swing below zero on the far side; that is returned as it is.

Plain NumPy: a scene has some thousands of probes, and the work is one gather and one product.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photograd import sh
from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.types import Array


class ProbeGrid:
    """Probes in the middle of X x Y x Z equal cells that fill a box.

    Attributes:
        coefficients: (X, Y, Z, K, C) float32 or float64; a parameter, change it freely. The
            radiance that arrives from direction d is sum_k Y_k(d) coefficients[..., k, :].
        box: (2, 3) lowest and highest corner in the world, meters. Beyond the outermost probes
            their values continue.
    """

    def __init__(self, coefficients: Array, box: ArrayLike) -> None:
        """Keep both arrays.

        Raises:
            ShapeError, DtypeError: other shapes or types.
            RangeError: K is no count of coefficients, C is neither 1 nor 3, an empty box.
        """
        call = Arguments("ProbeGrid")
        shape = ("X", "Y", "Z", "K", "C")
        coefficients = call.array("coefficients", coefficients, shape, finite=False, min_length=1)
        corners = Arguments("ProbeGrid", np.float64).box("box", box)
        self.degree = sh.degree_of(coefficients.shape[3])
        if coefficients.shape[4] not in (1, 3):
            got = f"{coefficients.shape[4]}"
            raise RangeError(message("ProbeGrid", "coefficients", "1 or 3 channels", got))
        self.coefficients = coefficients
        self.box = corners

    @property
    def positions(self) -> NDArray[np.float64]:
        """(X, Y, Z, 3) where the probes are, in the world."""
        shape = self.coefficients.shape[:3]
        x, y, z = ((np.arange(n) + 0.5) / n for n in shape)
        cell = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1)
        return np.asarray(self.box[0] + cell * (self.box[1] - self.box[0]), np.float64)

    def interpolate(self, points: Array) -> Array:
        """Coefficients (N, K, C) at points (N, 3) in the world."""
        return self._interpolated(self._call("interpolate", points=points))

    def interpolate_backward(self, points: Array, d_values: Array) -> Array:
        """dL/dcoefficients (X, Y, Z, K, C) of dL/dvalues (N, K, C)."""
        given = self._call("interpolate_backward", points=points, d_values=d_values)
        return self._interpolated_backward(given)

    def irradiance(self, points: Array, normals: Array) -> Array:
        """Irradiance (N, C) in W/m^2 on surfaces at points (N, 3) with unit normals (N, 3)."""
        given = self._call("irradiance", points=points, normals=normals)
        return sh.evaluate(self._lobe() * self._interpolated(given), given["normals"])

    def irradiance_backward(
        self, points: Array, normals: Array, d_irradiance: Array
    ) -> tuple[Array, Array]:
        """dL/dcoefficients (X, Y, Z, K, C) and dL/dnormals (N, 3) of dL/dirradiance (N, C).

        The derivative with respect to a normal is that of the polynomials, before normalization.
        """
        given = self._call(
            "irradiance_backward", points=points, normals=normals, d_irradiance=d_irradiance
        )
        d_blended, d_normals = sh.evaluate_backward(
            self._lobe() * self._interpolated(given), given["normals"], given["d_irradiance"]
        )
        given["d_values"] = self._lobe() * d_blended
        return self._interpolated_backward(given), d_normals

    def _call(self, function: str, **arrays: Array) -> dict[str, Array]:
        """The arrays of a call, converted: points to float64, others to the dtype of the grid."""
        *_, k, c = self.coefficients.shape
        shapes = {"d_values": ("N", k, c), "d_irradiance": ("N", c)}
        call = Arguments(f"ProbeGrid.{function}", self.coefficients.dtype)
        return {
            name: call.array(
                name,
                array,
                shapes.get(name, ("N", 3)),
                dtype=np.float64 if name == "points" else None,
            )
            for name, array in arrays.items()
        }

    def _interpolated(self, given: dict[str, Array]) -> Array:
        rows, weights = self._corners(given["points"])
        flat = self.coefficients.reshape(-1, *self.coefficients.shape[3:])
        return np.asarray(np.einsum("ni,nikc->nkc", weights, flat[rows]))

    def _interpolated_backward(self, given: dict[str, Array]) -> Array:
        rows, weights = self._corners(given["points"])
        d_coefficients = np.zeros_like(self.coefficients)
        flat = d_coefficients.reshape(-1, *self.coefficients.shape[3:])
        np.add.at(flat, rows, weights[..., None, None] * given["d_values"][:, None])
        return d_coefficients

    def _lobe(self) -> Array:
        """(K, 1) the cosine lobe, degree by degree."""
        orders = 2 * np.arange(self.degree + 1) + 1
        lobe = np.repeat(sh.COSINE_LOBE[: self.degree + 1], orders)
        return lobe.astype(self.coefficients.dtype)[:, None]

    def _corners(self, p: Array) -> tuple[NDArray[np.intp], Array]:
        """Rows (N, 8) of the probes around each point, and their weights (N, 8)."""
        shape = np.array(self.coefficients.shape[:3])
        q = (p - self.box[0]) / (self.box[1] - self.box[0]) * shape - 0.5
        q = np.clip(q, 0, shape - 1)
        low = np.minimum(q.astype(np.intp), np.maximum(shape - 2, 0))
        part = q - low
        rows = np.empty((len(p), 8), np.intp)
        weights = np.empty((len(p), 8), self.coefficients.dtype)
        for number, corner in enumerate(np.ndindex(2, 2, 2)):
            at = np.minimum(low + corner, shape - 1)
            rows[:, number] = (at[:, 0] * shape[1] + at[:, 1]) * shape[2] + at[:, 2]
            weights[:, number] = np.where(corner, part, 1 - part).prod(axis=1)
        return rows, weights


def bake(
    radiance: Callable[[Array, Array], Array],
    shape: tuple[int, int, int],
    box: ArrayLike,
    *,
    degree: int = 2,
    order: int = 16,
) -> ProbeGrid:
    """Project the light that arrives at each probe.

    Args:
        radiance: of a point (3,) and unit directions (M, 3), the radiance (M, C) that arrives there
            from each, such as what a ray that leaves in that direction sees.
        shape: number of probes along x, y, z.
        box: (2, 3), as in ProbeGrid.
        degree: of the coefficients; 2 is what irradiance needs.
        order: of `sphere_quadrature`; sharp lights need more.

    Raises:
        RangeError: as ProbeGrid.
        ShapeError: `radiance` returned something else.
    """
    directions, weights = sphere_quadrature(order)
    grid = ProbeGrid(np.zeros((*shape, sh.count(degree), 3)), box)
    Y = weights[:, None] * sh.basis(directions, degree)
    found = []
    call = Arguments("bake", np.float64)
    for position in grid.positions.reshape(-1, 3):
        values = call.array("radiance", radiance(position, directions), (len(directions), "C"))
        found.append(Y.T @ values)
    return ProbeGrid(np.stack(found).reshape(*shape, *found[0].shape), box)


def sphere_quadrature(order: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit directions (2 order^2, 3) and their solid angles, exact to degree 2 order - 1.

    Gauss's points in the height z, equal steps around it.
    """
    z, of_ring = np.polynomial.legendre.leggauss(order)
    phi = np.pi * np.arange(2 * order) / order
    r = np.sqrt(1 - z**2)[:, None]
    x, y = r * np.cos(phi), r * np.sin(phi)
    directions = np.stack([x, y, np.broadcast_to(z[:, None], x.shape)], axis=-1).reshape(-1, 3)
    return directions, np.repeat(of_ring * np.pi / order, 2 * order)


# A table over directions: the plain alternative to spherical harmonics, and what each costs.


def table_numbers(rows: int) -> int:
    """Numbers a channel of a table with this many rows: 2 rows^2.

    Raises:
        RangeError: rows below 1.
    """
    return 2 * Arguments("table_numbers").integer("rows", rows, low=1) ** 2


def grid_bytes(
    shape: Sequence[int], numbers: int, *, channels: int = 3, bytes_per_number: int = 4
) -> int:
    """Bytes of a grid whose voxels hold a density and a function of direction.

    Args:
        shape: (X, Y, Z) voxels.
        numbers: a channel and voxel: `table_numbers(rows)`, or `sh.count(degree)`; 1 where color
            does not depend on direction.
        channels: of the color.
        bytes_per_number: 4 for float32.

    Raises:
        RangeError: anything below 1.
        ShapeError: not three axes.
    """
    call = Arguments("grid_bytes")
    call.array("shape", shape, (3,), dtype=np.int64, low=1)
    sizes = {"numbers": numbers, "channels": channels, "bytes_per_number": bytes_per_number}
    for name, size in sizes.items():
        call.integer(name, size, low=1)
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
    table = Arguments("evaluate").array("table", table, ("T", "2 T", "C"), finite=False)
    entries, weights = blend(directions, len(table))
    flat = table.reshape(-1, table.shape[2])
    return np.asarray(np.einsum("nj,njc->nc", weights.astype(table.dtype), flat[entries]))


def evaluate_backward(table: Array, directions: Array, d_values: Array) -> Array:
    """dL/dtable (T, 2 T, C) of dL/dvalues (N, C). Directions are held fixed."""
    table = Arguments("evaluate_backward").array("table", table, ("T", "2 T", "C"), finite=False)
    entries, weights = blend(directions, len(table))
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

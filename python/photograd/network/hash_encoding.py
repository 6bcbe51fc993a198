"""Multiresolution hash encoding: features on grids of many resolutions, in tables of one size."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import Array


class Level(NamedTuple):
    """A level of a hash encoding.

    Attributes:
        resolution: cells along an axis; there are resolution + 1 corners.
        first: its first row of the table.
        rows: of the table.
        dense: whether each corner has a row of its own; else a hash chooses the row.
    """

    resolution: int
    first: int
    rows: int
    dense: bool


@typed_call
class HashEncoding:
    """Features of points in the unit square or cube [Mueller2022].

    Each level interpolates rows of its table between the corners of a grid; a level whose corners
    do not fit into the table shares rows among them. Features of all levels stand side by side.
    Without the interpolation features would be piecewise constant, and their derivative with
    respect to the point zero.

    Attributes:
        levels: coarse to fine.
        features: numbers in a row.
        smoothstep: whether interpolation has no kinks.
        rows: of the table of all levels.
        settings: the core's form of the levels.
    """

    def __init__(
        self,
        resolutions: Sequence[int],
        *,
        dimensions: int = 3,
        log2_rows: int = 19,
        features: int = 2,
        smoothstep: bool = False,
    ) -> None:
        """State the levels; `geometric` makes resolutions of a geometric sequence.

        Args:
            resolutions: cells along an axis of 1 to 32 levels, 1 to 2^20 each.
            dimensions: 2 or 3.
            log2_rows: of the largest table of a level, 1 to 24.
            features: in a row, 1 to 8.
            smoothstep: interpolates by 3 f^2 - 2 f^3, whose derivative has no jumps.

        Raises:
            RangeError: anything else.
        """
        self.settings = Arguments("HashEncoding").run(
            _core.HashSettings, dimensions, list(resolutions), log2_rows, features, smoothstep
        )
        self.dimensions, self.features, self.smoothstep = dimensions, features, smoothstep
        self.levels = tuple(Level(*level) for level in self.settings.levels)
        self.rows: int = self.settings.rows

    @classmethod
    def geometric(
        cls,
        *,
        levels: int = 16,
        coarsest: int = 16,
        finest: int = 2048,
        dimensions: int = 3,
        log2_rows: int = 19,
        features: int = 2,
        smoothstep: bool = False,
    ) -> HashEncoding:
        """Resolutions floor(coarsest b^l), b = (finest / coarsest)^(1 / (levels - 1)) [Eqs. 2, 3].

        Args:
            levels: 1 to 32.
            coarsest: cells along an axis of the first level.
            finest: cells along an axis of the last.
            dimensions: 2 or 3.
            log2_rows: of the largest table of a level.
            features: in a row.
            smoothstep: as in the constructor.

        Raises:
            RangeError: no levels, or finest below coarsest, or what the constructor refuses.
        """
        call = Arguments("HashEncoding.geometric")
        call.integer("levels", levels, low=1)
        call.integer("coarsest", coarsest, low=1)
        if finest < coarsest:
            expected = f"at least coarsest, {coarsest}"
            raise RangeError(message("HashEncoding.geometric", "finest", expected, finest))
        growth = (finest / coarsest) ** (1.0 / max(levels - 1, 1))
        # A hair more, so that the last level has all of `finest` in spite of rounding.
        resolutions = [int(coarsest * growth**level * (1.0 + 1e-12)) for level in range(levels)]
        return cls(
            resolutions,
            dimensions=dimensions,
            log2_rows=log2_rows,
            features=features,
            smoothstep=smoothstep,
        )

    @property
    def outputs(self) -> int:
        """Numbers that a point becomes."""
        return len(self.levels) * self.features

    def initial(self, *, seed: int, dtype: npt.DTypeLike = np.float32) -> Array:
        """A random table (rows, features), uniform in +- 1e-4 [Mueller2022, Sec. 4].

        Args:
            seed: of the random numbers.
            dtype: float32 or float64.
        """
        index = np.arange(self.rows * self.features)
        u = uniform(seed, step=0, pixel=index, sample=0, dimension=0)
        return ((2.0 * u - 1.0) * 1e-4).reshape(self.rows, self.features).astype(dtype)

    def encode(self, table: Array, points: Array) -> Array:
        """Features of points.

        Args:
            table: (rows, features), float32 or float64.
            points: (N, dimensions) in [0, 1], of the same dtype; what lies outside takes the
                features of the nearest point inside.

        Returns:
            (N, outputs): the features of level 0, then of level 1, ...

        Raises:
            ShapeError, DtypeError: arrays other than these.
            RangeError: points that are not finite.
        """
        call = Arguments("HashEncoding.encode")
        table, points = self._arrays(call, table, points)
        features = np.empty((len(points), self.outputs), points.dtype)
        call.run(_core.hash_encode, self.settings, table, points, features)
        return features

    def encode_backward(
        self,
        table: Array,
        points: Array,
        d_features: Array,
        *,
        out: Array | None = None,
        d_points: bool = False,
    ) -> tuple[Array, Array | None]:
        """Derivatives of a loss with respect to the table and the points.

        Points that share a row add up in it. With respect to a point the derivative jumps at the
        faces of cells, unless the interpolation is `smoothstep`.

        Args:
            table: (rows, features), float32 or float64.
            points: (N, dimensions), of the same dtype.
            d_features: (N, outputs), derivatives of the loss with respect to the features.
            out: (rows, features), is added to; by default zeros.
            d_points: whether derivatives with respect to the points are wanted.

        Returns:
            d_table (rows, features), `out` where it is given, and d_points (N, dimensions) or None.

        Raises:
            ShapeError, DtypeError: arrays other than these.
            RangeError: points that are not finite.
        """
        call = Arguments("HashEncoding.encode_backward")
        table, points = self._arrays(call, table, points)
        d_features = call.array("d_features", d_features, ("N", self.outputs), finite=False)
        d_table = np.zeros_like(table) if out is None else out
        d_p = np.zeros_like(points) if d_points else None
        arrays = (table, points, d_features, d_table, d_p)
        call.run(_core.hash_encode_backward, self.settings, *arrays)
        return d_table, d_p

    def _arrays(self, call: Arguments, table: Array, points: Array) -> tuple[Array, Array]:
        table = call.array("table", table, (self.rows, self.features), finite=False)
        return table, call.array("points", points, ("N", self.dimensions))

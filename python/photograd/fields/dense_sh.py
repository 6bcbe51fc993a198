"""A dense grid of density and spherical harmonics: a sparse grid of which nothing is missing.

It is there to be compared with. Beside `dense_grid` it shows what harmonics are worth, and beside
`sparse_sh`, of which it is the unpruned form, what leaving voxels out saves. The mathematics, and
the code, are those of the sparse grid.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Self

import numpy as np
from photograd_course.random import uniform

from photograd._fit_options import FitOptions
from photograd.errors import RangeError, message
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import MarchPolicy
from photograd.fields.sparse_sh import SparseSh
from photograd.fields.voxel_field import voxels_in
from photograd.representation import COPIES, FitInProgress, register
from photograd.types import Array


@register
class DenseSh(SparseSh):
    """A radiance field on all voxels of an X x Y x Z grid (trilinear in between).

    params["density"] (X Y Z,) and params["sh"] (X Y Z, K, 3) as in `SparseSh`, in the order of its
    rows: `active.voxels` (X Y Z, 3) says where each belongs. Within half a voxel of the box's faces
    the field fades to `background_density` without color.
    """

    name: ClassVar[str] = "dense_sh"
    fit_defaults: ClassVar[Mapping[str, Any]] = {}
    fit_options: ClassVar[frozenset[str]] = frozenset({"degree"})

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """9 x 6 x 10 voxels with random values, degree 2."""
        active = ActiveVoxels(np.ones((9, 6, 10), bool))
        index = np.arange(28 * len(active))
        u = 2 * uniform(seed, step=0, pixel=index, sample=0, dimension=0).reshape(-1, 28) - 1
        policy = MarchPolicy(((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)), 0.11, border="zero")
        density, coefficients = u[:, 0].astype(dtype), u[:, 1:].reshape(-1, 9, 3).astype(dtype)
        return cls(active, density, coefficients, policy, background_density=-2.0)

    def refine(self, step: int, statistics: Mapping[str, Array]) -> None:
        """Nothing is ever dropped."""
        del step, statistics

    @classmethod
    def _bytes(cls, box: Array, options: FitOptions) -> int:
        """At the end of a fit."""
        return COPIES * 4 * cls.channels(options) * voxels_in(box, options.resolution)

    def prune(self, fit: FitInProgress) -> None:
        """Nothing is ever dropped."""
        del fit

    def _check_active(self, active: ActiveVoxels) -> None:
        missing = active.mask.size - len(active)
        if missing:
            raise RangeError(
                message(
                    "DenseSh",
                    "active",
                    "all voxels of the grid",
                    f"{missing} missing",
                    "what is pruned is a SparseSh",
                )
            )

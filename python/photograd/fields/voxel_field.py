"""What fields of voxels have in common: a raw density a row, drawn gradients, levels of a fit."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import root, sigmoid, softplus

from photograd import sh
from photograd._checkpoint import FLOAT, Row
from photograd._fit_options import FitOptions
from photograd._memory import require_room
from photograd.fields.march import MarchPolicy
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import write_vdb
from photograd.representation import COPIES, FitInProgress, Fittable, Memory
from photograd.types import Array

PRUNE_AT = 0.5
"""Fraction of the steps at which a grid is pruned; before that, pruning goes with refining."""
RAYS_AT_ONCE = 1 << 16


class VoxelField(Fittable):
    """A box of voxels or leaves with a raw density each; sigma_t = density_scale * softplus."""

    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})
    gradient_picture: ClassVar[str] = "voxels"
    first_model_help: ClassVar[str] = "grids start empty"
    rays_at_once: ClassVar[int] = RAYS_AT_ONCE
    """Of a gradient of many rays."""
    starts_empty: ClassVar[bool] = True
    """Whether a fit begins without matter, so that the signs of its first gradient are known."""
    gradient_note: ClassVar[str] = ""
    """A sentence for below pictures of the gradient."""
    export_suffixes: ClassVar[tuple[str, ...]] = (".vdb", ".npz")

    @property
    @abstractmethod
    def voxel_shape(self) -> tuple[int, int, int]:
        """Voxels (X, Y, Z) of the box; those of an octree are its smallest cells."""

    @abstractmethod
    def density_rows(self, groups: Mapping[str, Array]) -> Array:
        """(N,) what `groups`, parameters or their gradients, say of raw density: a row a voxel."""

    @abstractmethod
    def to_voxels(self, rows: Array) -> Array:
        """Rows (N,) as an array (X, Y, Z), 0 where nothing has a row.

        The number of a leaf, which stands for all of its cells, is that of each of them.

        Args:
            rows: (N,).
        """

    @property
    def active_voxels(self) -> NDArray[np.bool_]:
        """(X, Y, Z) which voxels have a row: all of a dense grid, the leaves with matter."""
        return self.to_voxels(np.ones(len(self.density_rows(self.params)), np.bool_))

    @property
    def density_slope(self) -> Array:
        """(N,) d sigma_t / d raw density of each row, in 1/m."""
        raw = self.density_rows(self.params).astype(np.float64)
        slope: Array = self.policy.density_scale * sigmoid(raw)
        return slope

    def extinction(self) -> tuple[Array, Array]:
        """sigma_t (X, Y, Z) in 1/m, float32, and the (4, 4) matrix from indices to the world.

        Index [0, 0, 0] is the middle of the first voxel.
        """
        raw = self.density_rows(self.params).astype(np.float64)
        sigma_t = self.to_voxels((self.policy.density_scale * softplus(raw)).astype(np.float32))
        voxel = (self.box[1] - self.box[0]) / self.voxel_shape
        matrix = np.diag([*voxel, 1.0])
        matrix[:3, 3] = self.box[0] + voxel / 2
        return sigma_t, matrix

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """Write sigma_t (1/m) of every voxel to a .vdb file, or all arrays to an .npz file."""
        if path.suffix.lower() != ".vdb":
            return super().export(path, background)
        sigma_t, matrix = self.extinction()
        write_vdb(path, [SparseGrid.from_dense(sigma_t, world_from_index=matrix)])
        return ("density is sigma_t in 1/m, +y up; a .vdb file has no color of the field",)


class GridField(VoxelField):
    """A grid that is marched through, and refined from coarse to fine while it is fitted."""

    policy: MarchPolicy

    @property
    def box(self) -> Array:
        """(2, 3) corners of the box in world meters."""
        return np.array(self.policy.box)

    @property
    def voxel_shape(self) -> tuple[int, int, int]:
        """Voxels along X, Y and Z."""
        x, y, z = self.shape[:3]
        return x, y, z

    @property
    def resolution(self) -> int:
        """Voxels along the longest edge."""
        return max(self.voxel_shape)

    @property
    def dt(self) -> float:
        """Step of the march in meters."""
        return self.policy.dt

    def with_dt(self, dt: float) -> Self:
        """The same field, whose parameters are shared, marched in other steps (meters)."""
        other = copy(self)
        other.policy = replace(self.policy, dt=dt)
        return other

    @abstractmethod
    def refined(self, resolution: int, *, steps_per_voxel: float = 2.0) -> Self:
        """The same field on a finer grid over the same box, by trilinear interpolation.

        Args:
            resolution: voxels along the longest edge.
            steps_per_voxel: of the march.
        """

    @abstractmethod
    def resampled(self, rows: Array, to: Any) -> Array:
        """Rows of this grid, such as an optimizer's moments, on the grid of another.

        Args:
            rows: values on this grid.
            to: the other grid.
        """

    def prune(self, fit: FitInProgress) -> None:
        """Drop voxels that no view needs; here none.

        Args:
            fit: that asks.
        """

    def adapted(self, fit: FitInProgress) -> Self:
        """Pruned, and at the next level, where the schedule says so."""
        options, step = fit.options, fit.step_number
        if step == int(PRUNE_AT * options.steps):
            self.prune(fit)
        size = options.levels().get(step)
        if size is None or size == self.resolution:
            return self
        self.prune(fit)
        require_room_to_refine(self, size)
        after = self.refined(size, steps_per_voxel=options.steps_per_voxel)
        for group in self.params:
            fit.optimizer.resample(group, lambda moment: self.resampled(moment, after))
        return after

    @classmethod
    def frozen_at(cls, options: FitOptions) -> int | None:
        """After the last pruning, and at the last level, of a grid that is pruned."""
        if "prune" not in cls.fit_options:
            return None
        return max(int(PRUNE_AT * options.steps), *options.levels()) + 1

    @classmethod
    def events(cls, options: FitOptions) -> dict[int, str]:
        """Each level."""
        return {step: f"{size}³" for step, size in options.levels().items()}

    @classmethod
    def memory(cls, box: Array, options: FitOptions, available: int) -> Sequence[Memory]:
        """Of the grid."""
        size = cls._bytes(box, options)
        fits = int(options.resolution * float(root(min(1.0, available / (2 * size)), 3)))
        what = f"a grid of {options.resolution} voxels along an edge"
        remedy = f"--resolution {fits} takes half of it; or crop the capture's bounds"
        return (Memory("resolution", what, size, remedy),)

    @classmethod
    @abstractmethod
    def channels(cls, options: FitOptions) -> int:
        """Numbers of a voxel.

        Args:
            options: of a fit.
        """

    @classmethod
    def _bytes(cls, box: Array, options: FitOptions) -> int:
        """At the end of a fit."""
        return COPIES * 4 * cls.channels(options) * voxels_in(box, options.resolution)


def harmonic_rows(options: FitOptions) -> dict[str, Row]:
    """Of a checkpoint's parameters "density" (N,) and "sh" (N, K, 3).

    Args:
        options: of a fit.
    """
    return {"density": (FLOAT, ("N",)), "sh": (FLOAT, ("N", sh.count(options.degree), 3))}


def voxels_in(box: Array, resolution: int) -> int:
    """Cubic voxels that fill a box (2, 3), `resolution` along its longest edge."""
    extent = np.asarray(box[1] - box[0], np.float64)
    x, y, z = (int(n) for n in np.ceil(extent * (resolution / extent.max()) - 1e-6))
    return max(x, 2) * max(y, 2) * max(z, 2)


def require_room_to_refine(grid: GridField, resolution: int) -> None:
    """Raise RangeError if a grid, refined, takes more memory than there is.

    It is interpolated from the coarse grid while that still exists. A sparse grid that pruned
    little, of a capture without alpha, can grow eightfold.

    Args:
        grid: that shall be refined.
        resolution: voxels along the longest edge.
    """
    now = sum(values.nbytes for values in grid.params.values())
    finer = resolution / grid.resolution
    needed = COPIES * int(now * (1 + finer * finer * finer))
    remedy = f"fit with --resolution {grid.resolution}, or crop the capture's bounds"
    what = f"a grid of {resolution} voxels along an edge"
    require_room("Fit.step", what, needed, argument="resolution", remedy=remedy)

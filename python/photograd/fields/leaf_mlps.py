"""A tiny network a cell, distilled from a field of networks, then fitted [Reiser2021].

The mathematics is in photograd.fields.cell_networks, the distillation in photograd.fields.distill.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

import numpy as np
from photograd_course.random import uniform

from photograd import sh
from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain
from photograd._fit_options import FitOptions
from photograd.errors import RangeError, message
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.cell_networks import (
    CellGrid,
    CellsContext,
    CellsPolicy,
    Overlaps,
    march_cells,
    march_cells_backward,
)
from photograd.fields.decoded_march import harmonics
from photograd.fields.dense_grid import cubic_voxels
from photograd.fields.distill import distill
from photograd.fields.march import MarchPolicy
from photograd.fields.neural_field import NeuralField
from photograd.fields.sparse_sh import SparseSh
from photograd.fields.tabulate import cells_in_reach, directions_around, radiance_of, visible_cells
from photograd.representation import (
    Fittable,
    Outputs,
    ParamSpec,
    RayBatch,
    RenderOptions,
    Start,
    register,
)
from photograd.types import Array

VISIBLE = 0.01
"""Opacity along its edge of a voxel that is marched through."""


@register
class LeafMlps(Fittable):
    """Two tiny networks for each brick of 8^3 voxels; those of neighboring cells overlap.

    params: "density" (N, P) and "color" (N, Q), a row a cell, each flat as in `Perceptron`.
    sigma_t = density_scale * softplus(raw) in 1/m, rgb = sigmoid(raw), linear. Voxels are those in
    which the field that was distilled is visible, and stay.
    """

    name: ClassVar[str] = "leaf_mlps"
    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})
    fit_defaults: ClassVar[Mapping[str, Any]] = {"rays": 4096}
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "required"
    first_model_kinds: ClassVar[tuple[str, ...]] = ("hash_grid", "nerf")
    same_resolution: ClassVar[bool] = False
    first_model_help: ClassVar[str] = (
        "fit a hash_grid or a nerf first, and start from that (--start-from)"
    )
    keeps_background: ClassVar[bool] = True
    export_suffixes: ClassVar[tuple[str, ...]] = (".vdb", ".npz")
    policy: CellsPolicy

    def __init__(
        self, active: ActiveVoxels, params: Mapping[str, Array], policy: CellsPolicy
    ) -> None:
        """Raises ShapeError or DtypeError for arrays that do not fit.

        Args:
            active: which voxels there are; each of their bricks has its networks.
            params: "density" (N, P) and "color" (N, Q).
            policy: box, step, sizes.
        """
        call, rows = Arguments("LeafMlps"), len(active.origins)
        sizes = dict(zip(("density", "color"), policy.networks(), strict=True))
        self.params = {
            name: call.array(name, params.get(name), (rows, networks.each.count), finite=False)
            for name, networks in sizes.items()
        }
        self.active, self.policy = active, policy

    @classmethod
    def from_field(
        cls,
        field: NeuralField,
        resolution: int,
        *,
        seed: int = 0,
        steps_per_voxel: float = 1.5,
        **sizes: Any,
    ) -> Self:
        """Distill a field of networks.

        Args:
            field: that was fitted.
            resolution: voxels along the longest edge of its box; a cell has 8.
            seed: of the weights, and of the points of the distillation.
            steps_per_voxel: of the march.
            sizes: "octaves", "width", "depth" and "features" of `CellsPolicy`.

        Raises:
            RangeError: a field that is empty everywhere.
        """
        corners = field.box.astype(np.float64)
        x, y, z = shape = tuple(cubic_voxels(corners[1] - corners[0], resolution))
        edge = float((corners[1] - corners[0]).max()) / resolution
        box = np.stack([corners[0], corners[0] + edge * np.array(shape)])
        radiance = radiance_of(field, edge / 8)
        reach = cells_in_reach(field, box, (x, y, z))
        cells = visible_cells(radiance, box, (x, y, z), opacity=VISIBLE, reach=reach)
        if not len(cells.index):
            expected = f"a field with voxels more opaque than {VISIBLE}"
            raise RangeError(message("LeafMlps.from_field", "field", expected, "none"))
        mask = np.zeros(shape, bool)
        mask[tuple(cells.index.T)] = True
        lower, upper = box.tolist()
        policy = CellsPolicy(
            (tuple(lower), tuple(upper)), edge / steps_per_voxel, density_scale=1 / edge, **sizes
        )
        grid = cls._random(ActiveVoxels(mask), policy, seed=seed)
        distill(grid._grid(), radiance, seed=seed)
        return grid

    @classmethod
    def _random(
        cls, active: ActiveVoxels, policy: CellsPolicy, *, seed: int, dtype: Any = np.float32
    ) -> Self:
        rows = len(active.origins)
        density, color = (
            networks.initial(rows, seed=seed + k * rows, dtype=dtype)
            for k, networks in enumerate(policy.networks())
        )
        return cls(active, {"density": density, "color": color}, policy)

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Networks distilled from a field that was fitted before.

        Raises RangeError for another field.
        """
        options, field = start.options, start.field
        if not isinstance(field, NeuralField):
            expected = f"a model of {' or '.join(cls.first_model_kinds)}"
            got = "none" if field is None else repr(field.name)
            raise RangeError(message("Fit.start", "start_from", expected, got))
        found = cls.from_field(
            field, options.resolution, seed=options.seed, steps_per_voxel=options.steps_per_voxel
        )
        cells, numbers = len(found.active.origins), sum(found.shape[1::2])
        voxels = f"{len(found.active):,} of {options.resolution}³ voxels"
        return found, f"{cells:,} cells with {numbers:,} weights each, around {voxels}"

    @classmethod
    def frozen_at(cls, options: FitOptions) -> int:
        """From the start: the cells are those of another model."""
        del options
        return 0

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """Networks of any size that the policy asks for, a row a cell; the voxels."""
        del options
        return {"density": (FLOAT, ("N", "P")), "color": (FLOAT, ("N", "Q"))}, {
            "shape": (("int64",), (3,)),
            "mask": (("uint8",), ("bytes of the mask",)),
        }

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The field of a checkpoint."""
        del options
        active = ActiveVoxels.of_state(state, "load_model")
        return cls(active, params, from_plain("checkpoint", CellsPolicy, policy))

    def state(self) -> dict[str, Array]:
        """The voxels."""
        return self.active.state()

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Voxels are fixed: raises RangeError unless `state` is that of the same ones."""
        own = self.state()
        if set(state) != set(own) or not all(np.array_equal(state[k], own[k]) for k in own):
            expected, got = f"this field's {sorted(own)}", f"{sorted(state)}"
            remedy = "the voxels of leaf_mlps cannot change"
            raise RangeError(message("LeafMlps.load_state", "state", expected, got, remedy))

    @property
    def box(self) -> Array:
        """(2, 3) corners of the box in world meters."""
        return np.array(self.policy.box)

    @property
    def resolution(self) -> int:
        """Voxels along the longest edge."""
        return int(max(self.active.shape))

    @property
    def dt(self) -> float:
        """Step of the march in meters."""
        return self.policy.dt

    def with_dt(self, dt: float) -> Self:
        """The same field, whose parameters are shared, marched in other steps (meters)."""
        other = copy(self)
        other.policy = replace(self.policy, dt=dt)
        return other

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """The networks."""
        return {
            name: ParamSpec(values.shape, "1", (-1e4, 1e4), 3e-3, "none")
            for name, values in self.params.items()
        }

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Eight cells of 11 x 9 x 10 voxels; smooth, so that finite differences find no kink."""
        grid = SparseSh.example(seed=seed)
        policy = CellsPolicy(
            grid.policy.box, 0.11, octaves=1, width=6, features=3, hidden="softplus"
        )
        field = cls._random(grid.active, policy, seed=seed, dtype=dtype)
        for step, values in enumerate(field.params.values()):
            index = np.arange(values.size)
            u = uniform(seed, step=step, pixel=index, sample=1, dimension=0)
            values[:] += (0.6 * (2 * u - 1)).reshape(values.shape).astype(dtype)
        return field

    def example_batch(self, *, seed: int) -> RayBatch:
        """As that of the sparse grid."""
        return SparseSh.example(seed=seed).example_batch(seed=seed)

    def _grid(self) -> CellGrid:
        return CellGrid(dict(self.params), self.policy, self.active)

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, CellsContext]:
        """Color (R, 3) linear, premultiplied, without background; opacity (R,); depth (R,) m."""
        return march_cells(self._grid(), batch, options, seed=seed, step=step)

    def render_backward(self, context: CellsContext, d_outputs: Outputs) -> dict[str, Array]:
        """Of each group, and "origins", "directions" (R, 3) if the options asked."""
        return march_cells_backward(context, d_outputs)

    def baked(self, *, degree: int = 2) -> SparseSh:
        """A sparse grid of harmonics: what the networks say at each voxel, projected.

        Args:
            degree: of the harmonics, 0 to 3.
        """
        grid, kind = self._grid(), self.params["density"].dtype
        where = Overlaps.of_points(self.active.voxels.astype(kind), self.active)
        _, given = grid.densities(where)
        directions, around = directions_around()
        dual = sh.basis(directions, degree) * around[:, None]
        coefficients = np.zeros((len(self.active), sh.count(degree), 3))
        for direction, weights in zip(harmonics(directions.astype(kind)), dual, strict=True):
            basis = np.broadcast_to(direction, (len(self.active), len(direction)))
            _, raw = grid.colors(where, given[:, 1:], basis)
            coefficients += weights[:, None] * where.blended(raw)[:, None].astype(np.float64)
        old = self.policy
        march = MarchPolicy(
            old.box, old.dt, old.lattice, border="zero", density_scale=old.density_scale
        )
        raw = where.blended(given[:, :1])[:, 0]
        return SparseSh(
            self.active, raw, coefficients.astype(kind), march, background_density=-20.0
        )

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """As the sparse grid of harmonics that `baked` returns; no network is needed to read it."""
        notes = self.baked().export(path, background)
        return (*notes, "the networks are baked to harmonics of degree 2 at the voxels")

"""Plenoxels: density and spherical-harmonic color at the active voxels of a sparse grid.

No network and no dense memory: [FridovichKeil2022]. The mathematics is in
cpp/photograd/field/sparse_sh.h.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar, Self

import numpy as np
from photograd_course.portable_math import log
from photograd_course.random import uniform
from photograd_course.row_map import RowMap

from photograd import sh
from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain
from photograd._compiled import _core
from photograd._fit_options import MAX_DEGREE, FitOptions
from photograd._memory import require_room
from photograd.errors import RangeError, message
from photograd.fields.active_voxels import ActiveVoxels, dilated, resampled_mask
from photograd.fields.dense_grid import START_COLOR, DenseGrid, cubic_voxels, finer_voxels
from photograd.fields.march import MarchPolicy, checked_values
from photograd.fields.march_sparse import (
    SparseContext,
    greatest_weights,
    march_sparse,
    march_sparse_backward,
)
from photograd.fields.voxel_field import GridField, harmonic_rows, voxels_in
from photograd.representation import (
    COPIES,
    FitInProgress,
    Outputs,
    ParamSpec,
    Prior,
    RayBatch,
    RenderOptions,
    Start,
    register,
)
from photograd.types import Array

WEIGHT_RAYS, GRADIENT_RAYS = 1 << 20, 1 << 17
"""From all views; a ray of the gradient costs as much as two of the weights."""
WANTED = 0.05  # of the greatest |dL/d density|; what is below is noise of the photographs


@register
class SparseSh(GridField):
    """A radiance field on the active voxels of an X x Y x Z grid (trilinear in between).

    params["density"] (N,) raw density and params["sh"] (N, K, 3) coefficients, one row for each
    active voxel: sigma_t = density_scale * density_activation(density) in 1/m,
    rgb = color_activation(sum_k Y_k(direction) sh_k), linear Rec. 709; direction is that of the
    ray, away from the camera. What is not active has raw density `background_density` and no
    color of its own; a cell without any active corner is empty. `background_gradient` (1 + 3 K,),
    after a backward pass, is the gradient that reaches corners of cells where no voxel is active.
    """

    name: ClassVar[str] = "sparse_sh"
    # What held-out training views prefer: docs/results.md.
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 256}
    fit_options: ClassVar[frozenset[str]] = frozenset({"degree", "prune"})

    def __init__(
        self,
        active: ActiveVoxels,
        density: Array,
        coefficients: Array,
        policy: MarchPolicy,
        *,
        background_density: float = 0.0,
        fused: bool = True,
    ) -> None:
        """Raises ShapeError, DtypeError, RangeError (degree) or Error (not finite).

        Args:
            active, policy: which voxels there are, and box, step and activations.
            density, coefficients: (N,) raw, and (N, K, 3) of the harmonics.
            background_density: raw, of voxels that are not active.
            fused: False takes the readable form of the kernel.
        """
        checked_values("SparseSh", "density", density)
        checked_values("SparseSh", "sh", coefficients)
        call = Arguments("SparseSh")
        density = call.array("density", density, (len(active),), finite=False)
        coefficients = call.array("sh", coefficients, (len(active), "K", 3), finite=False)
        if coefficients.shape[1] not in (1, 4, 9, 16):
            expected = f"1, 4, 9 or 16 coefficients (degree 0 to {MAX_DEGREE})"
            raise RangeError(message("SparseSh", "sh", expected, coefficients.shape[1]))
        if policy.border != "zero":
            raise RangeError(message("SparseSh", "policy.border", "'zero'", repr(policy.border)))
        self._check_active(active)
        self.active = active
        self.params = {"density": density, "sh": coefficients}
        self.policy = policy
        self.background_density = background_density
        self.fused = fused
        self.background_gradient: Array = np.zeros(1 + 3 * coefficients.shape[1], density.dtype)

    @classmethod
    def full(
        cls,
        box: Array,
        resolution: int,
        *,
        degree: int = 2,
        finest: int | None = None,
        sigma_t: float = 0.1,
        steps_per_voxel: float = 2.0,
        dtype: type[np.floating[Any]] = np.float32,
    ) -> Self:
        """A grid of cubic voxels over `box` (2, 3) in which every voxel is active, nearly empty.

        `resolution`, `finest`, `sigma_t`, `steps_per_voxel` and `dtype` as for `DenseGrid.empty`;
        `degree` 0 to 3. Raises RangeError.
        """
        Arguments("SparseSh.full").integer("degree", degree, low=0, high=MAX_DEGREE)
        corners = np.asarray(box, np.float64)
        if resolution >= 2 and np.ptp(corners, axis=0).max() > 0:  # else refused below
            shape = cubic_voxels(corners[1] - corners[0], resolution)
            numbers = 5 + 1 + 3 * sh.count(degree)  # the dense grid is there for a moment
            size = numbers * np.dtype(dtype).itemsize * math.prod(shape)
            what = f"{' x '.join(map(str, shape))} voxels of degree {degree}"
            remedy = "take a lower resolution, or a lower degree"
            require_room("SparseSh.full", what, size, argument="resolution", remedy=remedy)
        dense = DenseGrid.empty(
            box,
            resolution,
            finest=finest,
            sigma_t=sigma_t,
            steps_per_voxel=steps_per_voxel,
            dtype=dtype,
        )
        policy = replace(dense.policy, border="zero", density_activation="softplus")
        active = ActiveVoxels(np.ones(dense.density.shape, bool))
        density = np.full(len(active), dense.density.flat[0], dtype)
        coefficients = np.zeros((len(active), sh.count(degree), 3), dtype)
        coefficients[:, 0] = log(START_COLOR / (1 - START_COLOR)) / sh.Y_0
        start = float(dense.density.flat[0])
        return cls(active, density, coefficients, policy, background_density=start)

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Two thirds of 11 x 9 x 10 voxels with random values, degree 2."""
        shape = (11, 9, 10)
        voxel = np.arange(int(np.prod(shape)))
        chosen = uniform(seed, step=1, pixel=voxel, sample=0, dimension=0) < 2 / 3
        active = ActiveVoxels(chosen.reshape(shape))
        index = np.arange(28 * len(active))
        u = 2 * uniform(seed, step=0, pixel=index, sample=0, dimension=0).reshape(-1, 28) - 1
        policy = MarchPolicy(((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)), 0.11, border="zero")
        coefficients = u[:, 1:].reshape(-1, 9, 3)
        density, coefficients = u[:, 0].astype(dtype), coefficients.astype(dtype)
        return cls(active, density, coefficients, policy, background_density=-2.0)

    def example_batch(self, *, seed: int) -> RayBatch:
        """As that of the dense grid."""
        return DenseGrid.example(seed=seed).example_batch(seed=seed)

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Voxels along X, Y and Z, active or not, and the numbers of each active one."""
        return (*self.active.shape, 1 + self.params["sh"][0].size)

    def density_rows(self, groups: Mapping[str, Array]) -> Array:
        """(N,) density."""
        return groups["density"]

    def to_voxels(self, rows: Array) -> Array:
        """Rows (N,) as (X, Y, Z), 0 where no voxel is active."""
        voxels = np.zeros(self.active.shape, rows.dtype)
        i, j, k = self.active.voxels.T
        voxels[i, j, k] = rows
        return voxels

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Nearly empty space in the box, at the coarsest level of the options."""
        options = start.options
        field = cls.full(
            start.bounds.box,
            options.levels()[0],
            degree=options.degree,
            finest=options.resolution,
            sigma_t=options.sigma_t,
            steps_per_voxel=options.steps_per_voxel,
        )
        return field, f"box: {start.bounds.rule}"

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """Density and harmonics; which voxels are active."""
        return harmonic_rows(options), {
            "shape": (("int64",), (3,)),
            "mask": (("uint8",), ("bytes of the mask",)),
            "background_density": (FLOAT, ()),
        }

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The grid of a checkpoint."""
        del options
        march = from_plain("checkpoint", MarchPolicy, policy)
        rest = {key: value for key, value in state.items() if key != "background_density"}
        active = ActiveVoxels.of_state(rest, "load_model")
        outside = float(state["background_density"])
        return cls(active, params["density"], params["sh"], march, background_density=outside)

    @classmethod
    def channels(cls, options: FitOptions) -> int:
        """Density and harmonics."""
        return 1 + 3 * sh.count(options.degree)

    @classmethod
    def _bytes(cls, box: Array, options: FitOptions) -> int:
        """All voxels at the beginning, the mask alone at the end: who knows what will be pruned."""
        first = COPIES * 4 * cls.channels(options) * voxels_in(box, options.levels()[0])
        mask_and_bricks = 2 * voxels_in(box, options.resolution)
        return max(first, mask_and_bricks)

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Density and coefficients; Adam moves an entry by about its rate."""
        shapes = {name: value.shape for name, value in self.params.items()}
        return {
            "density": ParamSpec(shapes["density"], "1", (-20.0, 1e4), 0.5, "grid"),
            "sh": ParamSpec(shapes["sh"], "1", (-100.0, 100.0), 0.2, "grid"),
        }

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, SparseContext]:
        """Color (R, 3) linear, premultiplied, without background; opacity (R,); depth (R,) m."""
        return march_sparse(
            self.active,
            (self.params["density"], self.params["sh"], self._background()),
            self.policy,
            batch,
            options,
            seed=seed,
            step=step,
            fused=self.fused,
        )

    def render_backward(self, context: SparseContext, d_outputs: Outputs) -> dict[str, Array]:
        """{"density", "sh"}, and "origins", "directions" (R, 3) if the options asked."""
        gradients, self.background_gradient = march_sparse_backward(context, d_outputs)
        return gradients

    def priors(self) -> Sequence[Prior]:
        """Total variation of each group: active neighbors should agree."""
        return tuple(
            Prior(f"total_variation_{group}", group, self._variation, self._variation_backward)
            for group in ("density", "sh")
        )

    def _variation(self, values: Array) -> float:
        flat = np.ascontiguousarray(values).reshape(len(values), -1)
        return float(_core.total_variation(self.active.topology, flat))

    def _variation_backward(self, values: Array, d_value: float = 1.0) -> Array:
        d_values = np.zeros_like(values)
        self.add_variation(values, d_value, d_values, (0, self.active.topology.bricks))
        return d_values

    def add_variation(
        self, values: Array, d_value: float, d_values: Array, bricks: tuple[int, int]
    ) -> None:
        """Add the adjoint for `d_value` of the variation of `values` in `bricks` to `d_values`."""
        flat = np.ascontiguousarray(values).reshape(len(values), -1)
        d_flat = d_values.reshape(flat.shape)
        _core.total_variation_backward(self.active.topology, flat, d_value, *bricks, d_flat)

    def add_prior(self, gradients: Mapping[str, Array], weight: float, u: float) -> None:
        """Add total variation's gradient in an eighth of the bricks, which stands for the whole.

        `u` in [0, 1) says which; they follow one another.
        """
        bricks = self.active.topology.bricks
        some = max(1, bricks // 8)
        start = int(u * (bricks - some + 1))
        for group, values in self.params.items():
            share = weight * bricks / some
            self.add_variation(values, share, gradients[group], (start, start + some))

    def greatest_weights(self, batches: Iterable[RayBatch]) -> Array:
        """(N,) the greatest weight that each voxel has in any sample of these `batches`, 0 to 1.

        A sample's weight in its pixel times the voxel's trilinear weight in the sample. Give it all
        views: a voxel that this batch does not see may matter to the next.
        """
        parameters = (self.params["density"], self.params["sh"], self._background())
        return greatest_weights(self.active, parameters, self.policy, batches)

    def prune(self, fit: FitInProgress) -> None:
        """Drop voxels that weigh less than `fit.options.prune` in every pixel of every view.

        Those stay for which the loss would fall with more density: dL/d density is below -WANTED
        times the greatest |dL/d density|. The weight alone would drop voxels that matter is about
        to grow into.
        """
        if fit.options.prune == 0:
            return
        weight = self.greatest_weights(fit.batches(WEIGHT_RAYS))
        d_density = fit.mean_gradient("density", GRADIENT_RAYS)
        wanted = d_density < -WANTED * np.abs(d_density).max(initial=0.0)
        threshold = np.array(fit.options.prune)
        statistics = {"weight": weight, "threshold": threshold, "wanted": wanted}
        rows = self.refine(fit.step_number, statistics)
        if rows is not None:
            fit.optimizer.apply_row_map(rows, self.params)

    def refine(self, step: int, statistics: Mapping[str, Array]) -> RowMap | None:
        """Drop voxels with statistics["weight"] (N,) below statistics["threshold"], then dilate.

        Where statistics["wanted"] (N,) bool is given and true, a voxel stays whatever it weighs.
        Every voxel next to one that stays is kept, or made anew with the background's density and
        no color. Nothing happens without these statistics.
        """
        del step
        if "weight" not in statistics:
            return None
        stays = statistics["weight"] >= statistics["threshold"]
        if "wanted" in statistics:
            stays = stays | statistics["wanted"]
        mask = np.zeros(self.active.shape, bool)
        i, j, k = self.active.voxels[stays].T
        mask[i, j, k] = True
        after = ActiveVoxels(dilated(mask))
        i, j, k = after.voxels.T
        source = RowMap(self.active.rows[i, j, k], len(self.active))
        self.params = {
            "density": source.apply(self.params["density"], fill=self.background_density),
            "sh": source.apply(self.params["sh"]),
        }
        self.active = after
        return source

    def refined(self, resolution: int, *, steps_per_voxel: float = 2.0) -> Self:
        """The same field on a finer grid over the same box, by trilinear interpolation.

        Raises RangeError for fewer than 2 voxels, or more than memory holds.
        """
        where = f"{type(self).__name__}.refined"
        shape = finer_voxels(where, self.box, resolution)
        share = len(self.active) / self.active.mask.size
        numbers = share * self.params["density"].itemsize * (1 + self.params["sh"][0].size)
        size = int((3 + numbers) * math.prod(shape))
        what = f"{' x '.join(map(str, shape))} voxels"
        remedy = "take a lower resolution, or prune"
        require_room(where, what, size, argument="resolution", remedy=remedy)
        voxel = (self.box[1] - self.box[0]).max() / resolution
        active = ActiveVoxels(resampled_mask(self.active.mask, shape))
        density = self.active.resampled(self.params["density"], active, self.background_density)
        coefficients = self.active.resampled(self.params["sh"], active, 0.0)
        policy = replace(self.policy, dt=voxel / steps_per_voxel)
        grid = active, density, coefficients, policy
        return type(self)(*grid, background_density=self.background_density, fused=self.fused)

    def resampled(self, rows: Array, to: Self) -> Array:
        """Rows of this grid, such as an optimizer's, at the voxels of another; 0 where none is."""
        return self.active.resampled(rows, to.active, 0.0)

    def state(self) -> dict[str, Array]:
        """The topology, and what lies outside of it."""
        return {**self.active.state(), "background_density": np.array(self.background_density)}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Restore the topology; the parameters are those that were saved with it."""
        rest = dict(state)
        background = rest.pop("background_density", None)
        active = ActiveVoxels.of_state(rest, "sparse_sh.load_state")
        if background is None:
            raise RangeError(
                message("sparse_sh.load_state", "state", "a background_density", f"{sorted(state)}")
            )
        self._check_active(active)
        self.active, self.background_density = active, float(background)

    def _check_active(self, active: ActiveVoxels) -> None:
        """Any topology will do."""

    def _background(self) -> Array:
        values = np.zeros(1 + self.params["sh"][0].size, self.params["density"].dtype)
        values[0] = self.background_density
        return values

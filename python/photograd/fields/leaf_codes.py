"""Codes at the voxels of a sparse grid, and one small network that decodes them [Liu2020].

The mathematics is in photograd.fields.decoded_march.
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
from photograd._fit_options import Decode, FitOptions
from photograd.errors import RangeError, message
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.decoded_march import (
    DIRECTION_DEGREE,
    CodeGrid,
    CodesContext,
    CodesPolicy,
    harmonics,
    march_codes,
    march_codes_backward,
)
from photograd.fields.march import MarchPolicy
from photograd.fields.sparse_sh import SparseSh
from photograd.fields.tabulate import directions_around
from photograd.fields.voxel_field import VoxelField
from photograd.network import Perceptron
from photograd.representation import Outputs, ParamSpec, RayBatch, RenderOptions, Start, register
from photograd.types import Array

START_RANGE = 0.1
"""Codes begin uniform within +- this."""


@register
class LeafCodes(VoxelField):
    """A code and a density at each active voxel, trilinear in between, and a shared decoder.

    params: "density" (N,) raw, "codes" (N, F), "decoder" (P,) flat as in `Perceptron`. sigma_t =
    density_scale * softplus(density) in 1/m. Voxels are those of a sparse grid that was fitted
    before, and stay.
    """

    name: ClassVar[str] = "leaf_codes"
    fit_options: ClassVar[frozenset[str]] = frozenset({"decode"})
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "required"
    first_model_kinds: ClassVar[tuple[str, ...]] = ("sparse_sh",)
    first_model_help: ClassVar[str] = "fit a sparse_sh first, and start from that (--start-from)"
    keeps_background: ClassVar[bool] = True
    starts_empty: ClassVar[bool] = False
    rays_at_once: ClassVar[int] = 1 << 13  # each keeps the codes of its samples
    policy: CodesPolicy

    def __init__(
        self,
        active: ActiveVoxels,
        params: Mapping[str, Array],
        policy: CodesPolicy,
        *,
        background_density: float = 0.0,
    ) -> None:
        """Raises ShapeError or DtypeError for arrays that do not fit.

        Args:
            active: which voxels there are.
            params: "density" (N,), "codes" (N, F) and "decoder" (P,).
            policy: box, step, sizes.
            background_density: raw, of voxels that are not active.
        """
        self.decoder = Perceptron(
            policy.features + sh.count(DIRECTION_DEGREE),
            [policy.width] * policy.depth + [3],
            hidden=policy.hidden,
        )
        call, rows = Arguments("LeafCodes"), len(active)
        shapes = {
            "density": (rows,),
            "codes": (rows, policy.features),
            "decoder": (self.decoder.count,),
        }
        self.params = {
            name: call.array(name, params.get(name), shape, finite=False)
            for name, shape in shapes.items()
        }
        self.active, self.policy, self.background_density = active, policy, background_density

    @classmethod
    def from_sparse_sh(
        cls, field: SparseSh, *, seed: int = 0, decode: Decode = "sample", **sizes: Any
    ) -> Self:
        """Voxels and densities of a sparse grid; codes and decoder are random.

        Args:
            field: that was fitted.
            seed: of codes and decoder.
            decode: where the network is evaluated.
            sizes: "features", "width" and "depth" of `CodesPolicy`.

        Raises:
            RangeError: the field's activations are not softplus and sigmoid.
        """
        old = field.policy
        if (old.density_activation, old.color_activation) != ("softplus", "sigmoid"):
            expected = "a field with density_activation 'softplus' and color_activation 'sigmoid'"
            got = f"{old.density_activation!r} and {old.color_activation!r}"
            raise RangeError(message("LeafCodes.from_sparse_sh", "field", expected, got))
        policy = CodesPolicy(
            old.box, old.dt, old.lattice, density_scale=old.density_scale, decode=decode, **sizes
        )
        kind, rows = field.params["density"].dtype, len(field.active)
        index = np.arange(rows * policy.features)
        u = uniform(seed, step=0, pixel=index, sample=0, dimension=0)
        blank = cls._blank(field.active, policy, kind)
        blank.params["density"][:] = field.params["density"]
        blank.params["codes"][:] = (START_RANGE * (2 * u - 1)).reshape(rows, -1)
        blank.params["decoder"][:] = blank.decoder.initial(seed=seed + 1, dtype=kind)
        blank.background_density = field.background_density
        return blank

    @classmethod
    def _blank(cls, active: ActiveVoxels, policy: CodesPolicy, kind: Any) -> Self:
        rows, inputs = len(active), policy.features + sh.count(DIRECTION_DEGREE)
        network = Perceptron(inputs, [policy.width] * policy.depth + [3], hidden=policy.hidden)
        shapes: dict[str, Any] = {"density": rows, "codes": (rows, policy.features)}
        shapes["decoder"] = network.count
        return cls(active, {n: np.zeros(shape, kind) for n, shape in shapes.items()}, policy)

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Random codes at the voxels of a sparse grid that was fitted before.

        Raises RangeError for another field.
        """
        field, options = start.field, start.options
        if not isinstance(field, SparseSh):
            expected = f"a model of {' or '.join(cls.first_model_kinds)}"
            got = "none" if field is None else repr(field.name)
            raise RangeError(message("Fit.start", "start_from", expected, got))
        codes = cls.from_sparse_sh(field, seed=options.seed, decode=options.decode)
        rows, numbers = codes.params["codes"].shape
        return codes, f"{rows:,} voxels with {numbers} numbers each, decoded per {options.decode}"

    @classmethod
    def frozen_at(cls, options: FitOptions) -> int:
        """From the start: the voxels are those of another model."""
        del options
        return 0

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """Codes of any length and a decoder of any size that the policy asks for; the voxels."""
        del options
        params: dict[str, Row] = {"density": (FLOAT, ("N",)), "codes": (FLOAT, ("N", "F"))}
        return params | {"decoder": (FLOAT, ("P",))}, {
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
        """The field of a checkpoint."""
        del options
        told = from_plain("checkpoint", CodesPolicy, policy)
        rest = {key: value for key, value in state.items() if key != "background_density"}
        active = ActiveVoxels.of_state(rest, "load_model")
        return cls(active, params, told, background_density=float(state["background_density"]))

    def state(self) -> dict[str, Array]:
        """The voxels, and what lies outside of them."""
        return {**self.active.state(), "background_density": np.array(self.background_density)}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Voxels are fixed: raises RangeError unless `state` is that of the same ones."""
        own = self.state()
        if set(state) != set(own) or not all(np.array_equal(state[k], own[k]) for k in own):
            expected, got = f"this field's {sorted(own)}", f"{sorted(state)}"
            remedy = "the voxels of leaf_codes cannot change"
            raise RangeError(message("LeafCodes.load_state", "state", expected, got, remedy))

    @property
    def box(self) -> Array:
        """(2, 3) corners of the box in world meters."""
        return np.array(self.policy.box)

    @property
    def voxel_shape(self) -> tuple[int, int, int]:
        """Voxels along X, Y and Z."""
        return self.active.shape

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
        return self._with(dt=dt)

    def decoded(self, decode: Decode) -> Self:
        """The same field, whose parameters are shared, decoded per sample or per ray.

        Args:
            decode: where the network is evaluated.
        """
        return self._with(decode=decode)

    def _with(self, **changes: Any) -> Self:
        other = copy(self)
        other.policy = replace(self.policy, **changes)
        return other

    def density_rows(self, groups: Mapping[str, Array]) -> Array:
        """(N,) density."""
        return groups["density"]

    def to_voxels(self, rows: Array) -> Array:
        """Rows (N,) as (X, Y, Z), 0 where no voxel is active."""
        voxels = np.zeros(self.active.shape, rows.dtype)
        i, j, k = self.active.voxels.T
        voxels[i, j, k] = rows
        return voxels

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Densities, codes and the decoder."""
        shape = {name: array.shape for name, array in self.params.items()}
        return {
            "density": ParamSpec(shape["density"], "1", (-20.0, 1e4), 0.2, "grid"),
            "codes": ParamSpec(shape["codes"], "1", (-1e3, 1e3), 0.03, "grid"),
            "decoder": ParamSpec(shape["decoder"], "1", (-1e4, 1e4), 3e-3, "none"),
        }

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Two thirds of 11 x 9 x 10 voxels, codes of 3 numbers; smooth, so that nothing kinks."""
        grid = SparseSh.example(seed=seed, dtype=dtype)
        small: dict[str, Any] = {"features": 3, "width": 8, "depth": 1}
        field = cls.from_sparse_sh(grid, seed=seed, **small)
        field.params["codes"] *= 4
        return field._smooth()

    def _smooth(self) -> Self:
        policy = replace(self.policy, hidden="softplus")
        outside = self.background_density
        return type(self)(self.active, self.params, policy, background_density=outside)

    def example_batch(self, *, seed: int) -> RayBatch:
        """As that of the sparse grid."""
        return SparseSh.example(seed=seed).example_batch(seed=seed)

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, CodesContext]:
        """Color (R, 3) linear, premultiplied, without background; opacity (R,); depth (R,) m."""
        grid = CodeGrid(
            dict(self.params), self.decoder, self.policy, self.active, self.background_density
        )
        return march_codes(grid, batch, options, seed=seed, step=step)

    def render_backward(self, context: CodesContext, d_outputs: Outputs) -> dict[str, Array]:
        """Of each group, and "origins", "directions" (R, 3) if the options asked."""
        return march_codes_backward(context, d_outputs)

    def baked(self, *, degree: int = 2) -> SparseSh:
        """A sparse grid of harmonics: what the decoder says at each voxel, projected.

        Args:
            degree: of the harmonics, 0 to 3.
        """
        directions, around = directions_around()
        kind, codes = self.params["codes"].dtype, self.params["codes"]
        dual = sh.basis(directions, degree) * around[:, None]
        coefficients = np.zeros((len(codes), sh.count(degree), 3))
        for direction, weights in zip(harmonics(directions.astype(kind)), dual, strict=True):
            given = np.concatenate([codes, np.broadcast_to(direction, (len(codes), 9))], axis=1)
            raw = self.decoder.forward(self.params["decoder"], np.ascontiguousarray(given))
            coefficients += weights[:, None] * raw[:, None].astype(np.float64)
        old = self.policy
        march = MarchPolicy(
            old.box, old.dt, old.lattice, border="zero", density_scale=old.density_scale
        )
        arrays = self.params["density"].copy(), coefficients.astype(kind)
        return SparseSh(self.active, *arrays, march, background_density=self.background_density)

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """As the sparse grid of harmonics that `baked` returns; no network is needed to read it."""
        notes = self.baked().export(path, background)
        return (*notes, "colors are baked to harmonics of degree 2")

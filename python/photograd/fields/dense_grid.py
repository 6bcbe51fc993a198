"""Dense RGBA grid: a raw color and a raw density in every voxel of a box."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar, Self

import numpy as np
from photograd_course import priors
from photograd_course.portable_math import expm1, log
from photograd_course.random import uniform
from photograd_course.resample import upsample_trilinear

from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain
from photograd._fit_options import FitOptions
from photograd._memory import require_room
from photograd.fields.march import MarchContext, MarchPolicy, march, march_backward
from photograd.fields.voxel_field import GridField
from photograd.representation import (
    Outputs,
    ParamSpec,
    Prior,
    RayBatch,
    RenderOptions,
    Start,
    register,
)
from photograd.types import Array

START_COLOR = 0.18
"""Linear color of empty space before a fit: middle gray, 0.46 of display white.

In front of a random background it makes the first dL/dsigma_t negative for black matter and for
white alike, and about equally large: a brighter gray is further from black than the average
background is, so that dark matter would first be pushed away.
"""


def cubic_voxels(extent: Array, resolution: int) -> list[int]:
    """Voxels along each edge of a box of this extent (3,), `resolution` along the longest."""
    voxel = float(extent.max()) / resolution
    return [max(math.ceil(edge / voxel - 1e-6), 2) for edge in extent.tolist()]


def finer_voxels(function: str, box: Array, resolution: int) -> tuple[int, int, int]:
    """Voxels along each edge of a box that stays as it is; they are nearly cubes.

    Args:
        function: on whose behalf the error speaks.
        box: (2, 3) in meters.
        resolution: voxels along the longest edge.

    Raises:
        DtypeError, RangeError: fewer than 2 voxels along the longest edge.
    """
    Arguments(function).integer("resolution", resolution, low=2)
    extent = box[1] - box[0]
    voxel = extent.max() / resolution
    x, y, z = (max(round(edge), 2) for edge in (extent / voxel).tolist())
    return x, y, z


def _require_room(function: str, voxels: list[int], itemsize: int) -> None:
    """Raise RangeError if the values, and the mask of what is finite, take too much memory."""
    require_room(
        function,
        f"{' x '.join(map(str, voxels))} voxels",
        4 * (itemsize + 1) * math.prod(voxels),
        argument="resolution",
        remedy="take a lower resolution, or a flatter box",
    )


@register
class DenseGrid(GridField):
    """A radiance field on X x Y x Z voxels (values at voxel centers, trilinear in between).

    params["values"] (X, Y, Z, 4) holds raw r, g, b and density side by side: a lookup reads all
    four. `color` and `density` are views of it. What they mean is the policy's business:
    sigma_t = density_scale * softplus(density) in 1/m, rgb = sigmoid(color), linear Rec. 709.
    """

    name: ClassVar[str] = "dense_grid"
    row_updates: ClassVar[bool] = False  # most rows have a gradient

    def __init__(self, values: Array, policy: MarchPolicy, *, fused: bool = True) -> None:
        """Raises DtypeError, ShapeError or RangeError unless values is (X, Y, Z, 4), finite, and
        X, Y and Z are at least 2.

        Args:
            values: raw color and density of each voxel.
            policy: the box, the step and the activations.
            fused: False takes the readable form of the kernel.
        """
        call = Arguments("DenseGrid")
        self.params = {"values": call.array("values", values, ("X", "Y", "Z", 4), min_length=2)}
        self.policy = policy
        self.fused = fused

    @classmethod
    def empty(
        cls,
        box: Array,
        resolution: int,
        *,
        finest: int | None = None,
        sigma_t: float = 0.1,
        steps_per_voxel: float = 2.0,
        dtype: type[np.floating[Any]] = np.float32,
    ) -> Self:
        """A nearly transparent middle-gray grid of cubic voxels over `box` (2, 3), world meters.

        `resolution` counts voxels along the longest edge; the box grows a little so that voxels are
        cubes. `finest` is the resolution that a coarse-to-fine fit will end with: it fixes the
        density scale, so that a parameter keeps its meaning from level to level. `sigma_t` (1/m) is
        the start. Raises RangeError for a bad box, fewer than 2 voxels, or more than memory holds.

        Args:
            box: (2, 3) in meters.
            resolution: voxels along the longest edge.
            finest: resolution at the end of a fit; None takes `resolution`.
            sigma_t: extinction in 1/m.
            steps_per_voxel: of the march.
            dtype: np.float32 or np.float64.
        """
        call = Arguments("DenseGrid.empty", np.float64)
        resolution, box = call.integer("resolution", resolution, low=2), call.box("box", box)
        extent = box[1] - box[0]
        voxel = extent.max() / resolution
        voxels = cubic_voxels(extent, resolution)
        _require_room("DenseGrid.empty", voxels, np.dtype(dtype).itemsize)
        shape = np.array(voxels)
        center = box.mean(axis=0)
        lo, hi = center - shape * voxel / 2, center + shape * voxel / 2
        scale = float((finest or resolution) / extent.max())
        policy = MarchPolicy(
            (tuple(lo.tolist()), tuple(hi.tolist())), voxel / steps_per_voxel, density_scale=scale
        )
        values = np.full((*shape, 4), log(START_COLOR / (1 - START_COLOR)), dtype)
        values[..., 3] = log(expm1(sigma_t / scale))
        return cls(values, policy)

    @property
    def color(self) -> Array:
        """View (X, Y, Z, 3) of the raw color."""
        return self.params["values"][..., :3]

    @property
    def density(self) -> Array:
        """View (X, Y, Z) of the raw density."""
        return self.params["values"][..., 3]

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Voxels along X, Y and Z, and the numbers of each."""
        x, y, z, c = self.params["values"].shape
        return x, y, z, c

    def density_rows(self, groups: Mapping[str, Array]) -> Array:
        """(X Y Z,) in C order."""
        rows: Array = groups["values"][..., 3].ravel()
        return rows

    def to_voxels(self, rows: Array) -> Array:
        """Rows (X Y Z,) as (X, Y, Z)."""
        return rows.reshape(self.voxel_shape)

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Nearly empty space in the box, at the coarsest level of the options."""
        options = start.options
        field = cls.empty(
            start.bounds.box,
            options.levels()[0],
            finest=options.resolution,
            sigma_t=options.sigma_t,
            steps_per_voxel=options.steps_per_voxel,
        )
        return field, f"box: {start.bounds.rule}"

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """The values."""
        del options
        return {"values": (FLOAT, ("X", "Y", "Z", 4))}, {}

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The grid of a checkpoint."""
        del state, options
        return cls(params["values"], from_plain("checkpoint", MarchPolicy, policy))

    @classmethod
    def channels(cls, options: FitOptions) -> int:
        """Color and density."""
        del options
        return 4

    def resampled(self, rows: Array, to: Self) -> Array:
        """Values on this grid, such as an optimizer's, on the grid of another."""
        x, y, z = to.params["values"].shape[:3]
        return upsample_trilinear(rows, (x, y, z))

    def add_prior(self, gradients: Mapping[str, Array], weight: float, u: float) -> None:
        """Add total variation's gradient on a slab of an eighth, which stands for the whole.

        `u` in [0, 1) says where the slab lies.
        """
        values = self.params["values"]
        planes = max(2, len(values) // 8)
        start = int(u * (len(values) - planes + 1))
        priors.total_variation_squared_backward(
            values[start : start + planes], weight, gradients["values"][start : start + planes]
        )

    def refined(self, resolution: int, *, steps_per_voxel: float = 2.0) -> Self:
        """The same field on a finer grid over the same box, by trilinear interpolation.

        Raises RangeError for fewer than 2 voxels, or more than memory holds.
        """
        x, y, z = finer_voxels("DenseGrid.refined", self.box, resolution)
        _require_room("DenseGrid.refined", [x, y, z], self.params["values"].itemsize)
        voxel = (self.box[1] - self.box[0]).max() / resolution
        values = upsample_trilinear(self.params["values"], (x, y, z))
        return type(self)(
            values, replace(self.policy, dt=voxel / steps_per_voxel), fused=self.fused
        )

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> DenseGrid:
        """5 x 4 x 6 voxels with random values over a box that is no cube."""
        index = np.arange(5 * 4 * 6 * 4)
        values = 2 * uniform(seed, step=0, pixel=index, sample=0, dimension=0) - 1
        policy = MarchPolicy(((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)), 0.11)
        return cls(values.reshape(5, 4, 6, 4).astype(dtype), policy)

    def example_batch(self, *, seed: int) -> RayBatch:
        """24 rays from a sphere of radius 3 m towards points inside of the box."""
        count = 24
        pixel = np.arange(count, dtype=np.uint32)
        u = np.stack(
            [uniform(seed, step=1, pixel=pixel, sample=0, dimension=k) for k in range(6)], -1
        )
        outward = u[:, :3] - 0.5
        origins = 3.0 * outward / np.linalg.norm(outward, axis=1, keepdims=True)
        lo, hi = self.box
        target = lo + (0.2 + 0.6 * u[:, 3:]) * (hi - lo)
        directions = target - origins
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return RayBatch(origins, directions, pixel)

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """One group. Adam moves an entry by about its rate, sigma_t by density_scale times it."""
        shape = self.params["values"].shape
        return {"values": ParamSpec(shape, "1", (-10.0, 1e4), 0.5, "grid")}

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, MarchContext]:
        """Color (R, 3) linear, premultiplied, without background; opacity (R,); depth (R,) m."""
        return march(
            "dense_grid",
            self.params["values"],
            self.policy,
            batch,
            options,
            seed=seed,
            step=step,
            fused=self.fused,
        )

    def render_backward(self, context: MarchContext, d_outputs: Outputs) -> dict[str, Array]:
        """{"values": (X, Y, Z, 4)}, and "origins", "directions" (R, 3) if the options asked."""
        gradients = march_backward(context, d_outputs)
        gradients["values"] = gradients.pop("parameters")
        return gradients

    def priors(self) -> Sequence[Prior]:
        """Total variation of the raw values: neighbors should agree."""
        return (
            Prior(
                "total_variation",
                "values",
                priors.total_variation_squared,
                priors.total_variation_squared_backward,
            ),
        )

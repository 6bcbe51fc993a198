"""A toy: a picture as a sum of round Gaussian blobs, some of which disappear while it is fitted.

    color(p) = sum_n c_n w_n,   w_n = exp(-q_n / 2),   q_n = |p - m_n|^2 / r_n^2,   r_n = exp(s_n)

With e_n = c_n . d_color:

    dc_n = w_n d_color      dm_n = e_n w_n (p - m_n) / r_n^2      ds_n = e_n w_n q_n
    dp   = -sum_n e_n w_n (p - m_n) / r_n^2

each summed over the points. It shows what grids do not need: rows that `refine` prunes, with the
map by which an optimizer follows, and gradients of a few rows only, as (rows, values).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from photograd_course import priors
from photograd_course.optim import Gradient
from photograd_course.portable_math import exp, log
from photograd_course.random import uniform
from photograd_course.row_map import RowMap

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.representation import (
    CanvasBatch,
    Outputs,
    ParamSpec,
    Prior,
    RenderOptions,
    Representation,
    register,
)
from photograd.types import Array


@dataclass(frozen=True)
class BlobContext:
    """What the backward pass needs; its arrays are those of the rendering, whatever came later."""

    params: dict[str, Array]
    points: Array
    offset: Array  # (P, N, 2) from each mean to each point, in radii
    weight: Array  # (P, N)
    camera_adjoint: bool


@register
class ToyBlobs(Representation):
    """params: "mean" (N, 2) on the canvas, "log_radius" (N,) of canvas units, "color" (N, 3).

    `reach` in radii cuts each blob off, so that a blob far from all points gets no gradient row;
    None is off. The cut is held fixed: a step of height exp(-reach^2 / 2) is left where it lies.
    """

    name: ClassVar[str] = "toy_blobs"
    capabilities: ClassVar[frozenset[str]] = frozenset({"canvas2d"})
    teaching_example: ClassVar[str] = "it lives on a 2D canvas"

    def __init__(
        self,
        mean: Array,
        log_radius: Array,
        color: Array,
        *,
        reach: float | None = None,
        faint: float = 0.02,
    ) -> None:
        """`faint`: `refine` removes blobs whose brightest channel is below it, in magnitude.

        Raises ShapeError unless the arrays are (N, 2), (N,) and (N, 3) with N >= 1, DtypeError
        unless all are float32 or all float64; RangeError for a `reach` that is not positive.

        Args:
            mean: (N, 2) on the canvas.
            log_radius: (N,).
            color: (N, 3).
            reach: radii beyond which a blob is not drawn; None draws all.
            faint: see above.
        """
        call = Arguments("ToyBlobs")
        arrays = {
            "mean": call.array("mean", mean, ("N", 2), finite=False, min_length=1),
            "log_radius": call.array("log_radius", log_radius, ("N",), finite=False),
            "color": call.array("color", color, ("N", 3), finite=False),
        }
        if reach is not None:
            call.number("reach", reach, above=0)
        self.params = arrays
        self.reach = reach
        self.faint = faint
        self.pruned = 0  # how many blobs refine() has removed so far

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> ToyBlobs:
        """Nine blobs of a tenth to a quarter of the canvas; every third is too faint to stay."""
        index = np.arange(9)
        u = np.stack([uniform(seed, step=0, pixel=index, dimension=k) for k in range(6)], axis=-1)
        color = np.where(index[:, None] % 3 == 1, 0.015, 0.8) * (0.2 + 0.8 * u[:, 3:])
        arrays = (0.1 + 0.8 * u[:, :2], log(0.1 + 0.15 * u[:, 2]), color)
        return cls(*(array.astype(dtype) for array in arrays))

    def example_batch(self, *, seed: int) -> CanvasBatch:
        """60 points all over the canvas."""
        index = np.arange(60)
        points = [uniform(seed, step=1, pixel=index, dimension=k) for k in range(2)]
        return CanvasBatch(np.stack(points, axis=-1))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Three groups with a row a blob."""
        shape = {name: array.shape for name, array in self.params.items()}
        return {
            "mean": ParamSpec(shape["mean"], "canvas", (0.0, 1.0), 0.005, "canvas"),
            "log_radius": ParamSpec(shape["log_radius"], "1", (-6.0, 0.0), 0.01, "none"),
            "color": ParamSpec(shape["color"], "1", (-1.0, 1.0), 0.01, "none"),
        }

    def render(
        self, batch: CanvasBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, BlobContext]:
        """Color (P, 3) at the points, linear; a canvas has neither opacity nor depth."""
        del seed, step  # nothing random here
        mean, log_radius, color = (self.params[name] for name in ("mean", "log_radius", "color"))
        points = np.asarray(batch.points, mean.dtype)
        offset = (points[:, None, :] - mean) / exp(log_radius)[:, None]
        q = np.einsum("pnk,pnk->pn", offset, offset)
        weight = exp(-q / 2)
        if self.reach is not None:
            weight *= q <= self.reach * self.reach
        params = {name: array.copy() for name, array in self.params.items()}
        context = BlobContext(params, points, offset, weight, options.camera_adjoint)
        outputs = Outputs(np.einsum("pn,nc->pc", weight, color))
        return outputs.checked("ToyBlobs.render", batch), context

    def render_backward(self, context: BlobContext, d_outputs: Outputs) -> dict[str, Gradient]:
        """(rows, values) of each group, and "points" (P, 2) dense if the options asked.

        Rows are the blobs that reach some point; einsum adds over the points in their order.
        """
        color = context.params["color"]
        radius = exp(context.params["log_radius"])
        d_color = np.asarray(d_outputs.color, color.dtype)
        e = np.einsum("pc,nc->pn", d_color, color) * context.weight
        pull = e[..., None] * context.offset / radius[:, None]  # (P, N, 2)
        dense = {
            "mean": pull.sum(axis=0),
            "log_radius": np.einsum("pn,pnk,pnk->n", e, context.offset, context.offset),
            "color": np.einsum("pn,pc->nc", context.weight, d_color),
        }
        rows = np.flatnonzero(context.weight.any(axis=0))
        gradients: dict[str, Gradient] = {name: (rows, d[rows]) for name, d in dense.items()}
        if context.camera_adjoint:
            gradients["points"] = -pull.sum(axis=1)
        return gradients

    def priors(self) -> Sequence[Prior]:
        """Few bright blobs rather than many faint ones."""
        return (
            Prior(
                "sparsity",
                "color",
                partial(priors.sparsity_cauchy, scale=0.1),
                partial(priors.sparsity_cauchy_backward, scale=0.1),
            ),
        )

    def refine(self, step: int, statistics: Mapping[str, Array]) -> RowMap | None:
        """Remove the faint blobs; at least the brightest one stays."""
        del step, statistics  # brightness is all that counts here
        brightness = np.abs(self.params["color"]).max(axis=1)
        stays: NDArray[np.bool_] = brightness >= min(self.faint, brightness.max())
        if stays.all():
            return None
        row_map = RowMap(np.flatnonzero(stays).astype(np.int64), source_count=len(stays))
        self.params = {name: row_map.apply(array) for name, array in self.params.items()}
        self.pruned += int((~stays).sum())
        return row_map

    def state(self) -> dict[str, Array]:
        """{"pruned": ()}: how many blobs are gone."""
        return {"pruned": np.array(self.pruned, np.int64)}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Raises RangeError unless `state` is one that `state()` returned."""
        if set(state) != {"pruned"}:
            raise RangeError(
                message("ToyBlobs.load_state", "state", "['pruned']", f"{sorted(state)}")
            )
        self.pruned = int(state["pruned"])

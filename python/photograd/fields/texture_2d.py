"""A picture to be recovered from samples of it: texels T[row, column], bilinear in between.

Texel (row, column) has its center at ((column + 0.5) / W, (row + 0.5) / H) of the canvas, v points
down, and outside of the outermost centers the border value continues. Lookup and adjoint are those
of `photograd.textures`, derived in cpp/photograd/ops/bilinear.h.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd.representation import (
    CanvasBatch,
    Outputs,
    ParamSpec,
    RenderOptions,
    Representation,
    register,
)
from photograd.textures import sample, sample_backward
from photograd.types import Array


@dataclass(frozen=True)
class CanvasContext:
    """What the backward pass of a canvas needs: its parameters and points, as they were."""

    params: dict[str, Array]
    points: Array
    camera_adjoint: bool


@register
class Texture2D(Representation):
    """params["texels"] (H, W, 3): linear color of each texel, itself the value at its center."""

    name: ClassVar[str] = "texture_2d"
    capabilities: ClassVar[frozenset[str]] = frozenset({"canvas2d"})
    teaching_example: ClassVar[str] = "it lives on a 2D canvas"

    def __init__(self, texels: Array) -> None:
        """Raises ShapeError unless texels is (H, W, 3), DtypeError unless it is a float array."""
        call = Arguments("Texture2D")
        texels = call.array("texels", texels, ("H", "W", 3), finite=False, min_length=1)
        self.params = {"texels": texels}

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Texture2D:
        """5 rows of 7 random texels."""
        texels = uniform(seed, step=0, pixel=np.arange(5 * 7 * 3), sample=0, dimension=0)
        return cls(texels.reshape(5, 7, 3).astype(dtype))

    def example_batch(self, *, seed: int) -> CanvasBatch:
        """60 points all over the canvas, a few of them beyond the outermost texel centers."""
        index = np.arange(60)
        points = [uniform(seed, step=1, pixel=index, sample=0, dimension=k) for k in range(2)]
        return CanvasBatch(np.stack(points, axis=-1))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """One group."""
        return {"texels": ParamSpec(self.params["texels"].shape, "1", (0.0, 1.0), 0.02, "canvas")}

    def render(
        self, batch: CanvasBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, CanvasContext]:
        """Color (N, 3) at the points; a canvas has neither opacity nor depth."""
        del seed, step  # nothing random here
        texels = self.params["texels"]
        points = np.asarray(batch.points, texels.dtype)
        context = CanvasContext(dict(self.params), points, options.camera_adjoint)
        return Outputs(sample(texels, points)).checked("Texture2D.render", batch), context

    def render_backward(self, context: CanvasContext, d_outputs: Outputs) -> dict[str, Array]:
        """{"texels": (H, W, 3)}, and "points" (N, 2) if the options asked."""
        texels = context.params["texels"]
        d_color = np.asarray(d_outputs.color, texels.dtype)
        d_texels, d_points = sample_backward(texels, context.points, d_color)
        return {"texels": d_texels} | ({"points": d_points} if context.camera_adjoint else {})

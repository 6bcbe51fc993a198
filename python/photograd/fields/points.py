"""A cloud of points with a radius each: the simplest thing that can be fitted in 3D.

A ray sees a point by the distance at which it passes: with r = exp(log_radius),

    alpha = opacity * exp(-distance^2 / (2 r^2))

and blends what it sees front to back, in the order in which it passes the middles. The falloff is
Gaussian, so that a point is a round Gaussian whose three scales are one number, whose rotation
means nothing, and whose opacity is given: everything below is `photograd.splats.rays`. A hard disc
would have no derivative with respect to position or radius anywhere but at its rim.

    d log_radius = sum of d log_scales over the axes (and over the points, of a shared radius)
    d color      = d sh_0 / Y_0,  since color = 1/2 + Y_0 sh_0
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from photograd_course.portable_math import log
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd.representation import (
    Outputs,
    ParamSpec,
    RayBatch,
    RenderOptions,
    Representation,
    register,
)
from photograd.sh import Y_0
from photograd.splats.rays import RayContext, RayOptions, render, render_backward
from photograd.splats.splatting import Gaussians
from photograd.types import Array


@dataclass(frozen=True)
class PointContext:
    """What the backward pass needs."""

    rays: RayContext
    shared_radius: bool
    camera_adjoint: bool


@register
class Points(Representation):
    """params: "position" (N, 3) in meters, "color" (N, 3), "log_radius" (N,), or (1,) for all.

    Colors are linear; below 0 they are drawn as 0 and have no gradient.
    """

    name: ClassVar[str] = "points"
    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})
    teaching_example: ClassVar[str] = "start it from Python, with parameters of your own"

    def __init__(
        self,
        position: Array,
        color: Array,
        log_radius: Array,
        *,
        opacity: float = 0.95,
        alpha_min: float = 1 / 255,
    ) -> None:
        """`opacity` in the middle of every point; what is fainter than `alpha_min` is not drawn.

        Args:
            position: (N, 3) in meters.
            color: (N, 3).
            log_radius: (N,), or (1,) for all.
            opacity: in (0, 1).
            alpha_min: in [0, 0.5].

        Raises:
            ShapeError: the arrays are not (N, 3), (N, 3) and (N,) or (1,), N >= 1.
            DtypeError: they are not all float32 or all float64.
            RangeError: opacity is not within (0, 1), or alpha_min not within [0, 0.5].
        """
        call = Arguments("Points")
        arrays = {
            "position": call.array("position", position, ("N", 3), finite=False, min_length=1),
            "color": call.array("color", color, ("N", 3), finite=False),
            "log_radius": call.array("log_radius", log_radius, ("N",), (1,), finite=False),
        }
        call.number("opacity", opacity, above=0, below=1)
        RayOptions(alpha_min=alpha_min)  # checks it
        self.params = arrays
        self.opacity = opacity
        self.alpha_min = alpha_min

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Points:
        """Twelve points of 0.15 to 0.4 m in a box of 2 m, each of which all rays see a little."""
        index = np.arange(12)
        u = np.stack([uniform(seed, step=0, pixel=index, dimension=k) for k in range(7)], axis=-1)
        arrays = (2 * u[:, :3] - 1, 0.1 + 0.8 * u[:, 3:6], log(0.15 + 0.25 * u[:, 6]))
        return cls(*(array.astype(dtype) for array in arrays), alpha_min=0.0)

    def example_batch(self, *, seed: int) -> RayBatch:
        """40 rays from 3 m in front to all over the box."""
        index = np.arange(40)
        u = np.stack([uniform(seed, step=1, pixel=index, dimension=k) for k in range(5)], axis=-1)
        origins = np.column_stack([0.4 * u[:, :2] - 0.2, np.full(40, -3.0)])
        directions = 2 * u[:, 2:] - 1 - origins
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return RayBatch(origins, directions, index.astype(np.uint32))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Three groups with a row a point, or a single shared radius."""
        shape = {name: array.shape for name, array in self.params.items()}
        return {
            "position": ParamSpec(shape["position"], "m", (-np.inf, np.inf), 0.005, "world"),
            "color": ParamSpec(shape["color"], "1", (0.0, 1.0), 0.02, "none"),
            "log_radius": ParamSpec(shape["log_radius"], "1", (-10.0, 3.0), 0.01, "none"),
        }

    def gaussians(self) -> Gaussians:
        """The same points as round Gaussians, for the renderers of `photograd.splats`."""
        position, color = self.params["position"], self.params["color"]
        count, dtype = len(position), position.dtype
        log_scales = np.broadcast_to(self.params["log_radius"][:, None], (count, 3))
        logit = log(self.opacity / (1 - self.opacity))
        return Gaussians(
            position.copy(),
            np.ascontiguousarray(log_scales),
            np.tile(np.array([1, 0, 0, 0], dtype), (count, 1)),
            np.full(count, logit, dtype),
            (color[:, None] - dtype.type(0.5)) / dtype.type(Y_0),
        )

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, PointContext]:
        """Color (R, 3), opacity (R,) and depth (R,)."""
        del seed, step  # nothing random here
        # Held at 1, never: a point's own opacity is below.
        policies = RayOptions(alpha_min=self.alpha_min, alpha_max=1.0, stop=options.stop)
        picture, rays = render(self.gaussians(), batch.origins, batch.directions, options=policies)
        shared = len(self.params["log_radius"]) < len(self.params["position"])
        context = PointContext(rays, shared, options.camera_adjoint)
        return Outputs(picture.color, picture.opacity, picture.depth), context

    def render_backward(self, context: PointContext, d_outputs: Outputs) -> dict[str, Array]:
        """All groups, dense; "origins" and "directions" (R, 3) if the options asked."""
        dtype = context.rays.gaussians.means.dtype
        found = render_backward(
            context.rays,
            *(None if d is None else np.asarray(d, dtype) for d in vars(d_outputs).values()),
            rays=context.camera_adjoint,
        )
        d_radius = found.gaussians["log_scales"].sum(axis=1)
        gradients = {
            "position": found.gaussians["means"],
            "color": found.gaussians["sh"][:, 0] / dtype.type(Y_0),
            "log_radius": d_radius.sum(keepdims=True) if context.shared_radius else d_radius,
        }
        if found.origins is not None and found.directions is not None:
            gradients |= {"origins": found.origins, "directions": found.directions}
        return gradients

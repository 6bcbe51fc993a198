"""A picture of Gaussians on a flat canvas, blended in order: 3D Gaussian splatting without the 3D.

Gaussian n has a mean m, standard deviations s = exp(log_scale) along two axes, of which the first
is turned by the angle theta from the canvas' x towards its y, an opacity o = sigmoid(logit) and a
color c. The first row lies on top. At a point x, with d = x - m,

    (a, b)  = ((d_x cos + d_y sin) / s_0,  (-d_x sin + d_y cos) / s_1)
    alpha_n = o_n exp(-(a^2 + b^2) / 2)
    T_n     = product of 1 - alpha_j over j < n (exclusive!),   w_n = T_n alpha_n
    color   = sum w_n c_n,   opacity = 1 - T_end

What a third dimension adds is a camera, which makes these ellipses of ellipsoids, and depth, which
decides the order [Kerbl2023]. The adjoint is the same: with v_n = <d_color, c_n>,

    d_alpha_n = T_n v_n - (sum_{j>n} w_j v_j - d_opacity T_end) / (1 - alpha_n),  e = alpha d_alpha
    d_m       = sum over points of e (a / s_0 x_axis + b / s_1 y_axis)
    d_log_s   = sum e (a^2, b^2),   d_theta = sum e a b (s_0 / s_1 - s_1 / s_0)
    d_logit   = sum e (1 - o),      d_c = sum w d_color,      d_x = -sum over n of what d_m sums

The order of rows is not differentiated: no gradient says that two Gaussians should change places.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from photograd_course import portable_math as pm
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
from photograd.types import Array

SLAB = 1 << 17  # pairs of point and Gaussian at a time: arrays that stay in the cache


@dataclass(frozen=True)
class CanvasContext:
    """Parameters and points as they were; what lies between is computed again, slab by slab."""

    params: dict[str, Array]
    points: Array
    camera_adjoint: bool


@dataclass(frozen=True)
class Blend:
    """P points over N Gaussians: (P, N) each, but `end` (P,)."""

    a: Array
    b: Array
    alpha: Array
    front: Array  # T_n
    end: Array  # T behind the last

    @classmethod
    def of(cls, params: Mapping[str, Array], points: Array) -> Blend:
        """The formulas above.

        Args:
            params: by group.
            points: (P, 2).
        """
        d = points[:, None] - params["mean"]
        cos, sin = pm.cos(params["angle"]), pm.sin(params["angle"])
        inverse = pm.exp(-params["log_scale"])
        a = (d[..., 0] * cos + d[..., 1] * sin) * inverse[:, 0]
        b = (d[..., 1] * cos - d[..., 0] * sin) * inverse[:, 1]
        alpha = opacity_of(params) * pm.exp(-0.5 * (a * a + b * b))
        behind = np.cumprod(1 - alpha, axis=1)
        front = np.concatenate([np.ones_like(behind[:, :1]), behind[:, :-1]], axis=1)
        return cls(a, b, alpha, front, behind[:, -1])


def opacity_of(params: Mapping[str, Array]) -> Array:
    """sigmoid(opacity_logit), (N,).

    Args:
        params: by group.
    """
    e = pm.exp(-np.abs(params["opacity_logit"]))  # cannot overflow
    return np.asarray(np.where(params["opacity_logit"] < 0, e, 1) / (1 + e))


@register
class Gaussians2D(Representation):
    """params of N Gaussians, the top one first: "mean" (N, 2) on the canvas, "log_scale" (N, 2) of
    canvas units, "angle" (N,) in radians, "opacity_logit" (N,), "color" (N, 3).
    """

    name: ClassVar[str] = "gaussians_2d"
    capabilities: ClassVar[frozenset[str]] = frozenset({"canvas2d"})
    teaching_example: ClassVar[str] = "it lives on a 2D canvas"

    def __init__(
        self, mean: Array, log_scale: Array, angle: Array, opacity_logit: Array, color: Array
    ) -> None:
        """Raises ShapeError unless the arrays have the shapes above with N >= 1, DtypeError unless
        all are float32 or all float64.

        Args:
            mean: (N, 2) on the canvas.
            log_scale: (N, 2) logarithms of the standard deviations.
            angle: (N,) in radians.
            opacity_logit: (N,).
            color: (N, 3).
        """
        call = Arguments("Gaussians2D")
        self.params = {
            "mean": call.array("mean", mean, ("N", 2), finite=False, min_length=1),
            "log_scale": call.array("log_scale", log_scale, ("N", 2), finite=False),
            "angle": call.array("angle", angle, ("N",), finite=False),
            "opacity_logit": call.array("opacity_logit", opacity_logit, ("N",), finite=False),
            "color": call.array("color", color, ("N", 3), finite=False),
        }

    @classmethod
    def scattered(
        cls, count: int, *, seed: int, dtype: type[np.floating[Any]] = np.float32
    ) -> Gaussians2D:
        """Round, gray and half transparent, anywhere on the canvas: a start for a fit.

        Together they are as large as the canvas: each has a radius of 1 / sqrt(pi count).

        Args:
            count: N.
            seed: of the places.
            dtype: np.float32 or np.float64.
        """
        index = np.arange(count)
        mean = np.stack([uniform(seed, step=0, pixel=index, dimension=k) for k in range(2)], -1)
        size = np.full((count, 2), -0.5 * pm.log(np.pi * count))
        arrays = (mean, size, np.zeros(count), np.zeros(count), np.full((count, 3), 0.5))
        return cls(*(array.astype(dtype) for array in arrays))

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Gaussians2D:
        """Nine Gaussians of all shapes."""
        index = np.arange(9)
        u = np.stack([uniform(seed, step=0, pixel=index, dimension=k) for k in range(9)], axis=-1)
        arrays = (
            0.1 + 0.8 * u[:, :2],
            pm.log(0.08 + 0.25 * u[:, 2:4]),
            6 * u[:, 4],
            4 * u[:, 5] - 2,
            0.1 + 0.8 * u[:, 6:],
        )
        return cls(*(array.astype(dtype) for array in arrays))

    def example_batch(self, *, seed: int) -> CanvasBatch:
        """60 points all over the canvas."""
        index = np.arange(60)
        points = [uniform(seed, step=1, pixel=index, dimension=k) for k in range(2)]
        return CanvasBatch(np.stack(points, axis=-1))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Five groups with a row a Gaussian."""
        shape = {name: array.shape for name, array in self.params.items()}
        return {
            "mean": ParamSpec(shape["mean"], "canvas", (0.0, 1.0), 0.002, "canvas"),
            "log_scale": ParamSpec(shape["log_scale"], "1", (-7.0, 0.0), 0.02, "none"),
            "angle": ParamSpec(shape["angle"], "rad", (-np.inf, np.inf), 0.02, "canvas"),
            "opacity_logit": ParamSpec(shape["opacity_logit"], "1", (-8.0, 8.0), 0.05, "none"),
            "color": ParamSpec(shape["color"], "1", (0.0, 1.0), 0.01, "none"),
        }

    def _slabs(self, count: int) -> Iterator[slice]:
        size = max(SLAB // len(self.params["mean"]), 1)
        return (slice(first, first + size) for first in range(0, count, size))

    def render(
        self, batch: CanvasBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, CanvasContext]:
        """Color (P, 3) and opacity (P,) at the points; a canvas has no depth."""
        del seed, step  # nothing random here
        params = {name: array.copy() for name, array in self.params.items()}
        points = np.asarray(batch.points, params["mean"].dtype)
        color, opacity = np.empty((len(points), 3), points.dtype), np.empty_like(points[:, 0])
        for part in self._slabs(len(points)):
            k = Blend.of(params, points[part])
            color[part] = np.einsum("pn,nc->pc", k.front * k.alpha, params["color"])
            opacity[part] = 1 - k.end
        context = CanvasContext(params, points, options.camera_adjoint)
        return Outputs(color, opacity).checked("Gaussians2D.render", batch), context

    def render_backward(self, context: CanvasContext, d_outputs: Outputs) -> dict[str, Array]:
        """All groups, dense, and "points" (P, 2) if the options asked."""
        params, points = context.params, context.points
        d_color = np.asarray(d_outputs.color, points.dtype)
        d_opacity = np.zeros_like(points[:, 0])
        if d_outputs.opacity is not None:
            d_opacity = np.asarray(d_outputs.opacity, points.dtype)
        gradients = {name: np.zeros_like(array) for name, array in params.items()}
        d_points = np.empty_like(points)
        for part in self._slabs(len(points)):
            k = Blend.of(params, points[part])
            d_points[part] = _add_slab(params, k, d_color[part], d_opacity[part], gradients)
        return gradients | ({"points": d_points} if context.camera_adjoint else {})


def _add_slab(
    params: Mapping[str, Array], k: Blend, d_color: Array, d_opacity: Array, out: dict[str, Array]
) -> Array:
    """Adds a slab's derivatives to `out`, and returns those by its points (P, 2)."""
    w = k.front * k.alpha
    v = np.einsum("pc,nc->pn", d_color, params["color"])
    passed = np.cumsum(w * v, axis=1)
    behind = passed[:, -1:] - passed - (d_opacity * k.end)[:, None]
    # Fully opaque is possible; nothing behind it counts.
    e = k.alpha * (k.front * v - behind / np.maximum(1 - k.alpha, 1e-6))
    ea, eb = e * k.a, e * k.b
    s = pm.exp(params["log_scale"])
    cos, sin = pm.cos(params["angle"]), pm.sin(params["angle"])
    x_axis, y_axis = (
        np.stack([cos, sin], axis=-1) / s[:, :1],
        np.stack([-sin, cos], axis=-1) / s[:, 1:],
    )
    out["mean"] += ea.sum(axis=0)[:, None] * x_axis + eb.sum(axis=0)[:, None] * y_axis
    out["log_scale"] += np.stack([(ea * k.a).sum(axis=0), (eb * k.b).sum(axis=0)], axis=-1)
    out["angle"] += (ea * k.b).sum(axis=0) * (s[:, 0] / s[:, 1] - s[:, 1] / s[:, 0])
    out["opacity_logit"] += e.sum(axis=0) * (1 - opacity_of(params))
    out["color"] += np.einsum("pn,pc->nc", w, d_color)
    pulled = np.einsum("pn,nk->pk", ea, x_axis) + np.einsum("pn,nk->pk", eb, y_axis)
    return np.asarray(-pulled)

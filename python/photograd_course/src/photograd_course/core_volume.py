"""The C++ core's volume renderer behind the faces of assignment 08, for scripts that compare."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]
Render = Callable[[Array, Array, Array, Array, Array, int, Array], Array]
Adjoint = Callable[[Array, Array, Array, Array, Array, int, Array, Array], tuple[Array, Array]]


def core_volume() -> tuple[Render, Adjoint]:
    """``render_rays`` and ``render_adjoint`` of assignment 08, by the core.

    Steps have equal lengths, the longest edge of the box over the number of steps, where assignment
    08 takes equal numbers of steps; they agree where all rays are as long in the box.

    Returns:
        (image, adjoint): of a grid, the corners of its box, origins, directions, the number of
        steps and the background; the second also of the derivative with respect to each pixel.

    Raises:
        ImportError, AttributeError, TypeError: the core is not installed, or is another one.
    """
    grids = importlib.import_module("photograd.fields.dense_grid")
    marches = importlib.import_module("photograd.fields.march")
    base = importlib.import_module("photograd.representation")

    def forward(
        grid: Array, low: Array, high: Array, o: Array, d: Array, n: int
    ) -> tuple[Any, ...]:
        policy = marches.MarchPolicy(
            box=(tuple(low), tuple(high)),
            dt=float(np.max(high - low)) / n * (1 - 1e-12),
            lattice="entry",
            density_activation="identity",
            color_activation="identity",
        )
        aims = d / np.linalg.norm(d, axis=1, keepdims=True)
        batch = base.RayBatch(np.ascontiguousarray(o), aims, np.arange(len(o), dtype=np.uint32))
        field = grids.DenseGrid(grid.copy(), policy)
        out, context = field.render(batch, options=base.RenderOptions(), seed=0, step=0)
        return field, context, np.asarray(out.color), 1 - np.asarray(out.opacity).reshape(-1, 1)

    def image(
        grid: Array, low: Array, high: Array, o: Array, d: Array, n: int, background: Array
    ) -> Array:
        # The core leaves the background out.
        _, _, color, through = forward(grid, low, high, o, d, n)
        return np.asarray(color + through * background)

    def adjoint(
        grid: Array,
        low: Array,
        high: Array,
        o: Array,
        d: Array,
        n: int,
        background: Array,
        d_pixel: Array,
    ) -> tuple[Array, Array]:
        field, context, _, through = forward(grid, low, high, o, d, n)
        back = base.Outputs(d_pixel, -(d_pixel @ background), None)
        d_grid = np.asarray(field.render_backward(context, back)["values"])
        return d_grid.reshape(grid.shape), np.asarray(np.sum(through * d_pixel, axis=0))

    corner, ray = np.ones(3), np.ones((1, 3))
    image(np.zeros((2, 2, 2, 4)), -corner, corner, -2 * ray, ray, 4, corner)
    return image, adjoint

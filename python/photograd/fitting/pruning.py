"""Which voxels of a sparse grid a fit drops: those without weight that do not want density either.

A voxel stays if it weighs something in some pixel of some view, or if the loss would fall for more
density in it: dL/d density is below -`WANTED` times the greatest |dL/d density|. Their neighbors
stay, too. The weight alone would drop voxels that matter is about to grow into.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from photograd_course.row_map import RowMap

from photograd.fields.sparse_sh import SparseSh
from photograd.fitting.pixels import TrainingPixels
from photograd.types import Array

WEIGHT_RAYS = 1 << 20
"""From all views; what they do not need is dropped."""
GRADIENT_RAYS = 1 << 17
"""From all views, for the gradient, of which a ray costs as much as two weights."""
WANTED = 0.05
"""Of the greatest |dL/d density|: below, a wish for density is noise of the photographs."""

_RAYS_AT_ONCE = 1 << 16
LossAndGradients = Callable[[NDArray[np.int64]], tuple[float, dict[str, Array]]]


def prune_voxels(
    field: SparseSh,
    pixels: TrainingPixels,
    loss_and_gradients: LossAndGradients,
    *,
    threshold: float,
    step: int,
) -> RowMap | None:
    """Drop voxels from `field` in place; returns where each row that is left came from.

    `loss_and_gradients` takes numbers of pixels; `threshold` is the weight that is enough.
    """
    weight = field.greatest_weights(pixels.batches(WEIGHT_RAYS))
    wanted = wants_density(density_gradient(pixels, loss_and_gradients))
    statistics = {"weight": weight, "threshold": np.array(threshold), "wanted": wanted}
    return field.refine(step, statistics)


def density_gradient(
    pixels: TrainingPixels, loss_and_gradients: LossAndGradients, *, most: int = GRADIENT_RAYS
) -> Array:
    """dL/d density (N,) of the loss over all views, from about `most` evenly spaced pixels."""
    chosen = np.arange(0, len(pixels), max(1, -(-len(pixels) // most)))
    starts = range(0, len(chosen), _RAYS_AT_ONCE)
    parts = (chosen[start : start + _RAYS_AT_ONCE] for start in starts)
    share = 1 / len(chosen)
    return np.asarray(
        sum(len(part) * share * loss_and_gradients(part)[1]["density"] for part in parts)
    )


def wants_density(d_density: Array) -> NDArray[np.bool_]:
    """(N,) where the loss would clearly fall for more density."""
    return np.asarray(d_density < -WANTED * np.abs(d_density).max(initial=0.0))

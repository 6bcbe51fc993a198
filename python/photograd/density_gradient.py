"""dL/dsigma_t in every voxel: what the photographs ask of the space they see.

From a nearly transparent start the loss wants density where matter must appear (gradient negative)
and less of it where cameras see only background (positive). Elsewhere, in front of matter or hidden
by it, either sign may occur.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from photograd.backgrounds import random_background
from photograd.data.capture import Capture
from photograd.data.view import View
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.imaging import image_loss, image_loss_backward
from photograd.pixels import TrainingPixels
from photograd.representation import Array, RenderOptions

RAYS_AT_ONCE = 1 << 16
OPAQUE, EMPTY = 0.99, 0.01  # alpha of pixels that count as matter, as background


@dataclass(frozen=True)
class DensityGradient:
    """dL/dsigma_t (X, Y, Z) in units of loss * m, and the loss it belongs to."""

    d_sigma_t: Array
    loss: float


def density_gradient(
    field: DenseGrid,
    pixels: TrainingPixels,
    *,
    seed: int,
    background: Array | None = None,
    rays: int = 1 << 20,
) -> DensityGradient:
    """The loss over `rays` random training pixels and its gradient with respect to sigma_t.

    Each ray gets a random background unless one (3,) is given: over one fixed background, matter of
    the background's colour would be invisible and its gradient zero.
    """
    chosen = pixels.draw(rays, seed=seed, step=0)
    display = pixels.color_space == "display"
    total, loss = np.zeros(field.params["values"].shape[:3]), 0.0
    for start in range(0, rays, RAYS_AT_ONCE):
        part = chosen[start : start + RAYS_AT_ONCE]
        behind = background
        if behind is None:
            behind = random_background(len(part), seed=seed, step=0, first=start)
        outputs, context = field.render(
            pixels.rays(part), seed=seed, step=0, options=RenderOptions(jitter=True)
        )
        result = image_loss(outputs, pixels.premultiplied[part], behind, display=display)
        d_outputs, _ = image_loss_backward(result)
        share = len(part) / rays
        total += share * field.render_backward(context, d_outputs)["values"][..., 3]
        loss += share * result.value
    # The chain rule backwards through sigma_t = scale * softplus(raw), at the voxel centres.
    slope = field.policy.density_scale / (1 + np.exp(-field.density.astype(np.float64)))
    return DensityGradient((total / np.maximum(slope, 1e-12)).astype(np.float32), loss)


@dataclass(frozen=True)
class VoxelMasks:
    """Voxels (X, Y, Z) inside of every silhouette, and those all cameras see as background."""

    occupied: NDArray[np.bool_]
    background_only: NDArray[np.bool_]


def voxel_masks(field: DenseGrid, capture: Capture) -> VoxelMasks:
    """Classify voxels by the alpha of the training views they project to.

    A voxel's basis function reaches one voxel around its centre: it is occupied only if all pixels
    it covers, in every view, are opaque, and background-only if all of them are empty. Voxels that
    fewer than two views see are neither. Raises RangeError if the capture has no alpha.
    """
    if not capture.has_alpha:
        raise RangeError(
            message("voxel_masks", "capture", "images with alpha", "images without",
                    "there is no truth to compare signs with")
        )  # fmt: skip
    shape = field.params["values"].shape[:3]
    lo, hi = field.box
    axes = [lo[k] + (np.arange(shape[k]) + 0.5) * (hi[k] - lo[k]) / shape[k] for k in range(3)]
    centres = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    voxel = float(((hi - lo) / shape).max())
    least, most, seen = np.ones(len(centres)), np.zeros(len(centres)), np.zeros(len(centres), int)
    for view in capture.train:
        _look(view, centres, voxel, least, most, seen)
    known = seen >= 2
    return VoxelMasks(
        (known & (least >= OPAQUE)).reshape(shape), (known & (most <= EMPTY)).reshape(shape)
    )


def _look(view: View, centres: Array, voxel: float, least: Array, most: Array, seen: Array) -> None:
    """Take one view into account: least and greatest alpha under each voxel's footprint."""
    camera = view.camera
    position, depth = camera.project(centres)
    inside = (
        (depth > 0)
        & (position[:, 0] >= 0) & (position[:, 0] < camera.width)
        & (position[:, 1] >= 0) & (position[:, 1] < camera.height)
    )  # fmt: skip
    if not inside.any():
        return
    # A voxel reaches sqrt(3) voxels from its centre at the corners of its footprint.
    reach = int(np.ceil(np.sqrt(3) * voxel * camera.fx / depth[inside].min()))
    alpha = view.rgba()[..., 3]
    column = position[inside, 0].astype(int)
    row = position[inside, 1].astype(int)
    least[inside] = np.minimum(least[inside], _extreme(alpha, reach, np.minimum)[row, column])
    most[inside] = np.maximum(most[inside], _extreme(alpha, reach, np.maximum)[row, column])
    seen[inside] += 1


def _extreme(image: Array, reach: int, pick: np.ufunc) -> Array:
    """Minimum or maximum over the square of `reach` pixels around each pixel (edges repeated)."""
    for axis in (0, 1):
        padding = [(reach, reach) if k == axis else (0, 0) for k in range(2)]
        padded = np.pad(image, padding, mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=axis)
        image = pick.reduce(windows, axis=-1)
    return image

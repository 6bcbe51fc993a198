"""dL/dsigma_t in every voxel: what the photographs ask of the space they see.

From a nearly transparent start the loss wants density where matter must appear (gradient negative)
and less of it where cameras see only background (positive). Elsewhere, in front of matter or hidden
by it, either sign may occur.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photograd._checks import require_instance
from photograd._notebook import png, signed_colors, smaller
from photograd.capture.capture import Capture
from photograd.capture.view import View
from photograd.errors import DtypeError, RangeError, message
from photograd.fields.voxel_field import VoxelField
from photograd.fitting.data import TrainingPixels, random_background
from photograd.fitting.loss import image_loss, image_loss_backward
from photograd.fitting.model import Model
from photograd.representation import RenderOptions
from photograd.types import Array

OPAQUE, EMPTY = 0.99, 0.01  # alpha of pixels that count as matter, as background


@dataclass(frozen=True)
class DensityGradient:
    """dL/dsigma_t (X, Y, Z) in units of loss * m, and the loss it belongs to.

    `active` (X, Y, Z) says where there is a voxel or a leaf to differentiate; elsewhere the
    gradient is 0, which says nothing.
    """

    d_sigma_t: Array
    active: NDArray[np.bool_]
    loss: float

    def _repr_png_(self) -> bytes:
        """The largest values along z, x to the right and y up: blue where more density helps."""
        rows = np.abs(self.d_sigma_t).argmax(axis=2, keepdims=True)
        largest = np.take_along_axis(self.d_sigma_t, rows, axis=2)[..., 0]
        return png(signed_colors(smaller(largest.T[::-1])))


def density_gradient(
    model: Model | VoxelField,
    capture: Capture | TrainingPixels,
    *,
    seed: int,
    background: Array | None = None,
    rays: int = 1 << 20,
) -> DensityGradient:
    """The loss over random training pixels and its gradient with respect to sigma_t.

    `photograd_course.viz.signed_projections` draws it. All cells of an octree's leaf show the
    gradient with respect to the leaf's sigma_t, the sum over what the leaf stands for.

    Args:
        model: of a grid or an octree; or such a field alone.
        capture: the photographs, or what `training_data` made of them.
        seed: of the choice of pixels, and of random backgrounds.
        background: linear (3,) behind the scene. None takes what the model has learned; where it
            has learned none, each ray has a random one: over one fixed background, matter of the
            background's color would be invisible, its gradient zero.
        rays: how many pixels are drawn.

    Raises:
        DtypeError: a field without voxels, or no capture.
        RangeError: no background for photographs without alpha, which show one.

    Example:
        >>> from photograd.fitting import density_gradient
        >>> from photograd_course.viz import save_figure, signed_projections
        >>> capture = photograd.load_capture("photos")
        >>> model = photograd.fit(capture, resolution=16, steps=20, rays=256)
        >>> found = density_gradient(model, capture, seed=0, rays=4096)
        >>> figure = signed_projections(found.d_sigma_t, model.field.box, active=found.active)
        >>> _ = save_figure(figure, "gradient.png")
    """
    field = model.field if isinstance(model, Model) else model
    if background is None and isinstance(model, Model):
        background = model.background
    if not isinstance(field, VoxelField):
        expected, got = "a model of voxels, such as dense_grid", type(field).__name__
        remedy = "photograd.fitting.group_gradients and view_gradients have those of others"
        raise DtypeError(message("density_gradient", "model", expected, got, remedy))
    pixels = capture
    if not isinstance(pixels, TrainingPixels):
        require_instance("density_gradient", "capture", capture, Capture, "load_capture reads one")
        if background is None and not pixels.has_alpha:
            expected = "a color, as the photographs have no alpha"
            remedy = "pass the Model of a fit, which has learned one"
            raise RangeError(message("density_gradient", "background", expected, None, remedy))
        pixels = TrainingPixels(pixels.train, pixels.color_space)
    chosen = pixels.draw(rays, seed=seed, step=0)
    display = pixels.color_space == "display"
    total, loss = np.zeros(len(field.density_rows(field.params))), 0.0
    for start in range(0, rays, field.rays_at_once):
        part = chosen[start : start + field.rays_at_once]
        behind = background
        if behind is None:
            behind = random_background(len(part), seed=seed, step=0, first=start)
        outputs, context = field.render(
            pixels.rays(part), seed=seed, step=0, options=RenderOptions(jitter=True)
        )
        result = image_loss(outputs, pixels.premultiplied[part], behind, display=display)
        d_outputs, _ = image_loss_backward(result)
        share = len(part) / rays
        gradients: dict[str, Any] = dict(field.render_backward(context, d_outputs))
        total += share * field.density_rows(gradients)
        loss += share * result.value
    # The chain rule backwards through sigma_t = scale * softplus(raw), of each row.
    d_sigma_t = (total / np.maximum(field.density_slope, 1e-12)).astype(np.float32)
    return DensityGradient(field.to_voxels(d_sigma_t), field.active_voxels, loss)


@dataclass(frozen=True)
class VoxelMasks:
    """Voxels (X, Y, Z) inside of every silhouette, and those all cameras see as background."""

    occupied: NDArray[np.bool_]
    background_only: NDArray[np.bool_]


def voxel_masks(field: VoxelField, capture: Capture) -> VoxelMasks:
    """Classify voxels by the alpha of the training views they project to.

    A voxel's basis function reaches one voxel around its center: it is occupied only if all pixels
    it covers, in every view, are opaque, and background-only if all of them are empty. Voxels that
    fewer than two views see are neither, nor are those that a sparse grid lacks. Raises RangeError
    if the capture has no alpha.

    Args:
        field: whose voxels are classified.
        capture: photographs with alpha.
    """
    if not capture.has_alpha:
        raise RangeError(
            message(
                "voxel_masks",
                "capture",
                "images with alpha",
                "images without",
                "there is no truth to compare signs with",
            )
        )
    shape = field.voxel_shape
    lo, hi = field.box
    voxel = (hi - lo) / shape
    axes = [lo[k] + (np.arange(shape[k]) + 0.5) * voxel[k] for k in range(3)]
    centers = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    occupied = np.ones(len(centers), np.bool_)
    empty = np.ones(len(centers), np.bool_)
    views = np.zeros(len(centers), np.int64)
    for view in capture.train:
        open_ids = np.flatnonzero(occupied | empty)
        found, rectangle = _footprints(view, centers[open_ids], voxel)
        shown = open_ids[found]
        # A pixel that does not exist, neither opaque nor empty, decides for neither.
        alpha = np.where(view.valid_mask(), view.rgba()[..., 3], 0.5)
        occupied[shown] &= _count(alpha < OPAQUE, rectangle) == 0
        empty[shown] &= _count(alpha > EMPTY, rectangle) == 0
        views[shown] += 1
    known = (views >= 2).reshape(shape) & field.active_voxels
    return VoxelMasks(known & occupied.reshape(shape), known & empty.reshape(shape))


def _footprints(view: View, centers: Array, voxel: Array) -> tuple[NDArray[np.int64], Array]:
    """Voxels whose center a view shows, and the pixels that each may touch.

    Returns voxel numbers (M,), and (4, M): left, right, top, bottom of a rectangle that contains
    the image of the cube of one voxel around the center; right and bottom are exclusive.
    """
    camera = view.camera
    position, depth = camera.project(centers)
    # Extent of the cube along the camera's axes: |x - x0| <= reach[0] and so on.
    reach = np.abs(camera.world_from_camera[:3, :3].T) @ voxel
    inside = (position >= 0).all(axis=1) & (position < [camera.width, camera.height]).all(axis=1)
    shown = np.flatnonzero(inside & (depth > reach[2]))
    position, near = position[shown], depth[shown] - reach[2]
    # u = f x / z + c moves by at most f (dx + |x / z| dz) / (z - dz).
    slope = np.abs(position - [camera.cx, camera.cy]) / [camera.fx, camera.fy]
    move = [camera.fx, camera.fy] * (reach[:2] + slope * reach[2]) / near[:, None]
    low = np.floor(position - move).astype(np.int64).clip(min=0)
    high = np.ceil(position + move).astype(np.int64)
    right, bottom = np.minimum(high, [camera.width, camera.height]).T
    return shown, np.stack([low[:, 0], right, low[:, 1], bottom])


def _count(pixels: NDArray[np.bool_], rectangle: Array) -> Array:
    """How many True pixels each rectangle holds, from a summed-area table [Crow1984]."""
    table = np.zeros((pixels.shape[0] + 1, pixels.shape[1] + 1), np.int64)
    table[1:, 1:] = pixels.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
    left, right, top, bottom = rectangle
    count: Array = table[bottom, right] - table[top, right] - table[bottom, left] + table[top, left]
    return count

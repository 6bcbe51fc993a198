"""The gradient of one photograph's loss, a number for each part of a field.

    voxels, leaves   dL/dsigma_t, as `density_gradient` has it
    Gaussians        dL/d opacity logit
    meshes           dL/dx . n of a vertex x with unit normal n, outward
    all others       dL/d color of a pixel of the photograph, mean over the channels

These are the quantities of `photograd gradients`, and so are the ends of their color scales: a
quantile of what is not zero, so that no single outlier owns the scale.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from photograd_course.color import srgb_encode
from photograd_course.viz.scale import signed_scale

from photograd.capture.camera import Camera
from photograd.capture.view import View
from photograd.fields.surface import SurfaceField
from photograd.fields.voxel_field import VoxelField
from photograd.fitting.data import TrainingPixels, TrainingViews
from photograd.fitting.drawing import draw_field
from photograd.fitting.group_gradients import pixel_gradient
from photograd.fitting.loss import picture_loss, picture_loss_backward
from photograd.fitting.view_gradients import loss_and_grad
from photograd.fitting.voxel_gradients import density_gradient
from photograd.geometry.normals import vertex_normals
from photograd.raster import project_backward
from photograd.representation import Fittable, ImageBatch, RenderOptions
from photograd.splats.model import GaussianScene
from photograd.types import Array, FloatArray

Kind = Literal["voxels", "gaussians", "surface", "pixels"]
QUANTILES: dict[Kind, float] = {
    "voxels": 0.999,
    "gaussians": 0.98,
    "surface": 0.98,
    "pixels": 0.995,
}
"""Of the magnitudes that are not zero: the end of the scale, as pictures of fits have it."""
WHITE = np.ones(3)
RAYS = 1 << 16


@dataclass(frozen=True, eq=False)
class PhotographGradient:
    """What one photograph asks of a field.

    Attributes:
        kind: of the values: "voxels", "gaussians", "surface" or "pixels".
        values: (X, Y, Z) of voxels, (N,) of Gaussians, (V,) of vertices, (H, W) of pixels.
        loss: of the photograph.
        camera: of the photograph.
        active: (X, Y, Z) where there is a voxel; of other kinds None.
        depth: (H, W) of pixels, how far away the field is, NaN where nothing is; else None.
        groups: {name: gradient} with a row for each Gaussian, or "vertices" (V, 3) in the world.
    """

    kind: Kind
    values: Array
    loss: float
    camera: Camera
    active: NDArray[np.bool_] | None = None
    depth: Array | None = None
    groups: dict[str, Array] = field(default_factory=dict)

    @property
    def limit(self) -> float:
        """The end of the color scale: colors span [-limit, limit].

        Of few values the quantile is lower: it lies below the largest, whatever that is.
        """
        count = int(np.count_nonzero(self.values))
        quantile = max(min(QUANTILES[self.kind], 1 - 2 / max(count, 1)), 0.5)
        return signed_scale("photograph_gradient", [self.values], None, quantile=quantile).limit


def photograph_gradient(
    shown: Fittable,
    background: Array | None,
    view: View,
    *,
    ssim_weight: float = 0.2,
    seed: int = 0,
    rays: int = RAYS,
) -> PhotographGradient:
    """The gradient of the loss against one photograph.

    Args:
        shown: a field.
        background: linear (3,) behind it, or None: random ones behind voxels where the photograph
            has alpha, else white.
        view: the photograph, in the frame of the field.
        ssim_weight: share of 1 - SSIM in the loss of Gaussians and meshes.
        seed: of the pixels that are drawn for voxels.
        rays: how many of them.

    Raises:
        IoError: the photograph cannot be read.
        RangeError: it has no valid pixel, or is smaller than the window of SSIM.
    """
    if isinstance(shown, VoxelField):
        return _of_voxels(shown, background, view, seed, rays)
    photograph = TrainingViews([view]).views[0]
    behind = WHITE if background is None else srgb_encode(np.asarray(background, np.float64))
    if isinstance(shown, GaussianScene):
        loss, groups, *_ = loss_and_grad(shown, photograph, ssim_weight, behind)
        values = groups["opacity_logits"]
        return PhotographGradient("gaussians", values, loss, view.camera, groups=groups)
    if isinstance(shown, SurfaceField):
        loss, d_vertices = vertex_gradient(shown, photograph, behind, ssim_weight)
        normals = vertex_normals(shown.vertices, shown.faces)
        length = np.sqrt(np.square(normals).sum(axis=1, keepdims=True))
        unit = normals / np.where(length > 0, length, 1)
        along = (d_vertices * unit).sum(axis=1)
        groups = {"vertices": d_vertices}
        return PhotographGradient("surface", along, loss, view.camera, groups=groups)
    picture = draw_field(shown, background, view.camera)
    d_pixel, loss = pixel_gradient(picture.color, photograph)
    return PhotographGradient("pixels", d_pixel, loss, view.camera, depth=picture.depth)


def _of_voxels(
    shown: VoxelField, background: Array | None, view: View, seed: int, rays: int
) -> PhotographGradient:
    pixels = TrainingPixels([view], view.color_space)
    opaque = bool((pixels.premultiplied[:, 3] == 1).all())
    behind = WHITE if background is None and opaque else background
    found = density_gradient(shown, pixels, seed=seed, background=behind, rays=rays)
    return PhotographGradient(
        "voxels", found.d_sigma_t, found.loss, view.camera, active=found.active
    )


def vertex_gradient(
    shown: SurfaceField, photograph: Any, background: Array, ssim_weight: float
) -> tuple[float, FloatArray]:
    """Loss of a mesh against a photograph, and dL/dx (V, 3) of its vertices in the world.

    Through silhouettes and inside of faces; the depth of a vertex counts, too.

    Args:
        shown: the mesh.
        photograph: of `TrainingViews`.
        background: (3,) display color.
        ssim_weight: share of 1 - SSIM in the loss.
    """
    outputs, context = shown.render(
        ImageBatch(photograph.camera), seed=0, step=0, options=RenderOptions()
    )
    loss = picture_loss(outputs, photograph, background, ssim_weight=ssim_weight)
    drawn = context.picture
    parts = drawn.position_gradients(drawn.cotangent(picture_loss_backward(loss)[0]))
    camera = replace(photograph.camera, world_from_camera=np.eye(4))
    d_local = project_backward(drawn.local, camera, parts.silhouettes + parts.interior).vertices
    rotation = photograph.camera.world_from_camera[:3, :3]
    d_vertices: FloatArray = d_local @ rotation.T
    return loss.value, d_vertices

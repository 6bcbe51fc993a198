"""What the photographs ask of every Gaussian: the data of the pictures in `drawings`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from photograd import sh
from photograd._notebook import EDGE, png_of_sheet, sheet, signed_colors, smaller
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.fitting.data import TrainingView, TrainingViews
from photograd.fitting.loss import picture_loss, picture_loss_backward
from photograd.representation import ImageBatch, RenderOptions
from photograd.splats.density import Grad2dStatistics, rotation_matrices
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import Gaussians, SplatOptions, render
from photograd.types import Array

MAX_VIEWS = 24
WHITE = np.ones(3)


@dataclass(frozen=True, eq=False)
class ViewGradients:
    """One view of a scene, and what the loss asks of its N Gaussians.

    Attributes:
        picture: (H, W, 3) the scene over white, display values.
        pixels: (N, 2) projected means; NaN behind the camera.
        spread: (N, 2, 2) covariances on the screen, pixel^2, without the low-pass.
        screen: (N, 2) dL/d projected mean of this view, per pixel.
        visible: (N,) which Gaussians have pixels in this view.
        d_logit: (N,) dL/d opacity logit, mean over the views.
        grad2d: (N,) positional gradient, mean over the views; density control compares it.
        loss: mean over the views.
    """

    picture: Array
    pixels: Array
    spread: Array
    screen: Array
    visible: NDArray[np.bool_]
    d_logit: Array
    grad2d: Array
    loss: float

    def _repr_png_(self) -> bytes:
        """The picture, and dL/d opacity logit at the pixels of the projected means.

        Blue where more opacity lowers the loss.
        """
        height, width = self.picture.shape[:2]
        inside = self.visible & (self.pixels >= 0).all(1) & (self.pixels < [width, height]).all(1)
        column, row = self.pixels[inside].astype(np.int64).T
        signed = np.zeros((height, width))
        np.add.at(signed, (row, column), self.d_logit[inside])
        return png_of_sheet(sheet([self.picture, signed_colors(smaller(signed))], 2, EDGE // 2))


def view_gradients(
    scene: GaussianScene, views: TrainingViews, number: int, *, ssim_weight: float = 0.2
) -> ViewGradients:
    """Gradients over at most 24 of the views, evenly spaced; the picture is that of view `number`.

    Over white. Does not touch the scene's own statistics.

    Args:
        scene: Gaussians.
        views: the photographs.
        number: of the view that is drawn.
        ssim_weight: share of 1 - SSIM in the loss.

    Raises:
        IndexError: there is no such view.
    """
    shown = views.views[number]
    grad2d, total, loss = Grad2dStatistics.zero(scene.resolution), np.zeros(scene.resolution), 0.0
    chosen = views.views[:: max(1, -(-len(views) // MAX_VIEWS))]
    for view in chosen:
        value, gradients, screen, visible, _ = loss_and_grad(scene, view, ssim_weight)
        total += gradients["opacity_logits"]
        grad2d.add(screen, visible, view.camera)
        loss += value
    _, _, screen, visible, picture = loss_and_grad(scene, shown, ssim_weight)
    pixels, _ = shown.camera.project(scene.params["means"].astype(np.float64))
    spread = screen_covariances(scene.gaussians, shown.camera)
    return ViewGradients(
        picture,
        pixels,
        spread,
        screen,
        visible,
        total / len(chosen),
        grad2d.mean(),
        loss / len(chosen),
    )


def loss_and_grad(
    scene: GaussianScene, view: TrainingView, ssim_weight: float, background: Array = WHITE
) -> tuple[float, dict[str, Array], Array, NDArray[np.bool_], Array]:
    """Loss, gradients, dL/d projected means, visibility and picture of one view.

    Args:
        scene: Gaussians.
        view: the photograph.
        ssim_weight: share of 1 - SSIM in the loss.
        background: (3,) display color.
    """
    outputs, context = scene.render(
        ImageBatch(view.camera), seed=0, step=0, options=RenderOptions(stop=1e-4)
    )
    loss = picture_loss(outputs, view, background, ssim_weight=ssim_weight)
    gradients = scene.render_backward(context, picture_loss_backward(loss)[0])
    assert context.screen is not None
    return loss.value, gradients, context.screen, context.splats.visible, loss.image


def screen_covariances(gaussians: Gaussians, camera: Camera) -> Array:
    """(N, 2, 2) covariances of the Gaussians on the screen, in pixel^2; NaN behind the camera.

    J W R S S^T R^T W^T J^T with the projection's Jacobian J at the mean [Zwicker2001].

    Args:
        gaussians: N of them.
        camera: where they are seen from.
    """
    view = invert_rigid(camera.world_from_camera)
    local = gaussians.means.astype(np.float64) @ view[:3, :3].T + view[:3, 3]
    x, y, depth = local.T
    z = np.where(depth > 0, depth, np.nan)
    zero = np.zeros_like(z)
    jacobian = np.stack(
        [camera.fx / z, zero, -camera.fx * x / z**2, zero, camera.fy / z, -camera.fy * y / z**2],
        axis=-1,
    ).reshape(-1, 2, 3)
    axes = rotation_matrices(gaussians.quats) * np.exp(gaussians.log_scales)[:, None, :]
    flat = jacobian @ view[:3, :3] @ axes
    found: Array = flat @ np.swapaxes(flat, 1, 2)
    return found


def grad2d_picture(gaussians: Gaussians, grad2d: Array, camera: Camera) -> Array:
    """(H, W) grad2d as the camera would see it, if it were what Gaussians show; 0 in between.

    Args:
        gaussians: N of them.
        grad2d: (N,) positional gradients.
        camera: where they are seen from.
    """
    top = max(float(grad2d.max()), 1e-30)
    plain = (grad2d / top - 0.5) / sh.Y_0
    arrays = gaussians.arrays() | {"sh": np.repeat(plain[:, None, None], 3, axis=2)}
    shown = Gaussians(**{name: a.astype(np.float64) for name, a in arrays.items()})
    picture, _ = render(shown, camera, options=SplatOptions())
    found: Array = top * picture.color[..., 0]
    return found

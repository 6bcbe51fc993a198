"""The loss of a whole picture against a photograph, in display values, and its adjoint.

    image = color + (1 - opacity) background        truth = photograph + (1 - alpha) background
    loss  = (1 - w) mean |image - truth| + w (1 - SSIM(image, truth))       [Kerbl2023, eq. 7]

    d_color = d_image     d_opacity = -d_image . background     d_background = sum (1 - o) d_image

The photograph is opaque wherever a background is learned, so that the truth does not depend on it.
Pixels that are not valid count as equal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd.fitting.structural import ssim_backward
from photograd.fitting.training_views import TrainingView
from photograd.representation import Outputs
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class PictureLoss:
    """A picture's loss with what its adjoint needs; pictures are (H, W, 3), display values."""

    value: float
    mean_square: float  # of image - truth over valid pixels: the PSNR of progress displays
    image: Array
    truth: Array
    opacity: Array  # (H, W)
    background: Array  # (3,)
    ssim_weight: float
    d_ssim: Array | None  # dSSIM/d image, if it weighs anything


def picture_loss(
    outputs: Outputs, view: TrainingView, background: Array, *, ssim_weight: float
) -> PictureLoss:
    """Loss of a rendering of `view.camera` over a display colour (3,); shapes as `Outputs`."""
    shape = view.premultiplied.shape[:2]
    dtype = outputs.color.dtype
    behind = np.asarray(background, dtype)
    opacity = np.asarray(outputs.opacity).reshape(shape)
    image = outputs.color.reshape(*shape, 3) + (1 - opacity)[..., None] * behind
    alpha = view.premultiplied[..., 3:].astype(dtype)
    truth = view.premultiplied[..., :3].astype(dtype) + (1 - alpha) * behind
    if view.valid is not None:
        truth = np.where(view.valid[..., None], truth, image)
    difference = image - truth
    value = (1 - ssim_weight) * float(np.abs(difference).mean(dtype=np.float64))
    d_ssim = None
    if ssim_weight > 0:
        similarity, d_ssim = ssim_backward(image, truth)
        value += ssim_weight * (1 - similarity)
    square = float(np.square(difference).mean(dtype=np.float64))
    if view.valid is not None:
        square /= max(float(view.valid.mean()), 1 / view.valid.size)
    return PictureLoss(value, square, image, truth, opacity, behind, ssim_weight, d_ssim)


def picture_loss_backward(loss: PictureLoss) -> tuple[Outputs, Array]:
    """dL/d color (P, 3) and opacity (P,) as Outputs, and dL/d background (3,)."""
    share = (1 - loss.ssim_weight) / loss.image.size
    d_image = np.sign(loss.image - loss.truth) * loss.image.dtype.type(share)
    if loss.d_ssim is not None:
        d_image -= loss.ssim_weight * loss.d_ssim
    d_opacity = -(d_image * loss.background).sum(axis=-1)
    d_background = np.einsum("hwc,hw->c", d_image, 1 - loss.opacity)
    return Outputs(d_image.reshape(-1, 3), d_opacity.ravel()), d_background

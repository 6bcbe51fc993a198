"""From renderings to losses and back: display encoding, errors of pixels and of whole pictures.

The loss of pixels that are sampled at random:

    image = color + (1 - opacity) background             linear light, premultiplied color
    truth = photograph + (1 - alpha) background          the photograph, likewise premultiplied
    loss  = mean (encode(image) - encode(truth))^2       encode = sRGB for display-encoded captures,
                                                         nothing for linear ones

    d_image = encode'(image) 2 (encode(image) - encode(truth)) / N     d_color = d_image
    d_opacity = -d_image . background
    d_background = (1 - opacity) d_image - (1 - alpha) encode'(truth) 2 (...) / N

A learned background stands behind the photograph too: both terms count.

The loss of a whole picture, in display values; structural similarity and its adjoint are in the
core, since a fit needs them at every step (cpp/photograd/texture/ssim.h):

    image = color + (1 - opacity) background        truth = photograph + (1 - alpha) background
    loss  = (1 - w) mean |image - truth| + w (1 - SSIM(image, truth))       [Kerbl2023, eq. 7]

    d_color = d_image     d_opacity = -d_image . background     d_background = sum (1 - o) d_image

The photograph is opaque wherever a background is learned, so that the truth does not depend on it.
Pixels that are not valid count as equal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from photograd_course.color import (
    composite_over,
    composite_over_backward,
    srgb_encode,
    srgb_encode_backward,
)
from photograd_course.losses import l2, l2_backward
from photograd_course.portable_math import log

from photograd._compiled import _core
from photograd.errors import ShapeError, message
from photograd.fitting.data import TrainingView
from photograd.representation import Outputs
from photograd.types import Array

LN_10 = 2.302585092994046


@dataclass(frozen=True)
class ImageLoss:
    """Loss of a rendering, with what its adjoint needs; pictures are (R, 3), linear."""

    value: float
    color: Array  # of the rendering, premultiplied
    opacity: Array  # (R,)
    photograph: Array  # premultiplied
    alpha: Array  # (R,)
    background: Array  # (3,) or (R, 3)
    image: Array  # the rendering over the background
    truth: Array  # the photograph over the background
    encoded: Array  # encode(image)
    target: Array  # encode(truth)
    display: bool


def image_loss(
    outputs: Outputs, premultiplied: Array, background: Array, *, display: bool
) -> ImageLoss:
    """Mean squared error against pixels (R, 4), over a background (3,) or (R, 3), all linear.

    `premultiplied` holds color times alpha, and alpha; the dtype is that of the rendering. Raises
    ShapeError if the rendering has no opacity, or shapes do not belong together.

    Args:
        outputs: the rendering of R rays.
        premultiplied: (R, 4) the photograph.
        background: (3,) or (R, 3).
        display: whether the loss is taken on display-encoded values.
    """
    opacity = _opacity("image_loss", outputs)
    dtype = outputs.color.dtype
    background = np.asarray(background, dtype)
    photograph = np.ascontiguousarray(premultiplied[:, :3], dtype)
    alpha = np.ascontiguousarray(premultiplied[:, 3], dtype)
    image = composite_over(outputs.color, opacity, background)
    truth = composite_over(photograph, alpha, background)
    encoded = srgb_encode(image) if display else image
    target = srgb_encode(truth) if display else truth
    return ImageLoss(
        l2(encoded, target),
        outputs.color,
        opacity,
        photograph,
        alpha,
        background,
        image,
        truth,
        encoded,
        target,
        display,
    )


def _opacity(function: str, outputs: Outputs) -> Array:
    """The opacity of a rendering, which `Outputs` may lack."""
    if outputs.opacity is None:
        expected = "an array (R,), to be composited over a background"
        remedy = "the representation's render returns Outputs(color, opacity)"
        raise ShapeError(message(function, "outputs.opacity", expected, "None", remedy))
    return outputs.opacity


def image_loss_backward(loss: ImageLoss) -> tuple[Outputs, Array]:
    """dL/d color (R, 3) and dL/d opacity (R,) as Outputs, and dL/d background in its own shape.

    Args:
        loss: what `image_loss` returned.
    """
    d_image = l2_backward(loss.encoded, loss.target)
    d_truth = -d_image
    if loss.display:
        d_image = srgb_encode_backward(loss.image, d_image)
        d_truth = srgb_encode_backward(loss.truth, d_truth)
    d_color, d_opacity, d_background = composite_over_backward(
        loss.color, loss.opacity, loss.background, d_image
    )
    _, _, d_behind = composite_over_backward(loss.photograph, loss.alpha, loss.background, d_truth)
    return Outputs(d_color, d_opacity), d_background + d_behind


def decibels(mean_square: float) -> float:
    """PSNR in dB of a mean squared error against a peak of 1, at most 120.

    Args:
        mean_square: mean squared error.
    """
    return -10.0 / LN_10 * float(log(max(mean_square, 1e-12)))


# Structural similarity as a loss: what `photograd_course.metrics.ssim` measures, and its adjoint.


def ssim(x: Array, y: Array) -> float:
    """Mean structural similarity [Wang2004] of pictures (H, W, C) with values in 0 .. 1.

    11 x 11 Gaussian window of sigma 1.5, only windows that lie inside, each channel on its own.

    Args:
        x: (H, W, C).
        y: (H, W, C) of the same dtype.

    Raises:
        DtypeError, ShapeError, RangeError: not both float32 or float64, of different shapes,
            smaller than the window, or of more than four channels.
    """
    return float(_core.ssim(np.ascontiguousarray(x), np.ascontiguousarray(y)))


def ssim_backward(x: Array, y: Array, d_value: float = 1.0) -> tuple[float, Array]:
    """The value, which costs nothing more, and d_x = d_value dssim/dx in the shape of x.

    Args:
        x: (H, W, C).
        y: (H, W, C) of the same dtype.
        d_value: dL/d of the value.

    Raises:
        DtypeError, ShapeError, RangeError: as `ssim`.
    """
    x = np.ascontiguousarray(x)
    d_x = np.zeros_like(x)
    value = _core.ssim_backward(x, np.ascontiguousarray(y), d_value, d_x)
    return float(value), d_x


# The loss of a whole picture against a photograph, in display values, and its adjoint.


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
    """Loss of a rendering of `view.camera` over a display color (3,); shapes as `Outputs`.

    Args:
        outputs: the rendering of all pixels of the view.
        view: the photograph.
        background: (3,) display color.
        ssim_weight: w, the share of 1 - SSIM.
    """
    shape = view.premultiplied.shape[:2]
    dtype = outputs.color.dtype
    behind = np.asarray(background, dtype)
    opacity = _opacity("picture_loss", outputs).reshape(shape)
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
    """dL/d color (P, 3) and opacity (P,) as Outputs, and dL/d background (3,).

    Args:
        loss: what `picture_loss` returned.
    """
    share = (1 - loss.ssim_weight) / loss.image.size
    d_image = np.sign(loss.image - loss.truth) * loss.image.dtype.type(share)
    if loss.d_ssim is not None:
        d_image -= loss.ssim_weight * loss.d_ssim
    d_opacity = -(d_image * loss.background).sum(axis=-1)
    d_background = np.einsum("hwc,hw->c", d_image, 1 - loss.opacity)
    return Outputs(d_image.reshape(-1, 3), d_opacity.ravel()), d_background

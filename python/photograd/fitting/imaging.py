"""From a rendering to a loss: background, display encoding, error, and the adjoint of all three.

    image = color + (1 - opacity) background             linear light, premultiplied colour
    truth = photograph + (1 - alpha) background          the photograph, likewise premultiplied
    loss  = mean (encode(image) - encode(truth))^2       encode = sRGB for display-encoded captures,
                                                         nothing for linear ones

    d_image = encode'(image) 2 (encode(image) - encode(truth)) / N     d_color = d_image
    d_opacity = -d_image . background
    d_background = (1 - opacity) d_image - (1 - alpha) encode'(truth) 2 (...) / N

A learned background stands behind the photograph too: both terms count.
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

from photograd.errors import ShapeError, message
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

    `premultiplied` holds colour times alpha, and alpha; the dtype is that of the rendering. Raises
    ShapeError if the rendering has no opacity, or shapes do not belong together.
    """
    if outputs.opacity is None:
        expected = "a rendering with opacity"
        raise ShapeError(message("image_loss", "outputs", expected, "one without"))
    dtype = outputs.color.dtype
    background = np.asarray(background, dtype)
    photograph = np.ascontiguousarray(premultiplied[:, :3], dtype)
    alpha = np.ascontiguousarray(premultiplied[:, 3], dtype)
    image = composite_over(outputs.color, outputs.opacity, background)
    truth = composite_over(photograph, alpha, background)
    encoded = srgb_encode(image) if display else image
    target = srgb_encode(truth) if display else truth
    return ImageLoss(
        l2(encoded, target), outputs.color, outputs.opacity, photograph, alpha, background,
        image, truth, encoded, target, display,
    )  # fmt: skip


def image_loss_backward(loss: ImageLoss) -> tuple[Outputs, Array]:
    """dL/d color (R, 3) and dL/d opacity (R,) as Outputs, and dL/d background in its own shape."""
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
    """PSNR in dB of a mean squared error against a peak of 1, at most 120."""
    return -10.0 / LN_10 * float(log(max(mean_square, 1e-12)))

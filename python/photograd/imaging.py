"""From a rendering to a loss: background, display encoding, error, and the adjoint of all three.

image   = color + (1 - opacity) background           linear light, premultiplied colour
encoded = srgb_encode(image)                         for captures that were stored display-encoded
loss    = mean (encoded - truth)^2
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

from photograd.representation import Array, Outputs


@dataclass(frozen=True)
class ImageLoss:
    """Loss of a rendering, with what its adjoint needs."""

    value: float
    outputs: Outputs
    background: Array
    image: Array  # (R, 3) linear, over the background
    encoded: Array
    truth: Array
    display: bool


def image_loss(
    outputs: Outputs, premultiplied: Array, background: Array, *, display: bool
) -> ImageLoss:
    """Mean squared error against pixels (R, 4), premultiplied linear, over the same background."""
    background = np.asarray(background, outputs.color.dtype)
    opacity = _opacity(outputs)
    image = composite_over(outputs.color, opacity, background)
    pixels = np.asarray(premultiplied, image.dtype)
    truth = composite_over(
        np.ascontiguousarray(pixels[:, :3]), np.ascontiguousarray(pixels[:, 3]), background
    )
    encoded = srgb_encode(image) if display else image
    truth = srgb_encode(truth) if display else truth
    return ImageLoss(l2(encoded, truth), outputs, background, image, encoded, truth, display)


def image_loss_backward(loss: ImageLoss) -> tuple[Outputs, Array]:
    """dL/d color (R, 3) and dL/d opacity (R,) as Outputs, and dL/d background in its own shape."""
    d_encoded = l2_backward(loss.encoded, loss.truth)
    d_image = srgb_encode_backward(loss.image, d_encoded) if loss.display else d_encoded
    d_color, d_opacity, d_background = composite_over_backward(
        loss.outputs.color, _opacity(loss.outputs), loss.background, d_image
    )
    return Outputs(d_color, d_opacity), d_background


def _opacity(outputs: Outputs) -> Array:
    assert outputs.opacity is not None
    return outputs.opacity

"""Inverse rendering: parameters of a path traced scene from pictures of it, by gradient descent.

`recover` is the whole of it; `InverseRendering` is the loop behind it, a step at a time. The
parameters that may be found are in `photograd.transport.inverse.parameters`, the loss is
`dual_buffer_loss`.
"""

from __future__ import annotations

from photograd.transport.inverse.job import InverseRendering
from photograd.transport.inverse.loss import (
    Target,
    dual_buffer_loss,
    dual_buffer_loss_backward,
    loss_and_gradients,
)
from photograd.transport.inverse.options import RecoveryOptions, RecoveryResult
from photograd.transport.inverse.parameters import Parameter, scene_with
from photograd.transport.inverse.whole import recover

__all__ = [
    "InverseRendering",
    "Parameter",
    "RecoveryOptions",
    "RecoveryResult",
    "Target",
    "dual_buffer_loss",
    "dual_buffer_loss_backward",
    "loss_and_gradients",
    "recover",
    "scene_with",
]

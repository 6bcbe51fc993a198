"""Recovery of what a path traced scene is made of, from pictures of it, by gradient descent.

`recover` is the whole of it; `Recovery` is the loop behind it, a step at a time. What may be
unknown is `photograd.transport.inverse.parameters`, what is made small is `cross_loss`.
"""

from __future__ import annotations

from photograd.transport.inverse.job import Recovery
from photograd.transport.inverse.loss import (
    Target,
    cross_loss,
    cross_loss_backward,
    loss_and_gradients,
)
from photograd.transport.inverse.options import RecoveryOptions, RecoveryResult
from photograd.transport.inverse.parameters import Unknown, scene_with
from photograd.transport.inverse.whole import recover

__all__ = [
    "Recovery",
    "RecoveryOptions",
    "RecoveryResult",
    "Target",
    "Unknown",
    "cross_loss",
    "cross_loss_backward",
    "loss_and_gradients",
    "recover",
    "scene_with",
]

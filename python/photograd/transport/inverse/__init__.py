"""Recovery of what a path traced scene is made of, from pictures of it, by gradient descent.

`recover` is the whole of it; `Recovery` is the loop behind it, a step at a time. What may be
unknown is `unknown.py`, what is made small is `cross_loss.py`.
"""

from __future__ import annotations

from photograd.transport.inverse.changed_scene import scene_with
from photograd.transport.inverse.cross_loss import (
    cross_loss,
    cross_loss_backward,
    loss_and_gradients,
)
from photograd.transport.inverse.job import Recovery
from photograd.transport.inverse.options import RecoveryOptions
from photograd.transport.inverse.result import RecoveryResult
from photograd.transport.inverse.target import Target
from photograd.transport.inverse.unknown import Unknown
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

"""A picture that a recovery is to match."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd.capture.camera import Camera
from photograd.errors import RangeError, ShapeError, message
from photograd.transport.scene import Scene
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class Target:
    """A photograph, or a rendering, of the scene that is looked for.

    Attributes:
        image: (H, W, 3) linear radiance; kept as float64.
        camera: that took it; None is the scene's.
        weight: how much pixels count, at least 0, of shape (H, W), (H, W, 1) or (H, W, 3); 0 leaves
            a pixel out. None counts all alike.

    Raises:
        ShapeError: a picture of another shape, or one that the camera does not take.
        RangeError: numbers that are not finite, or weights below 0.
    """

    image: Any
    camera: Camera | None = None
    weight: Any = None

    def __post_init__(self) -> None:
        image = np.ascontiguousarray(self.image, np.float64)
        if image.ndim != 3 or image.shape[2] != 3 or not image.size:
            raise ShapeError(message("Target", "image", "shape (H, W, 3)", image.shape))
        if not np.isfinite(image).all():
            row, column = np.argwhere(~np.isfinite(image))[0][:2]
            got = f"others, first in pixel ({column}, {row})"
            raise RangeError(message("Target", "image", "finite numbers", got))
        object.__setattr__(self, "image", image)
        if self.camera is not None:
            require_size(image, self.camera)
        if self.weight is None:
            return
        weight = np.asarray(self.weight, np.float64)
        weight = weight[..., None] if weight.ndim == 2 else weight
        if weight.shape not in (image.shape, (*image.shape[:2], 1)):
            expected = f"shape {image.shape[:2]} or {image.shape}"
            raise ShapeError(message("Target", "weight", expected, np.shape(self.weight)))
        if not bool((np.isfinite(weight) & (weight >= 0)).all()):
            raise RangeError(message("Target", "weight", "finite numbers of at least 0", "others"))
        object.__setattr__(self, "weight", np.array(np.broadcast_to(weight, image.shape)))


def require_size(image: Array, camera: Camera) -> None:
    """Raise ShapeError unless the camera takes pictures of this size."""
    if image.shape[:2] != (camera.height, camera.width):
        expected = f"{camera.width} x {camera.height} pixels as the camera has"
        got = f"{image.shape[1]} x {image.shape[0]}"
        raise ShapeError(message("Target", "image", expected, got))


def checked_targets(targets: Any, scene: Scene) -> tuple[Target, ...]:
    """One picture or several, bare or as `Target`, all with a camera.

    Raises:
        ShapeError: none, or a picture that its camera does not take.
    """
    if isinstance(targets, Target | np.ndarray):
        targets = (targets,)
    if not isinstance(targets, Sequence) or not targets:
        raise ShapeError(message("recover", "targets", "at least one picture", "none"))
    found = []
    for each in targets:
        target = each if isinstance(each, Target) else Target(each)
        camera = scene.camera if target.camera is None else target.camera
        require_size(target.image, camera)
        found.append(Target(target.image, camera, target.weight))
    return tuple(found)


def loss_weights(target: Target, kind: str) -> Array:
    """What the squared difference of each number is multiplied by, (H, W, 3).

    "relative" divides the difference by the target plus the channel's mean: a highlight then does
    not outshout the rest, nor a bright channel a dark one. The weight depends on the target alone:
    through one that depended on the rendering, its noise would come back in.
    """
    own = np.ones_like(target.image) if target.weight is None else target.weight
    if kind == "squared":
        return np.asarray(own)
    level = np.maximum(target.image, 0.0)
    return np.asarray(own / np.square(level + np.maximum(level.mean(axis=(0, 1)), 1e-6)))

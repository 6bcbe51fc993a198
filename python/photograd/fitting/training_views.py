"""The pictures a fit learns from when it draws whole pictures: one view a step, in random order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from photograd_course.color import srgb_decode
from photograd_course.random import permutation

from photograd.capture.camera import Camera
from photograd.capture.view import View, display_color
from photograd.errors import RangeError, message
from photograd.fitting.pixels import digest_of, require_valid_pixels
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class TrainingView:
    """A photograph as splats see it: display values."""

    camera: Camera
    premultiplied: NDArray[np.float32]  # (H, W, 4) display colour times alpha, alpha
    valid: NDArray[np.bool_] | None  # (H, W); None: all of it


class TrainingViews:
    """All training views in memory, 16 bytes a pixel.

    Attributes:
        views: in the order of the capture.
        digest: twelve hexadecimal digits that change with any image or camera.
        color_space: "display"; linear photographs are encoded.
    """

    color_space = "display"

    def __init__(self, views: Sequence[View]) -> None:
        """Reads every image once. Raises what reading an image raises, RangeError for no views."""
        if not views:
            raise RangeError(message("TrainingViews", "views", "at least one view", "none"))
        self.names = [view.name for view in views]
        self.views = [_training_view(view) for view in views]
        require_valid_pixels(
            "TrainingViews", [view.valid is None or bool(view.valid.any()) for view in self.views]
        )
        self.digest = digest_of(views)

    def __len__(self) -> int:
        return len(self.views)

    def draw(self, *, seed: int, step: int) -> int:
        """The view of a step: every view comes once before any comes again."""
        turn, place = divmod(step, len(self.views))
        return int(permutation(seed, len(self.views), step=turn, dimension=8)[place])

    def mean_size(self) -> int:
        """Pixels of a view, on average."""
        return sum(view.premultiplied[..., 0].size for view in self.views) // len(self.views)

    def mean_color(self) -> Array:
        """(4,) mean of premultiplied linear colour and alpha over all valid pixels."""
        total, count = np.zeros(4), 0
        for view in self.views:
            pixels = view.premultiplied.reshape(-1, 4)
            if view.valid is not None:
                pixels = pixels[view.valid.ravel()]
            alpha = pixels[:, 3:]
            straight = pixels[:, :3] / np.maximum(alpha, 1e-6)
            linear = np.concatenate([srgb_decode(straight) * alpha, alpha], axis=1)
            total += linear.sum(axis=0, dtype=np.float64)
            count += len(pixels)
        return total / max(count, 1)


def _training_view(view: View) -> TrainingView:
    rgba = view.rgba()
    color = display_color(rgba[..., :3], view.color_space)
    alpha = rgba[..., 3:]
    valid = view.valid_mask()
    pixels = np.concatenate([color * alpha, alpha], axis=-1, dtype=np.float32)
    return TrainingView(view.camera, pixels, None if bool(valid.all()) else valid)

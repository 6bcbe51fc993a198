"""Positional gradient statistics (grad2d): the criterion of density control.

A Gaussian whose mean gets large gradients from every picture covers something that one Gaussian
cannot explain. The measure is |dL/d mean| on the screen, averaged over the pictures that show it,
in units of half the picture's longer side:

    p_n = mean over pictures of  |dL/d(u, v)_n| max(W, H) / 2          (u, v) in pixels

The loss is a mean over pixels, so a Gaussian's share of it does not depend on the picture's size,
while moving by a pixel means half as much at twice the size. With the factor, a threshold means the
same at every resolution: `threshold` divided by max(W, H) / 2 is the one per pixel [Kerbl2023].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from photograd.capture.camera import Camera
from photograd.errors import ShapeError, message
from photograd.types import Array


@dataclass(eq=False)
class Grad2dStatistics:
    """Sums since the last refinement: total (N,) float64 of p_n, count (N,) int64 of pictures."""

    total: Array
    count: NDArray[np.int64]

    @classmethod
    def zero(cls, count: int) -> Grad2dStatistics:
        """Of `count` Gaussians that no picture has shown."""
        return cls(np.zeros(count), np.zeros(count, np.int64))

    def checked(self, count: int) -> Grad2dStatistics:
        """Itself. Raises ShapeError unless it belongs to `count` Gaussians."""
        for name, array in (("total", self.total), ("count", self.count)):
            if array.shape != (count,):
                raise ShapeError(
                    message("Grad2dStatistics", name, f"shape ({count},)", f"{array.shape}")
                )
        return self

    def add(self, screen: Array, visible: NDArray[np.bool_], camera: Camera) -> None:
        """Add a picture: dL/d projected means (N, 2) per pixel, and which were in it (N,)."""
        half = max(camera.width, camera.height) / 2
        self.total += half * np.linalg.norm(screen.astype(np.float64), axis=1)
        self.count += visible

    def mean(self) -> Array:
        """The measure p (N,); 0 for Gaussians that no picture has shown."""
        found: Array = self.total / np.maximum(self.count, 1)
        return found

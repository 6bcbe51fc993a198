"""A lens: what does not lie in its plane of focus is blurred."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd.errors import RangeError, message


@dataclass(frozen=True)
class Lens:
    """A thin lens before the camera (cpp/photograd/camera/thin_lens.h).

    Attributes:
        radius: of its opening, metres; 0 is a pinhole.
        focus: distance from the camera, along its axis, of the plane that is sharp; metres.

    Raises:
        RangeError: a negative radius, a focus that is not positive, or either not finite.
    """

    radius: float
    focus: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.radius) and self.radius >= 0):
            raise RangeError(message("Lens", "radius", "at least 0 m", self.radius))
        if not (np.isfinite(self.focus) and self.focus > 0):
            raise RangeError(message("Lens", "focus", "above 0 m", self.focus))


PINHOLE = Lens(0.0, 1.0)

"""A lens that blurs what is out of focus, and a shutter that stays open while the camera moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd._checks import require_bounds
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.frames import check_pose
from photograd.errors import RangeError, message
from photograd.types import FloatArray


@typed_call
@dataclass(frozen=True)
class Lens:
    """A thin lens before the camera (cpp/photograd/camera/thin_lens.h).

    Attributes:
        radius: of its opening, meters; 0 is a pinhole.
        focus: distance from the camera, along its axis, of the plane that is sharp; meters.

    Raises:
        RangeError: a negative radius, a focus that is not positive, or either not finite.
    """

    radius: float
    focus: float

    def __post_init__(self) -> None:
        require_bounds(self, "radius", low=0)
        require_bounds(self, "focus", above=0)


PINHOLE = Lens(0.0, 1.0)


# A shutter that stays open while the camera moves: what is sharp in no moment is blurred.


@typed_call
@dataclass(frozen=True, eq=False)
class Shutter:
    """The camera moves from its pose to `closing` at one speed, straight on and about one axis.

    A picture is the mean over all moments in between (cpp/photograd/camera/camera_motion.h).
    Shapes may move as well (`photograd.transport.motion`); what does not, stands still.

    Attributes:
        closing: world_from_camera (4, 4) when the shutter closes; camera axes +X right, +Y down, +Z
            forward.

    Raises:
        SceneError, ShapeError: a pose that is not rigid, or not (4, 4).
    """

    closing: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "closing", check_pose("Shutter", "closing", self.closing).copy())

    def motion(self, opening: Camera) -> tuple[FloatArray, FloatArray]:
        """Way (3,) in meters, and turn (3,), radians along its axis, both in the world.

        Args:
            opening: the camera when the shutter opens.

        Raises:
            RangeError: half a turn, whose axis nobody can tell.
        """
        start = opening.world_from_camera
        turned = self.closing[:3, :3] @ start[:3, :3].T
        axis = 0.5 * np.array(
            [turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]]
        )
        sine, cosine = float(np.linalg.norm(axis)), 0.5 * (float(np.trace(turned)) - 1)
        angle = float(np.arctan2(sine, cosine))
        if angle > np.pi - 1e-3:
            expected = "less than half a turn"
            raise RangeError(message("Shutter", "closing", expected, f"{angle:.4f} radians"))
        turn = axis * (angle / sine if sine > 0 else 1.0)
        return self.closing[:3, 3] - start[:3, 3], turn

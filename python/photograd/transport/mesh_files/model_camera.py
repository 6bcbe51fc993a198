"""Cameras of files, which say what is seen but not with how many pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd._checks import require_bounds
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class ModelCamera:
    """A pinhole whose axis goes through the middle of the picture; nothing near or far is cut off.

    Attributes:
        name: unique in its file.
        field_of_view: vertical, radians, between 0 and pi.
        world_from_camera: (4, 4) rigid; camera axes +X right, +Y down, +Z forward.
        aspect: width of the picture over its height, or None if the file leaves that open.

    Raises:
        RangeError: another field of view, or an aspect that is not positive.
    """

    name: str
    field_of_view: float
    world_from_camera: Array
    aspect: float | None = None

    def __post_init__(self) -> None:
        require_bounds(self, "field_of_view", above=0, below=np.pi)
        require_bounds(self, "aspect", above=0)

    @classmethod
    def of(cls, camera: Camera, name: str = "camera") -> ModelCamera:
        """What a file can say of a camera: `camera_changes` names what it cannot.

        Args:
            camera: to be written.
            name: in the file.
        """
        angle = 2 * float(np.arctan(0.5 * camera.height / camera.fy))
        return cls(name, angle, camera.world_from_camera, camera.width / camera.height)

    def camera(self, width: int, height: int) -> Camera:
        """With square pixels; the vertical field of view holds, whatever the width.

        Raises what `Camera` raises.

        Args:
            width, height: of the picture, in pixels.
        """
        focal = 0.5 * height / float(np.tan(0.5 * self.field_of_view))
        return Camera(width, height, focal, focal, width / 2, height / 2, self.world_from_camera)

    def fitted(self, size: int) -> Camera:
        """With `size` pixels along the longer edge; square if the aspect is left open."""
        aspect = self.aspect or 1.0
        width, height = size * min(aspect, 1.0), size / max(aspect, 1.0)
        return self.camera(max(round(width), 1), max(round(height), 1))


def camera_changes(camera: Camera) -> list[str]:
    """What a `ModelCamera` cannot say of a camera, a line each: square pixels around the axis."""
    told = ModelCamera.of(camera).camera(camera.width, camera.height)
    pairs = ((name, getattr(camera, name), getattr(told, name)) for name in ("fx", "cx", "cy"))
    return [
        f"camera: {name}: {mine} is read back as {its}"
        for name, mine, its in pairs
        if abs(mine - its) > 1e-9 * abs(its)
    ]

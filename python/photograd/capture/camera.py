"""A pinhole camera: where each pixel looks, and where each point lands."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from photograd_course.portable_math import matmul

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.frames import check_pose, invert_rigid
from photograd.types import FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class Camera:
    """Pinhole camera in the world frame of the project (right-handed, +Y up).

    Attributes:
        width, height: image size in pixels.
        fx, fy: focal lengths in pixels.
        cx, cy: principal point in pixels; the center of the top left pixel is (0.5, 0.5).
        world_from_camera: (4, 4) float64 rigid pose; camera axes +X right, +Y down, +Z forward.

    Raises:
        DtypeError: a size that is no integer, or what is no number.
        RangeError: empty image, focal length not positive, or anything non-finite.
        SceneError, ShapeError: the pose is not rigid, or not (4, 4).
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    world_from_camera: FloatArray

    def __post_init__(self) -> None:
        call = Arguments("Camera")
        for name in ("width", "height"):
            call.integer(name, getattr(self, name), low=1, high=2**20 - 1)
        for name in ("fx", "fy"):
            call.number(name, getattr(self, name), above=1e-6, below=1e9)
        for name in ("cx", "cy"):
            call.number(name, getattr(self, name), above=-1e9, below=1e9)
        pose = check_pose("Camera", "world_from_camera", self.world_from_camera).copy()
        pose.setflags(write=False)
        object.__setattr__(self, "world_from_camera", pose)

    @property
    def position(self) -> FloatArray:
        """Center of projection, (3,), in the world."""
        return self.world_from_camera[:3, 3]

    @property
    def forward(self) -> FloatArray:
        """Unit viewing direction, (3,), in the world."""
        return self.world_from_camera[:3, 2]

    def rays(
        self, pixel_ids: npt.NDArray[np.integer] | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """Rays through pixel centers: pixel (column u, row v) looks along
        ((u + 0.5 - cx) / fx, (v + 0.5 - cy) / fy, 1) in the camera frame.

        Args:
            pixel_ids: (R,) integers, row * width + column; None means all, row by row.

        Returns:
            Origins (R, 3) and unit directions (R, 3), float64, in the world.

        Raises:
            ShapeError, DtypeError, RangeError: pixel_ids not (R,), not integers, outside the image.
        """
        count = self.width * self.height
        ids = np.arange(count) if pixel_ids is None else pixel_ids
        call = Arguments("Camera.rays", np.int64)
        ids = call.array("pixel_ids", ids, ("R",), low=0, high=count - 1)
        x = (ids % self.width + 0.5 - self.cx) / self.fx
        y = (ids // self.width + 0.5 - self.cy) / self.fy
        local = np.stack([x, y, np.ones_like(x)], axis=-1)
        local /= np.linalg.norm(local, axis=-1, keepdims=True)
        directions = matmul(local, self.world_from_camera[:3, :3].T)
        origins = np.broadcast_to(self.position, directions.shape).copy()
        return origins, directions

    def project(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Pixel positions (N, 2) and depths (N,) along +Z of world points (N, 3).

        Points at or behind the camera plane get NaN positions and their depth, which is <= 0.

        Raises:
            ShapeError: points not (N, 3).
        """
        call = Arguments("Camera.project", np.float64)
        points = call.array("points", points, ("N", 3), finite=False)
        camera_from_world = invert_rigid(self.world_from_camera)
        local = matmul(points, camera_from_world[:3, :3].T) + camera_from_world[:3, 3]
        depth = local[:, 2]
        safe = np.where(depth > 0.0, depth, np.nan)
        pixels = np.stack(
            [self.fx * local[:, 0] / safe + self.cx, self.fy * local[:, 1] / safe + self.cy],
            axis=-1,
        )
        return pixels, depth

    def downscaled(self, factor: int) -> Camera:
        """The camera of the image reduced by an integer box filter.

        Intrinsics divide exactly, as pixel centers sit at +0.5; a remainder of columns or rows that
        does not fill a box is cut off at the right and bottom, which moves nothing else.

        Raises:
            RangeError: factor below 1 or larger than the image.
        """
        largest = min(self.width, self.height)
        factor = Arguments("Camera.downscaled").integer("factor", factor, low=1, high=largest)
        return replace(
            self,
            width=self.width // factor,
            height=self.height // factor,
            fx=self.fx / factor,
            fy=self.fy / factor,
            cx=self.cx / factor,
            cy=self.cy / factor,
        )

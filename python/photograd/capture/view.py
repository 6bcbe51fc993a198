"""One posed photograph, read from disk when its pixels are asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.color import srgb_encode
from photograd_course.portable_math import matmul

from photograd._notebook import EDGE, png, smaller
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.undistort import Lens, undistort_image
from photograd.errors import IoError, message
from photograd.images.read import ColorSpace, ImageArray, downscale_image, read_image
from photograd.types import FloatArray


def display_color(color: npt.NDArray[Any], color_space: ColorSpace) -> npt.NDArray[Any]:
    """Colors of a view in display values: encoded if they are linear. Same shape and dtype.

    Args:
        color: (..., 3).
        color_space: of the view.
    """
    return srgb_encode(color) if color_space == "linear" else color


@typed_call
@dataclass(frozen=True, eq=False)
class View:
    """One photograph and its camera. Pixels are read when asked for and not kept.

    Attributes:
        name: unique within its capture.
        camera: the pinhole camera of the pixels that `rgba` returns.
        image: file, or (H, W, 4) float32 pixels with straight alpha.
        color_space: "display" (sRGB-encoded values) or "linear".
        distortion: lens of the file's pixels; removed by `rgba`.
        downscale: integer box factor between the file and `camera`.
        source_size: (width, height) of the file.
        mask_file: image that is black where pixels must not be used.
    """

    name: str
    camera: Camera
    image: Path | ImageArray
    color_space: ColorSpace = "display"
    distortion: Lens | None = None
    downscale: int = 1
    source_size: tuple[int, int] | None = None
    mask_file: Path | None = None

    def rgba(self) -> ImageArray:
        """Pixels (H, W, 4) float32 of `camera`, straight alpha; zeros where `valid_mask` is False.

        Raises:
            IoError: the file is missing, damaged, or not of the size that it had on loading.
        """
        source = self.source_camera()
        image = read_image(self.image) if isinstance(self.image, Path) else self.image
        shape = (source.height, source.width, 4)
        if image.shape != shape:
            argument = f"view '{self.name}'"
            raise IoError(message("View.rgba", argument, f"shape {shape}", image.shape))
        if self.distortion is not None:
            image = undistort_image(image, source, self.distortion)[0]
        image = downscale_image(image, self.downscale)[0]
        if self.distortion is None and self.mask_file is None:
            return image
        return image * self.valid_mask()[..., None]

    def thumbnail(self, edge: int) -> npt.NDArray[Any]:
        """The photograph (h, w, 3) over white in display values, at most `edge` pixels a side.

        Raises:
            IoError: as for `rgba`.
        """
        pixels = self.rgba()
        alpha = pixels[..., 3:]
        color = np.clip(display_color(pixels[..., :3], self.color_space), 0, 1)
        return smaller(color * alpha + (1 - alpha), edge)

    def _repr_png_(self) -> bytes:
        """The photograph, small."""
        return png(self.thumbnail(EDGE))

    def valid_mask(self) -> npt.NDArray[np.bool_]:
        """Pixels (H, W) that the photograph covers and no mask file excludes.

        Raises:
            IoError: the mask file is missing, damaged, or not of the size of the photograph.
        """
        source = self.source_camera()
        mask = np.ones((source.height, source.width, 4), dtype=np.float32)
        if self.mask_file is not None:
            loaded = read_image(self.mask_file)
            if loaded.shape != mask.shape:
                argument = f"view '{self.name}': {self.mask_file}"
                expected = f"a mask of shape {mask.shape[:2]}"
                raise IoError(message("View.valid_mask", argument, expected, loaded.shape[:2]))
            mask[..., :3] = loaded[..., :3]
        valid = np.ones(mask.shape[:2], dtype=np.bool_)
        if self.distortion is not None:
            mask, valid = undistort_image(mask, source, self.distortion)
        valid = valid & (mask[..., :3].min(axis=2) > 0.5)
        return downscale_image(mask, self.downscale, valid)[1]

    def downscaled(self, factor: int) -> View:
        """The same view reduced by an integer box average.

        Args:
            factor: pixels of the view along an edge of a new one.
        """
        camera = self.camera.downscaled(factor)
        return replace(
            self, camera=camera, downscale=self.downscale * factor, source_size=self._source_size()
        )

    def transformed(self, world_from_source: FloatArray) -> View:
        """The same view after the world was moved by a (4, 4) rigid transform.

        Args:
            world_from_source: (4, 4).
        """
        pose = matmul(world_from_source, self.camera.world_from_camera)
        return replace(self, camera=replace(self.camera, world_from_camera=pose))

    def _source_size(self) -> tuple[int, int]:
        camera, factor = self.camera, self.downscale
        return self.source_size or (camera.width * factor, camera.height * factor)

    def source_camera(self) -> Camera:
        """The pinhole camera of the file's pixels, before `downscale`; its lens is `distortion`."""
        width, height = self._source_size()
        camera, factor = self.camera, self.downscale
        return replace(
            camera,
            width=width,
            height=height,
            fx=camera.fx * factor,
            fy=camera.fy * factor,
            cx=camera.cx * factor,
            cy=camera.cy * factor,
        )

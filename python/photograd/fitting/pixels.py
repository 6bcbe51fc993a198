"""The pixels a fit learns from: all training views, drawn at random, with their rays."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from photograd_course.color import srgb_decode
from photograd_course.random import uniform_int

from photograd.capture.view import View
from photograd.errors import IoError, RangeError, message
from photograd.representation import RayBatch
from photograd.types import Array

_RAYS_AT_ONCE = 1 << 16


class TrainingPixels:
    """Premultiplied linear colour and alpha of every valid pixel, and the cameras they belong to.

    Attributes:
        premultiplied: (P, 4) float32, linear Rec. 709 times alpha, alpha. color_space: "display" if
        the files were 8-bit sRGB (the loss is then taken on encoded values). digest: twelve
        hexadecimal digits that change with any image or camera.
    """

    def __init__(self, views: Sequence[View], color_space: str) -> None:
        """Reads every image once. Raises what reading an image raises."""
        if not views:
            raise RangeError(message("TrainingPixels", "views", "at least one view", "none"))
        self.color_space = color_space
        self.names = [view.name for view in views]
        cameras = [view.camera for view in views]
        self._width = np.array([camera.width for camera in cameras], np.int64)
        self._intrinsics = np.array([[c.fx, c.fy, c.cx, c.cy] for c in cameras])
        self._rotation = np.stack([c.world_from_camera[:3, :3] for c in cameras])
        self._position = np.stack([c.world_from_camera[:3, 3] for c in cameras])
        self.digest = digest_of(views)
        colors, owners, ids = [], [], []
        for index, view in enumerate(views):
            rgba = view.rgba().reshape(-1, 4)
            valid = np.flatnonzero(view.valid_mask().ravel())
            colors.append(_premultiplied_linear(rgba[valid], color_space))
            owners.append(np.full(len(valid), index, np.int32))
            ids.append(valid.astype(np.int32))
        require_valid_pixels("TrainingPixels", [len(owner) > 0 for owner in owners])
        self.premultiplied: NDArray[np.float32] = np.concatenate(colors)
        self._view: NDArray[np.int32] = np.concatenate(owners)
        self._pixel: NDArray[np.int32] = np.concatenate(ids)

    def __len__(self) -> int:
        return len(self._view)

    def draw(self, count: int, *, seed: int, step: int) -> NDArray[np.int64]:
        """`count` pixel numbers, uniform with replacement: a function of seed and step alone."""
        draw = np.arange(count)
        return uniform_int(seed, len(self), step=step, pixel=draw, sample=0, dimension=0)

    def mean_color(self) -> Array:
        """(4,) mean of premultiplied linear colour and alpha."""
        mean: Array = self.premultiplied.mean(axis=0, dtype=np.float64)
        return mean

    def batches(self, most: int) -> Iterator[RayBatch]:
        """Rays of all views, at most about `most`: every pixel, or every second, third, ..."""
        chosen = np.arange(0, len(self), max(1, -(-len(self) // most)))
        for start in range(0, len(chosen), _RAYS_AT_ONCE):
            yield self.rays(chosen[start : start + _RAYS_AT_ONCE])

    def rays(self, chosen: NDArray[np.int64]) -> RayBatch:
        """The rays through the centres of the chosen pixels."""
        view = self._view[chosen]
        pixel = self._pixel[chosen]
        width = self._width[view]
        fx, fy, cx, cy = self._intrinsics[view].T
        local = np.stack(
            [(pixel % width + 0.5 - cx) / fx, (pixel // width + 0.5 - cy) / fy, np.ones(len(view))],
            axis=-1,
        )
        local /= np.linalg.norm(local, axis=-1, keepdims=True)
        directions = np.einsum("rij,rj->ri", self._rotation[view], local)
        return RayBatch(self._position[view], directions, chosen.astype(np.uint32))


def require_valid_pixels(function: str, has_some: Sequence[bool]) -> None:
    """Raise RangeError if none of the training views has a valid pixel to learn from."""
    if not any(has_some):
        raise RangeError(
            message(function, "views", "a valid pixel in the training views",
                    f"none in {len(has_some)} of them",
                    "their masks are empty, or the lens's distortion leaves nothing of them")
        )  # fmt: skip


def digest_of(views: Sequence[View]) -> str:
    """Of stored bytes rather than decoded pixels, so that it is the same on every machine."""
    total = hashlib.blake2b(digest_size=6)
    for view in views:
        camera = view.camera
        lens = [camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy]
        numbers = np.concatenate([lens, camera.world_from_camera.ravel()])
        # Micrometres and millionths of a pixel: loading may round differently in the last bit.
        total.update(np.rint(numbers * 1e6).astype(np.int64).tobytes())
        for content in (view.image, view.mask_file):
            if isinstance(content, Path):
                total.update(_file_bytes(content))
            elif content is not None:
                total.update(np.ascontiguousarray(content).tobytes())
    return total.hexdigest()


def _file_bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as failure:
        got = f"{path}: {failure.strerror or failure}"
        raise IoError(
            message("TrainingPixels", "views", "files that can be read", got)
        ) from failure


def _premultiplied_linear(rgba: Array, color_space: str) -> NDArray[np.float32]:
    color = srgb_decode(rgba[:, :3]) if color_space == "display" else rgba[:, :3]
    alpha = rgba[:, 3:]
    return np.concatenate([color * alpha, alpha], axis=1, dtype=np.float32)

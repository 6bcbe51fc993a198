"""What a fit learns from: pixels or whole views of the photographs, and what stands behind them.

Random backgrounds keep a fit from painting the background into the scene instead of leaving space
empty: only opacity can then explain a pixel. Photographs without alpha have no such freedom; there
one color for all directions is learned, as sigmoid(raw) so that it stays in (0, 1).
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from photograd_course.color import srgb_decode
from photograd_course.portable_math import log, sigmoid
from photograd_course.random import permutation, uniform, uniform_int

from photograd.capture.camera import Camera
from photograd.capture.view import View, display_color
from photograd.errors import IoError, RangeError, message
from photograd.representation import RayBatch
from photograd.types import Array


def background_kind(option: str, *, has_alpha: bool) -> str:
    """What "auto" means: random where the photographs have alpha, else learned.

    Args:
        option: `FitOptions.background`.
        has_alpha: whether the photographs have alpha.
    """
    if option == "auto":
        return "random" if has_alpha else "learned"
    return option


def first_background(mean: Array) -> Array:
    """Raw parameter (3,) float32 to start a learned background from.

    `mean` (4,) is the mean pixel: linear premultiplied color, and alpha.
    """
    return raw_background(np.clip(mean[:3] / max(mean[3], 1e-6), 0.02, 0.98))


def raw_background(color: Array) -> Array:
    """Raw parameter (3,) float32 whose `learned_background` is this linear color in (0, 1)."""
    return log(color / (1 - color)).astype(np.float32)


def learned_background(raw: Array) -> Array:
    """Linear color (3,) of the raw parameter (3,): sigmoid(raw)."""
    return sigmoid(raw)


def learned_background_backward(raw: Array, d_color: Array) -> Array:
    """d_raw = d_color * color * (1 - color).

    Args:
        raw: (3,) the parameter behind `learned_background`.
        d_color: (3,) dL/d color.
    """
    color = learned_background(raw)
    d_raw: Array = d_color * color * (1 - color)
    return d_raw


def random_background(count: int, *, seed: int, step: int, first: int = 0) -> Array:
    """Linear colors (R, 3) float32, uniform in display values, for rays first .. first + R - 1.

    Args:
        count: R, how many rays.
        seed: of the fit.
        step: of the fit.
        first: number of the first ray in its step.
    """
    index = 3 * first + np.arange(3 * count)
    u = uniform(seed, step=step, pixel=index, sample=1, dimension=0)
    return srgb_decode(u.reshape(count, 3)).astype(np.float32)


def constant_background(kind: str) -> Array:
    """Linear (3,) float32 of "white" or "black".

    Args:
        kind: "white" or "black".
    """
    return np.full(3, {"white": 1.0, "black": 0.0}[kind], np.float32)


# The pixels a fit learns from: all training views, drawn at random, with their rays.


_RAYS_AT_ONCE = 1 << 16


class TrainingPixels:
    """Premultiplied linear color and alpha of every valid pixel, and the cameras they belong to.

    Attributes:
        premultiplied: (P, 4) float32, linear Rec. 709 times alpha, alpha.
        color_space: "display" if the files were 8-bit sRGB; the loss is then taken on encoded
            values.
        digest: twelve hexadecimal digits that change with any image or camera.
    """

    def __init__(self, views: Sequence[View], color_space: str) -> None:
        """Reads every image once. Raises what reading an image raises.

        Args:
            views: the photographs.
            color_space: of the capture, "display" or "linear".
        """
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
        """(4,) mean of premultiplied linear color and alpha."""
        mean: Array = self.premultiplied.mean(axis=0, dtype=np.float64)
        return mean

    def size_of(self, rays: int) -> int:
        """Pixels of a step with so many rays."""
        return rays

    def spread(self, max_rays: int) -> list[tuple[NDArray[np.int64], float]]:
        """Evenly spaced pixels of all views in several parts, each with its share of the whole.

        They are at most about `max_rays`: every pixel, or every second, third, ...
        """
        chosen = np.arange(0, len(self), max(1, -(-len(self) // max_rays)))
        starts = range(0, len(chosen), _RAYS_AT_ONCE)
        parts = (chosen[start : start + _RAYS_AT_ONCE] for start in starts)
        share = 1 / len(chosen)
        return [(part, len(part) * share) for part in parts]

    def batches(self, max_rays: int) -> Iterator[RayBatch]:
        """Rays of the pixels of `spread`.

        Args:
            max_rays: about so many in all.
        """
        for chosen, _ in self.spread(max_rays):
            yield self.rays(chosen)

    def rays(self, chosen: NDArray[np.int64]) -> RayBatch:
        """The rays through the centers of the chosen pixels."""
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
    """Raise RangeError if none of the training views has a valid pixel to learn from.

    Args:
        function: on whose behalf the error speaks.
        has_some: for each view, whether it has a valid pixel.
    """
    if not any(has_some):
        raise RangeError(
            message(
                function,
                "views",
                "a valid pixel in the training views",
                f"none in {len(has_some)} of them",
                "their masks are empty, or the lens's distortion leaves nothing of them",
            )
        )


def digest_of(views: Sequence[View]) -> str:
    """Of stored bytes rather than decoded pixels, so that it is the same on every machine.

    Args:
        views: whose images and cameras count.
    """
    total = hashlib.blake2b(digest_size=6)
    for view in views:
        camera = view.camera
        lens = [camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy]
        numbers = np.concatenate([lens, camera.world_from_camera.ravel()])
        # Micrometers and millionths of a pixel: loading may round differently in the last bit.
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


# The pictures a fit learns from when it draws whole pictures: one view a step, in random order.


@dataclass(frozen=True, eq=False)
class TrainingView:
    """A photograph as splats see it: display values."""

    camera: Camera
    premultiplied: NDArray[np.float32]  # (H, W, 4) display color times alpha, alpha
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

    def draw(self, count: int = 1, *, seed: int, step: int) -> int:
        """The view of a step, however many rays it may have: each comes once before any again.

        Args:
            count: not used; a step sees one whole view.
            seed: of the fit.
            step: of the fit.
        """
        del count
        turn, index = divmod(step, len(self.views))
        return int(permutation(seed, len(self.views), step=turn, dimension=8)[index])

    def size_of(self, rays: int) -> int:
        """Pixels of a step, which draws a view whatever number of `rays` others have: the mean."""
        del rays
        return sum(view.premultiplied[..., 0].size for view in self.views) // len(self.views)

    def spread(self, max_rays: int) -> list[tuple[int, float]]:
        """Evenly spaced views, as many as have `max_rays` pixels, and the share of each."""
        chosen = range(0, len(self), max(1, -(-len(self) * self.size_of(0) // max_rays)))
        return [(view, 1 / len(chosen)) for view in chosen]

    def batches(self, max_rays: int) -> Iterator[RayBatch]:
        """Rays of all views, at most about `max_rays`: every pixel, or every second, third, ..."""
        first = 0
        for view in self.views:
            size = view.camera.width * view.camera.height
            pixels = np.arange(0, size, max(1, -(-len(self) * size // max_rays)))
            yield RayBatch(*view.camera.rays(pixels), (first + pixels).astype(np.uint32))
            first += size

    def mean_color(self) -> Array:
        """(4,) mean of premultiplied linear color and alpha over all valid pixels."""
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

"""Antialiasing after the fact, by luminance in one frame [Lottes2009], and over several frames.

`fxaa` looks for steps of luminance and blends across them; `TemporalAntialiasing` samples each
pixel at other points in each frame and averages over time [Karis2014]: what it held is looked up
where it was in the last frame, and brought into the range of what is around it now.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.pixels import color_argument, look_up, pixel_centers
from photograd.types import Array

LUMA = (0.2126, 0.7152, 0.0722)  # of linear Rec. 709
LEAST_CONTRAST, PART_OF_RANGE = 0.03, 0.125
STEPS = (1, 2, 3, 4, 6, 8, 12)
"""Pixels along an edge at which its end is looked for."""


@typed_call
def fxaa(display: Array) -> Array:
    """Blend across edges, by as much as their distance to the next step of the edge says.

    Args:
        display: (H, W, 3) display-encoded colors from 0 to 1, float32 or float64.

    Returns:
        (H, W, 3) of the same dtype; pixels of little contrast are not changed.

    Raises:
        DtypeError, ShapeError, RangeError: colors of another dtype or shape, or outside of [0, 1].
    """
    call = Arguments("fxaa")
    display = call.array("display", display, ("H", "W", 3), min_length=1, low=0.0, high=1.0)
    luma = _luma(display)
    north, south, west, east = (_moved(luma, dy, dx) for dy, dx in _AROUND)
    low = np.minimum.reduce([luma, north, south, west, east])
    high = np.maximum.reduce([luma, north, south, west, east])
    contrast = high - low
    is_edge = contrast >= np.maximum(LEAST_CONTRAST, PART_OF_RANGE * high)
    corners = [_moved(luma, dy, dx) for dy, dx in ((-1, -1), (-1, 1), (1, -1), (1, 1))]
    across_rows = np.abs(corners[0] + corners[2] - 2 * west) + 2 * np.abs(north + south - 2 * luma)
    across_rows += np.abs(corners[1] + corners[3] - 2 * east)
    across_columns = np.abs(corners[0] + corners[1] - 2 * north)
    across_columns += 2 * np.abs(west + east - 2 * luma)
    across_columns += np.abs(corners[2] + corners[3] - 2 * south)
    level = across_rows >= across_columns  # the edge runs along a row
    before, after = np.where(level, north, west), np.where(level, south, east)
    to_after = np.abs(after - luma) >= np.abs(before - luma)
    step = np.where(to_after, 1.0, -1.0)
    opposite = np.where(to_after, after, before)
    shift = np.where(is_edge, _distance_blend(luma, opposite, level, step), 0.0)
    y_step, x_step = np.where(level, step, 0.0) * shift, np.where(level, 0.0, step) * shift
    x, y = pixel_centers(*luma.shape)
    blended = look_up(display, x + x_step, y + y_step)
    return np.where(is_edge[..., None], blended, display)


_AROUND = ((-1, 0), (1, 0), (0, -1), (0, 1))


def _luma(display: Array) -> Array:
    return np.asarray(sum(weight * display[..., k] for k, weight in enumerate(LUMA)), np.float64)


def _moved(values: Array, dy: int, dx: int) -> Array:
    """What lies dy rows and dx columns further on; the border is repeated."""
    rows = np.clip(np.arange(values.shape[0]) + dy, 0, values.shape[0] - 1)
    columns = np.clip(np.arange(values.shape[1]) + dx, 0, values.shape[1] - 1)
    return values[np.ix_(rows, columns)]


def _distance_blend(luma: Array, opposite: Array, level: Array, step: Array) -> Array:
    """Pixels by which a lookup is moved across the edge: half at its end, none in its middle."""
    middle, slope = 0.5 * (luma + opposite), 0.25 * np.abs(luma - opposite)
    x, y = pixel_centers(*luma.shape)
    half_x, half_y = np.where(level, 0.0, 0.5 * step), np.where(level, 0.5 * step, 0.0)
    ends, signs = [], []
    for way in (-1.0, 1.0):
        found = np.full(luma.shape, float(STEPS[-1]))
        last = np.zeros_like(luma)
        still = np.ones(luma.shape, bool)
        for distance in STEPS:
            along_x = np.where(level, way * distance, 0.0)
            along_y = np.where(level, 0.0, way * distance)
            found_luma = look_up(luma[..., None], x + half_x + along_x, y + half_y + along_y)[
                ..., 0
            ]
            difference = found_luma - middle
            ended = still & (np.abs(difference) >= slope)
            found[ended], last[still] = distance, difference[still]
            still &= ~ended
        ends.append(found)
        signs.append(last < 0)
    nearer_is_first = ends[0] < ends[1]
    nearest, sign = np.where(nearer_is_first, *ends), np.where(nearer_is_first, *signs)
    # At the end of the edge, luminance turns away from the pixel's own only on its far side.
    turns = sign != (luma - middle < 0)
    return np.where(turns, np.maximum(0.5 - nearest / (ends[0] + ends[1]), 0.0), 0.0)


@typed_call
@dataclass
class TemporalAntialiasing:
    """A mean over frames, each of which samples other points of the pixels.

    Attributes:
        weight: of a new frame; the history keeps the rest.
        clamped: whether the history is brought into the range of the 3 x 3 pixels around it, so
            that what has changed leaves no trail.
        frames: how many have been added.
    """

    weight: float = 0.1
    clamped: bool = True
    frames: int = 0
    history: Array | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        Arguments("TemporalAntialiasing").number("weight", self.weight, above=0.0, high=1.0)

    def camera(self, camera: Camera) -> Camera:
        """The camera for the next frame: moved by part of a pixel [Halton1964].

        Args:
            camera: that looks at the centers of the pixels.
        """
        index = self.frames % 16 + 1
        dx, dy = _radical_inverse(index, 2) - 0.5, _radical_inverse(index, 3) - 0.5
        return replace(camera, cx=camera.cx - dx, cy=camera.cy - dy)

    def add(self, color: Array, moved: Array | None = None) -> Array:
        """The picture after one more frame.

        Args:
            color: (H, W, 3) linear radiance of the frame, by `camera`.
            moved: (H, W, 2) pixels since the last frame, of `velocity`; None stands still. Where it
                is NaN, or leads out of the picture, the history is dropped.

        Raises:
            DtypeError, ShapeError, RangeError: arrays of other dtypes or sizes than before.
        """
        call = Arguments("TemporalAntialiasing.add")
        color = color_argument(call, color)
        if self.history is None:
            self.history, self.frames = color.copy(), 1
            return self.history.copy()
        size = color.shape[:2]
        call.array("color", color, self.history.shape)
        x, y = pixel_centers(*size)
        outside = np.zeros(size, bool)
        if moved is not None:
            moved = call.array("moved", moved, (*size, 2), dtype=np.float64, finite=False)
            x, y = x - moved[..., 0], y - moved[..., 1]
            outside = ~((x >= 0) & (y >= 0) & (x <= size[1]) & (y <= size[0]))
            x, y = np.where(outside, 0.5, x), np.where(outside, 0.5, y)
        held = self.history if moved is None else look_up(self.history, x, y)
        if self.clamped:
            around = [_moved_color(color, dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
            held = np.clip(held, np.minimum.reduce(around), np.maximum.reduce(around))
        # The first frames are averaged alike.
        weight = max(self.weight, 1.0 / (self.frames + 1))
        mixed = held + weight * (color - held)
        self.history = np.where(outside[..., None], color, mixed).astype(color.dtype)
        self.frames += 1
        return self.history.copy()


def _moved_color(color: Array, dy: int, dx: int) -> Array:
    return np.stack([_moved(color[..., k], dy, dx) for k in range(3)], axis=-1)


def _radical_inverse(index: int, base: int) -> float:
    """Van der Corput's number, the digits of `index` behind the point."""
    value, digit = 0.0, 1.0 / base
    while index:
        index, rest = divmod(index, base)
        value, digit = value + rest * digit, digit / base
    return value

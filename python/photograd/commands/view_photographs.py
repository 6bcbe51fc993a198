"""Photographs in `photograd view`: which is nearest, and one of them over, beside or against what
is rendered, where the camera looks through it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from photograd.capture.camera import Camera
from photograd.capture.view import display_color
from photograd.commands.view_drawing import Drawing, resized
from photograd.fitting.drawing import Picture
from photograd.types import Array, FloatArray

if TYPE_CHECKING:
    from photograd.capture import Capture
    from photograd.capture.view import View

LAYERS = ("photograph", "split", "difference")
EXPLAIN = {
    "photograph": "the photograph, over what is rendered.",
    "split": "the photograph to the left, what is rendered to the right.",
    "difference": "|rendering - photograph|, mean over the channels, from purple to yellow; gray "
    "has no photograph.",
}
HOW_TO = "Click on a photograph to look through it."
NEAREST = "nearest"
THROUGH = 1e-3
"""In diagonals of the scene: so far from a photograph's camera is still at it."""
AHEAD = 0.5
"""A quarter of a turn away from a photograph's direction counts as so many diagonals of path."""
QUANTILE = 0.995


@dataclass(frozen=True, eq=False)
class Photographs:
    """Photographs of a capture in the frame of the page.

    Attributes:
        views: with cameras in that frame.
        reach: the diagonal of the scene in meters.
    """

    views: tuple[View, ...]
    reach: float

    @classmethod
    def of(
        cls, capture: Capture, turn: Callable[[Camera, FloatArray], Camera], reach: float
    ) -> Photographs:
        """All photographs of a capture.

        Args:
            capture: that has them.
            turn: camera of the capture, world_from_source -> the camera in the frame of the page.
            reach: the diagonal of the scene in meters.
        """
        turned = (
            replace(view, camera=turn(view.camera, capture.world_from_source))
            for view in capture.views
        )
        return cls(tuple(turned), reach)

    def named(self, name: str, camera: Camera) -> View:
        """The photograph of a name, or the one nearest to a camera.

        Args:
            name: of a view, or `NEAREST`.
            camera: of the page.
        """
        for view in self.views:
            if view.name == name:
                return view
        return self.views[self.nearest(camera)]

    def nearest(self, camera: Camera) -> int:
        """Number of the photograph with the nearest place and direction.

        Args:
            camera: of the page.
        """
        positions = np.stack([view.camera.position for view in self.views])
        ahead = np.stack([view.camera.forward for view in self.views])
        away = np.linalg.norm(positions - camera.position, axis=1) / self.reach
        turned = np.arccos(np.clip(ahead @ camera.forward, -1.0, 1.0)) / (0.5 * math.pi)
        return int((away + AHEAD * turned).argmin())

    def near(self, camera: Camera, share: float) -> list[str]:
        """Names of the photographs that were taken close to a camera.

        Args:
            camera: of the page.
            share: how far away, in diagonals of the scene.
        """
        reach = share * self.reach
        away = (view.camera.position - camera.position for view in self.views)
        return [
            view.name
            for view, way in zip(self.views, away, strict=True)
            if float(np.linalg.norm(way)) <= reach
        ]

    def through(self, camera: Camera) -> View | None:
        """The photograph at whose place a camera is; of several the nearest in direction.

        Args:
            camera: of the page.
        """
        view = self.views[self.nearest(camera)]
        away = float(np.linalg.norm(view.camera.position - camera.position))
        return view if away <= THROUGH * self.reach else None


def fov_that_shows(camera: Camera, aspect: float) -> float:
    """Vertical angle of view, in radians, of a page on which the whole photograph is seen.

    Args:
        camera: of the photograph.
        aspect: width by height of the page.
    """
    half_down = 0.5 * camera.height / camera.fy
    half_across = 0.5 * camera.width / camera.fx
    return 2 * math.atan(max(half_down, half_across / aspect))


def display_pixels(view: View) -> Array:
    """(H, W, 3) the photograph over white, in display values.

    Args:
        view: the photograph.

    Raises:
        IoError: it cannot be read.
    """
    rgba = view.rgba()
    alpha = rgba[..., 3:]
    color = np.clip(display_color(rgba[..., :3], view.color_space), 0, 1)
    return np.asarray(color * alpha + (1 - alpha))


def photograph_through(
    pixels: Array, photograph: Camera, camera: Camera
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """A photograph as a camera at its place sees it (H, W, 3), and where it has pixels (H, W).

    Only directions count; each pixel of the camera takes the nearest of the photograph.

    Args:
        pixels: (h, w, 3) of the photograph.
        photograph: its camera.
        camera: at the same place, looking anywhere.
    """
    _, directions = camera.rays()
    at, depth = photograph.project(photograph.position + directions)
    column, row = (np.floor(np.nan_to_num(axis, nan=-1.0)).astype(np.int64) for axis in at.T)
    height, width = pixels.shape[:2]
    inside = (depth > 0) & (column >= 0) & (column < width) & (row >= 0) & (row < height)
    found = np.ones((len(directions), 3))
    found[inside] = pixels[row[inside], column[inside]]
    size = camera.height, camera.width
    return found.reshape(*size, 3), inside.reshape(size)


def combined(layer: str, rendered: Array, photo: Array, inside: NDArray[np.bool_]) -> FloatArray:
    """A layer (H, W, 3) of `LAYERS`: the photograph, half of it, or the mean absolute difference.

    The scale of differences ends at a quantile of them, rounded up, as that of `photograd
    evaluate` does; gray is where the photograph has no pixel.

    Args:
        layer: of `LAYERS`.
        rendered: (H, W, 3) display values.
        photo: (H, W, 3) of the photograph.
        inside: (H, W) where it has pixels.
    """
    if layer == "difference":
        return difference_colors(rendered, photo, inside)
    shown = inside.copy()
    if layer == "split":
        shown[:, shown.shape[1] // 2 :] = False
    found = np.where(shown[..., None], photo, rendered)
    if layer == "split":
        middle = found.shape[1] // 2
        found[:, max(middle - 1, 0) : middle] = 1.0
    return np.asarray(found, np.float64)


def difference_limit(rendered: Array, photo: Array, inside: NDArray[np.bool_]) -> float:
    """The end of the scale of mean absolute differences.

    Args:
        rendered: (H, W, 3) display values.
        photo: (H, W, 3) of the photograph.
        inside: (H, W) where it has pixels.
    """
    from photograd_course.viz.scale import nice_limit

    difference = np.abs(rendered - photo).mean(axis=2)[inside]
    return nice_limit(float(np.quantile(difference, QUANTILE)) if difference.size else 0.0)


def difference_colors(rendered: Array, photo: Array, inside: NDArray[np.bool_]) -> FloatArray:
    """(H, W, 3) colors of mean absolute differences, gray where there is none.

    Args:
        rendered: (H, W, 3) display values.
        photo: (H, W, 3) of the photograph.
        inside: (H, W) where it has pixels.
    """
    import matplotlib as mpl
    from matplotlib.colors import to_rgb
    from photograd_course.viz import style

    share = np.abs(rendered - photo).mean(axis=2) / difference_limit(rendered, photo, inside)
    colors = np.asarray(mpl.colormaps[style.MAGNITUDE_MAP](np.clip(share, 0, 1)))
    found: FloatArray = colors[..., :3]
    found[~inside] = to_rgb(style.MISSING)
    return found


class Overlay:
    """Pictures with a photograph over, beside or against them; the last photograph is kept."""

    def __init__(
        self, photographs: Photographs, on_change: Callable[[str], None] = lambda _: None
    ) -> None:
        """Begin without any read.

        Args:
            photographs: in the frame of the page.
            on_change: takes what a picture shows, in Markdown.
        """
        self.photographs = photographs
        self._on_change = on_change
        self._kept: tuple[str, Array] | None = None

    def pixels(self, view: View) -> Array:
        """Those of `display_pixels`.

        Args:
            view: the photograph.

        Raises:
            IoError: it cannot be read.
        """
        if self._kept is None or self._kept[0] != view.name:
            self._kept = view.name, display_pixels(view)
        return self._kept[1]

    def pictures(self, layer: str, draw: Drawing, camera: Camera) -> Iterator[Picture | None]:
        """What is drawn, with the photograph that the camera looks through, if it does.

        Args:
            layer: of `LAYERS`.
            draw: what is rendered.
            camera: of the page.

        Raises:
            IoError: the photograph cannot be read.
        """
        view = self.photographs.through(camera)
        self._on_change(f"{HOW_TO}" if view is None else f"**{view.name}**: {EXPLAIN[layer]}")
        for picture in draw(camera):
            if picture is None or view is None:
                yield picture
                continue
            at = resized(camera, picture.color.shape[:2])
            photo, inside = photograph_through(self.pixels(view), view.camera, at)
            if layer == "difference":
                ends = difference_limit(picture.color, photo, inside)
                self._on_change(f"**{view.name}**: {EXPLAIN[layer]} Colors end at {ends:.3g}.")
            yield replace(picture, color=combined(layer, picture.color, photo, inside))


def nothing(camera: Camera) -> Iterator[Picture | None]:
    """The drawing of a capture without a model: white.

    Args:
        camera: of the page.
    """
    size = camera.height, camera.width
    yield Picture(np.ones((*size, 3)), np.zeros(size), np.full(size, np.nan))

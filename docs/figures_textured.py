"""docs/images/textured_gradients.png: what one view asks of the vertices of a mesh with a texture.

    python docs/figures_textured.py

A painted ball is a tenth too small, and turned by a few degrees. Through silhouettes its outline is
asked to grow, and inside of its faces the pattern is asked to turn: the two parts of the gradient
of one loss, apart, with respect to vertices on the screen.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.fields import TexturedSurface
from photograd.fields.layered_picture import Unwrapped
from photograd.fitting.data import TrainingView
from photograd.fitting.drawing import render_field
from photograd.fitting.surface_gradients import (
    SurfaceGradients,
    draw_surface_gradients,
    surface_gradients,
)
from photograd.geometry.octahedron import unwrapped_sphere
from photograd.raster import interpolate, rasterize
from photograd_course.viz import save_figure

Array = NDArray[Any]
PICTURE = Path(__file__).resolve().parent / "images" / "textured_gradients.png"
SIZE, TEXELS, DIVISIONS = 160, 192, 7
TURN = np.radians(4.0)
SMALLER = 0.9
BOX = np.array([[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]])
TITLE = "What the loss asks of a ball that is too small, its pattern turned by 4 degrees"


def ball(radius: float, turn: float, *, painted: bool = True) -> TexturedSurface:
    """A ball with a pattern, turned about its upright axis; or a gray one.

    Args:
        radius: meters.
        turn: radians.
        painted: whether there is a pattern.
    """
    sphere, uv, corners, vertex = unwrapped_sphere(DIVISIONS)
    flat = np.concatenate([TEXELS * uv, np.ones((len(uv), 1))], axis=1)
    places = interpolate(sphere[vertex], corners, rasterize(flat, corners, (TEXELS, TEXELS)))
    places /= np.linalg.norm(places, axis=2, keepdims=True)
    longitude = np.arctan2(places[..., 2], places[..., 0]) - turn
    wave = np.sin(8 * longitude) * np.sqrt(np.maximum(1 - places[..., 1] ** 2, 0))
    texels = np.stack([1.5 * wave, 0.8 * wave + 0.5, -1.5 * wave], axis=-1)
    if not painted:
        texels = np.zeros_like(texels)
    unwrapped = Unwrapped(uv, corners, vertex)
    return TexturedSurface.of_mesh(radius * sphere, unwrapped, texels, smoothness=0.0)


def camera() -> Camera:
    """In front, at the height of the ball's middle."""
    return next(iter(orbit_cameras(BOX, 8, size=SIZE, elevation=0.0)))


def gradients(*, painted: bool = True, turn: float = TURN) -> SurfaceGradients:
    """Of the loss of one view of the larger, straight ball.

    Args:
        painted: whether the balls have their pattern.
        turn: of the smaller ball's pattern, radians.
    """
    color, opacity, _ = render_field(ball(0.5, 0.0, painted=painted), camera(), 0.0)
    rgba = np.concatenate([color, opacity[..., None]], axis=-1).astype(np.float32)
    view = TrainingView(camera(), rgba, None)
    return surface_gradients(ball(SMALLER * 0.5, turn, painted=painted), view, ssim_weight=0.0)


def ways(found: SurfaceGradients, part: str) -> tuple[Array, Array]:
    """What is asked of the visible vertices, outward and to the right, (N,) each.

    Args:
        found: of a view.
        part: "silhouettes" or "interior".
    """
    way = -getattr(found, part)[found.visible]
    middle = found.pixels[found.visible].mean(axis=0)
    away = found.pixels[found.visible] - middle
    outward = (way * away).sum(axis=1) / np.maximum(np.linalg.norm(away, axis=1), 1e-12)
    return outward, way[:, 0]


def main() -> None:
    """Draw the picture."""
    save_figure(draw_surface_gradients({0: gradients()}, title=TITLE), PICTURE)


if __name__ == "__main__":
    main()

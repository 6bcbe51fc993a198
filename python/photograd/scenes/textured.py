"""Five solids that touch one another, each with a strong texture: what is lost without detail."""

from __future__ import annotations

import numpy as np

from photograd.scenes.daylight import blue_sky, warm_sun
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.noise import fractal_noise
from photograd.scenes.paints import Color, paint, paints, within_range
from photograd.scenes.parts import Part, as_meshes
from photograd.scenes.shapes import ico_sphere, rounded_box, sphere, superellipsoid, torus
from photograd.scenes.surface import Surface, rotation_about
from photograd.scenes.textures import checker, marble, painted_tiles, stripes


def textured(seed: int) -> SceneDescription:
    """A still life within 0.7 m of the origin; `seed` draws marble, tiles and the stone."""
    tiles = paints("white", "blue", "yellow", "coral", "turquoise")
    ring = torus(0.4, 0.13, rows=64, columns=160).moved((0.0, -0.32, 0.0))
    ball = sphere(0.3, rows=64, columns=128).moved(
        (0.0, -0.16, 0.0), rotation=rotation_about("z", 20.0)
    )
    cube = rounded_box((0.17, 0.17, 0.17), 0.03).moved(
        (0.04, 0.31, 0.0), rotation=rotation_about("y", 30.0) @ rotation_about("x", 8.0)
    )
    pillow = superellipsoid((0.15, 0.13, 0.15), north=0.5, east=0.6).moved(
        (-0.36, -0.09, 0.27), rotation=rotation_about("x", 25.0)
    )
    parts: list[Part] = [
        (ring, painted_tiles((384, 1536), (4, 16), tiles, paint("cream"), seed=seed)),
        (ball, marble((384, 768), paints("cream", "teal", "navy", "white"), seed=seed)),
        (cube, _dice_faces()),
        (pillow, stripes((256, 512), 16, paints("magenta", "cream", "violet", "amber"), lean=8)),
        stone(seed=seed),
    ]
    meshes = as_meshes(parts)
    return SceneDescription("textured", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def stone(*, seed: int) -> Part:
    """A ball pushed in and out by noise, with colours by another noise of the same points."""
    ball = ico_sphere(1.0, subdivisions=6)
    bumps = fractal_noise(1.6 * ball.vertices, seed=seed, octaves=4)
    points = 0.16 * (1.0 + 0.45 * bumps[:, None]) * ball.vertices
    shape = Surface(points, ball.faces, ball.uv).moved((0.37, -0.1, 0.24))
    veins = fractal_noise(3.0 * ball.vertices, seed=seed + 1, octaves=5, ridged=True)
    return shape, _by_height(veins, paints("navy", "blue", "teal", "lime", "yellow"), -0.3, 0.8)


def _by_height(value: np.ndarray, colors: Color, low: float, high: float) -> Color:
    """Colours (N, 3) of numbers (N,), blended evenly from `low` to `high`."""
    steps = np.linspace(low, high, len(colors))
    return within_range(np.stack([np.interp(value, steps, channel) for channel in colors.T], -1))


def _dice_faces() -> Color:
    """Checkers with a frame."""
    face = checker((128, 128), (8, 8), paints("red", "white"))
    edge = np.minimum(np.arange(128), np.arange(128)[::-1])
    frame = np.minimum(edge[:, None], edge[None, :]) < 16
    face[frame] = paint("amber")
    return face

"""Vessels with soft outlines, solids with strong textures, and a doll's house of flat walls."""

from __future__ import annotations

import numpy as np
from photograd_course import random

from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.noise import fractal_noise
from photograd.scenes.parts import (
    Color,
    Part,
    as_meshes,
    blue_sky,
    paint,
    paints,
    warm_sun,
    within_range,
)
from photograd.scenes.shapes import ico_sphere, rounded_box, sphere, superellipsoid, torus
from photograd.scenes.surface import Surface, lathe, rotation_about, rounded_profile
from photograd.scenes.textures import checker, marble, painted_tiles, stripes, wood


def smooth_curves(seed: int) -> SceneDescription:
    """A vase, a bowl, a pebble and a ring within 0.7 m of the origin; `seed` turns the colors."""
    shift = float(random.uniform(seed))
    vase = lathe(
        rounded_profile(
            [
                (0.0, 0.02),
                (0.09, 0.1),
                (0.06, 0.62),
                (0.1, 0.66),
                (0.12, 0.62),
                (0.09, 0.48),
                (0.2, 0.22),
                (0.17, 0.02),
                (0.1, -0.03),
                (0.0, -0.03),
            ],
            count=160,
        ),
        columns=128,
    )
    bowl = lathe(
        rounded_profile(
            [
                (0.0, 0.03),
                (0.12, 0.06),
                (0.24, 0.17),
                (0.26, 0.18),
                (0.26, 0.16),
                (0.15, 0.02),
                (0.08, -0.02),
                (0.0, -0.02),
            ],
            count=128,
        ),
        columns=128,
    )
    pebble = superellipsoid((0.19, 0.13, 0.15), north=1.0, east=0.9)
    ring = torus(0.15, 0.055, rows=48, columns=128).moved(rotation=rotation_about("x", 75.0))
    plate = lathe(
        rounded_profile(
            [(0.0, 0.0), (0.5, 0.0), (0.6, 0.03), (0.61, 0.02), (0.5, -0.04), (0.0, -0.05)],
            count=128,
        ),
        columns=160,
    )
    parts: list[Part] = [
        _graded(vase.moved((-0.2, -0.33, -0.16)), ("navy", "turquoise", "cream"), shift),
        _graded(bowl.moved((0.26, -0.33, -0.14)), ("magenta", "coral", "amber"), shift),
        _graded(pebble.moved((0.05, -0.23, 0.33)), ("pine", "lime", "yellow"), shift),
        _graded(ring.moved((-0.4, -0.17, 0.25)), ("violet", "pink", "sky"), shift),
        (plate.moved((0.0, -0.37, 0.0)), paint("lagoon")),
    ]
    meshes = as_meshes(parts)
    return SceneDescription("smooth_curves", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def _graded(surface: Surface, names: tuple[str, ...], shift: float) -> Part:
    """Colors that go once through the named paints and back, along a slanting direction."""
    points = surface.vertices
    low, high = points.min(axis=0), points.max(axis=0)
    way = ((points - low) / (high - low)) @ np.array([0.3, 0.6, 0.3])
    phase = np.abs((way + shift) % 2.0 - 1.0)
    stops = np.linspace(0.0, 1.0, len(names))
    colors: Color = paints(*names)
    blended = np.stack([np.interp(phase, stops, channel) for channel in colors.T], axis=-1)
    return surface, within_range(blended)


# Five solids that touch one another, each with a strong texture: what is lost without detail.


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
    """A ball pushed in and out by noise, with colors by another noise of the same points."""
    ball = ico_sphere(1.0, subdivisions=6)
    bumps = fractal_noise(1.6 * ball.vertices, seed=seed, octaves=4)
    points = 0.16 * (1.0 + 0.45 * bumps[:, None]) * ball.vertices
    shape = Surface(points, ball.faces, ball.uv).moved((0.37, -0.1, 0.24))
    veins = fractal_noise(3.0 * ball.vertices, seed=seed + 1, octaves=5, ridged=True)
    return shape, _by_height(veins, paints("navy", "blue", "teal", "lime", "yellow"), -0.3, 0.8)


def _by_height(value: np.ndarray, colors: Color, low: float, high: float) -> Color:
    """Colors (N, 3) of numbers (N,), blended evenly from `low` to `high`."""
    steps = np.linspace(low, high, len(colors))
    return within_range(np.stack([np.interp(value, steps, channel) for channel in colors.T], -1))


def _dice_faces() -> Color:
    """Checkers with a frame."""
    face = checker((128, 128), (8, 8), paints("red", "white"))
    edge = np.minimum(np.arange(128), np.arange(128)[::-1])
    frame = np.minimum(edge[:, None], edge[None, :]) < 16
    face[frame] = paint("amber")
    return face


# A doll's house without roof or front: large flat walls, most of them of one color.


_EDGE = 0.004


def flat_walls(seed: int) -> SceneDescription:
    """Rooms within 0.7 m of the origin; `seed` draws wood, marble and tiles."""
    parts = [*walls(), *floors(seed=seed), *furniture(seed=seed)]
    meshes = as_meshes(parts)
    return SceneDescription("flat_walls", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def _slab(middle: tuple[float, float, float], half: tuple[float, float, float], name: str) -> Part:
    """A box of one color."""
    return rounded_box(half, _EDGE, rings=2).moved(middle), paint(name)


def walls() -> list[Part]:
    """A back, two sides and two walls inside, one with a door left open."""
    return [
        _slab((0.0, 0.0, -0.52), (0.54, 0.34, 0.02), "sky"),
        _slab((-0.52, 0.0, 0.0), (0.02, 0.34, 0.5), "coral"),
        _slab((0.52, 0.0, 0.0), (0.02, 0.34, 0.5), "amber"),
        _slab((0.08, 0.0, -0.35), (0.02, 0.34, 0.15), "teal"),
        _slab((0.08, 0.0, 0.3), (0.02, 0.34, 0.2), "teal"),
        _slab((0.08, 0.26, -0.05), (0.02, 0.08, 0.15), "teal"),
    ]


def floors(*, seed: int) -> list[Part]:
    """Planks on the left, tiles on the right."""
    left = rounded_box((0.31, 0.02, 0.52), _EDGE, rings=2).moved((-0.23, -0.36, 0.0))
    right = rounded_box((0.23, 0.02, 0.52), _EDGE, rings=2).moved((0.31, -0.36, 0.0))
    planks = wood((256, 256), paint("maple"), paint("walnut"), seed=seed, planks=6)
    tiles = painted_tiles(
        (240, 480), (4, 8), paints("red", "blue", "yellow", "green"), paint("cream"), seed=seed
    )
    return [(left, planks), (right, tiles)]


def furniture(*, seed: int) -> list[Part]:
    """A bed, a shelf, a table top and a picture on the wall."""
    bed = rounded_box((0.13, 0.07, 0.2), 0.02).moved((-0.33, -0.27, -0.27))
    shelf = rounded_box((0.05, 0.2, 0.16), _EDGE).moved((-0.44, -0.14, 0.25))
    block = rounded_box((0.1, 0.11, 0.1), _EDGE).moved((0.33, -0.23, 0.2))
    picture = rounded_box((0.13, 0.1, 0.012), _EDGE).moved((0.3, 0.1, -0.49))
    return [
        (bed, stripes((64, 64), 6, paints("violet", "pink"))),
        (shelf, checker((128, 128), (4, 2), paints("red", "green", "blue", "yellow"))),
        (block, marble((128, 128), paints("cream", "pine", "lime"), seed=seed)),
        (picture, checker((64, 64), (3, 4), paints("magenta", "navy", "orange", "lime"))),
    ]

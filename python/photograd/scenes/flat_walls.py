"""A doll's house without roof or front: large flat walls, most of them of one colour."""

from __future__ import annotations

from photograd.scenes.daylight import blue_sky, warm_sun
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.paints import paint, paints
from photograd.scenes.parts import Part, as_meshes
from photograd.scenes.shapes import rounded_box
from photograd.scenes.textures import checker, marble, painted_tiles, stripes, wood

_EDGE = 0.004


def flat_walls(seed: int) -> SceneDescription:
    """Rooms within 0.7 m of the origin; `seed` draws wood, marble and tiles."""
    parts = [*walls(), *floors(seed=seed), *furniture(seed=seed)]
    meshes = as_meshes(parts)
    return SceneDescription("flat_walls", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def _slab(middle: tuple[float, float, float], half: tuple[float, float, float], name: str) -> Part:
    """A box of one colour."""
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

"""Cameras for a capture: evenly spread around a box, most of them above it.

Their directions are a Fibonacci lattice [Gonzalez2010]: equal steps in height, which are equal
areas of the sphere, each turned by the golden angle against the one before.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from photograd_course import random
from photograd_course.checks import require_integer, require_number

from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.errors import RangeError, ShapeError, message
from photograd.scenes.description import Points

LOWEST, HIGHEST = -0.3, 0.92
"""Sines of the least and the greatest elevation, -17 and 67 degrees: nothing stands on a floor, so
that pictures from slightly below see something, and no camera looks straight down."""

FIELD_OF_VIEW = 40.0
"""Degrees, across the whole picture."""

FILL = 0.9
"""How much of the picture's width a ball around the scene takes up."""

_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))


def capture_cameras(
    bounds: Points,
    views: int,
    test_views: int = 0,
    *,
    size: int,
    seed: int,
    radius: float | None = None,
) -> dict[str, list[Camera]]:
    """Square cameras around the middle of a box, all equally far from it, in one or two splits.

    Together they look along one lattice of views + test_views directions. The test cameras are
    those next to a lattice of test_views directions, so they too are all around; and as every
    direction occurs once, none repeats what a training camera sees. `seed` turns all about +Y.

    Args:
        bounds: (2, 3) box, low < high.
        views: number of training cameras, at least 1.
        test_views: number of test cameras, at least 0.
        size: width and height in pixels; square pixels, principal point in the middle.
        seed: of the turn.
        radius: of a ball around the box's middle that is to be seen whole, in metres; None takes
            the ball through the box's corners.

    Returns:
        "train", and "test" if there are test views.

    Raises:
        ShapeError, RangeError, DtypeError: a bad box, number of views, size, seed or radius.
    """
    name = "capture_cameras"
    box = np.asarray(bounds, dtype=np.float64)
    if box.shape != (2, 3):
        raise ShapeError(message(name, "bounds", "shape (2, 3)", box.shape))
    if not bool(np.isfinite(box).all() and (box[0] < box[1]).all()):
        expected = "a finite box, low < high on every axis"
        raise RangeError(message(name, "bounds", expected, box.tolist()))
    require_integer(name, "views", views, least=1, most=1 << 16)
    require_integer(name, "test_views", test_views, least=0, most=1 << 16)
    require_integer(name, "size", size, least=1, most=1 << 16)
    if radius is None:
        radius = 0.5 * float(np.linalg.norm(box[1] - box[0]))
    require_number(name, "radius", radius, least=0.0, open_ends=True)
    rays = _lattice(views + test_views, seed)
    is_test = np.zeros(len(rays), dtype=np.bool_)
    is_test[_nearest(rays, _lattice(test_views, seed))] = True
    splits = {"train": rays[~is_test], "test": rays[is_test]}
    return {
        split: [_camera(box.mean(axis=0), ray, radius, size) for ray in chosen]
        for split, chosen in splits.items()
        if len(chosen)
    }


def _camera(centre: Points, ray: Points, radius: float, size: int) -> Camera:
    """The camera that sees a ball around `centre` over FILL of its width, from along `ray`."""
    half = np.radians(0.5 * FIELD_OF_VIEW)
    # A ball's outline at the angle a from the axis is tan(a) / tan(half) of half the width away.
    distance = radius / np.sin(np.arctan(FILL * np.tan(half)))
    focal, middle = 0.5 * size / np.tan(half), 0.5 * size
    pose = look_at(centre + distance * ray, centre)
    return Camera(size, size, focal, focal, middle, middle, pose)


def _lattice(count: int, seed: int) -> Points:
    """Unit vectors (count, 3) between the lowest and the highest elevation."""
    height = HIGHEST - (HIGHEST - LOWEST) * (np.arange(count) + 0.5) / max(count, 1)
    turn = 2.0 * np.pi * float(random.uniform(seed))
    angle = turn + _GOLDEN_ANGLE * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    return np.stack([across * np.sin(angle), height, across * np.cos(angle)], axis=-1)


def _nearest(rays: Points, wanted: Points) -> npt.NDArray[np.int64]:
    """For each of `wanted` in turn, the index of the nearest ray that is not taken yet."""
    taken: list[int] = []
    for direction in wanted:
        likeness = rays @ direction
        likeness[taken] = -np.inf
        taken.append(int(np.argmax(likeness)))
    return np.array(taken, dtype=np.int64)

"""Task 08.3, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for

from .common import EXACT, random_box

check = checks_for(calls=("ray_box",), tolerance=EXACT)

# The same for what must be 0, in units of the box.
BOXES = Tolerance(EXACT.relative, EXACT.evidence, floor=1.0)


def spans(rays):
    """Result of `ray_box`."""
    return Items(Array((rays,)), Array((rays,)), names=("t_near", "t_far"))


def on_face(points, low, high):
    """How far points are from the surface of the box, as a share of its size."""
    size = high - low
    outside = np.maximum(np.maximum(low - points, points - high) / size, 0.0).max(axis=1)
    nearest = np.minimum(np.abs(points - low), np.abs(points - high)) / size
    return np.maximum(outside, nearest.min(axis=1))


@check(
    "08.3.axes",
    points=2,
    hint="handout, equations (13) and (14): smaller and larger of two crossings, on each axis",
    sole="three rays that can be checked with a ruler",
)
def along_the_axes(t):
    """Rays along the axes, forward and backward, enter and leave where a ruler says."""
    low, high = random_box(t)
    middle, gap = (low + high) / 2, t.rng.uniform(0.5, 2.0, 3)
    for sign in (1.0, -1.0):
        start = (low - gap) if sign > 0 else (high + gap)
        origins = np.where(np.eye(3) > 0, start, middle)
        near, far = t.call("ray_box", low, high, origins, sign * np.eye(3), returns=spans(3))
        t.close("t_near", near, gap, reveal=True)
        t.close("t_far", far, gap + high - low, reveal=True)


@check(
    "08.3.faces",
    points=2,
    hint="enter at the last of three entries, leave at the first of three exits",
    sole="any direction, without knowing the answer",
)
def ends_lie_on_the_surface(t):
    """Rays toward a point inside enter and leave on the surface, whatever their length."""
    low, high = random_box(t)
    inside = t.rng.uniform(low, high, (40, 3))
    direction = t.rng.normal(size=(40, 3))
    origins = inside - 9.0 * direction / np.linalg.norm(direction, axis=1)[:, None]
    length = t.rng.uniform(0.2, 3.0, (40, 1))
    aim = (inside - origins) * length
    near, far = t.call("ray_box", low, high, origins, aim, returns=spans(40))
    t.require(bool((near < far).all()), "rays through the box must have t_near < t_far")
    for name, at in (("t_near", near), ("t_far", far)):
        t.close(
            f"distance from the surface at {name}, in sizes of the box",
            on_face(origins + at[:, None] * aim, low, high),
            np.zeros(40),
            BOXES,
            reveal=True,
        )
    t.require(
        bool((near * length[:, 0] < 1).all() and (far * length[:, 0] > 0).all()),
        "the point aimed at must lie between t_near and t_far",
    )


@check(
    "08.3.inside",
    points=2,
    hint="a ray begins at t = 0: what lies before that is behind the camera",
    sole="tests what lies behind the camera",
)
def starts_inside_or_behind(t):
    """From inside, a ray starts at 0; with the box behind it or beside it, it gets (0, 0)."""
    low, high = random_box(t)
    inside = t.rng.uniform(low, high, (12, 3))
    direction = t.rng.normal(size=(12, 3))
    near, far = t.call("ray_box", low, high, inside, direction, returns=spans(12))
    t.require(not near.any(), "from inside, t_near must be 0")
    t.close(
        "distance from the surface at t_far, in sizes of the box",
        on_face(inside + far[:, None] * direction, low, high),
        np.zeros(12),
        BOXES,
        reveal=True,
    )
    away = inside + 9.0 * direction / np.linalg.norm(direction, axis=1)[:, None]
    beside = direction - (direction @ np.ones(3) / 3)[:, None]  # never nears the far corner
    origins = np.concatenate([away, np.tile(high + 0.1, (12, 1))])
    near, far = t.call(
        "ray_box", low, high, origins, np.concatenate([direction, beside]), returns=spans(24)
    )
    t.require(not near.any() and not far.any(), "a ray that misses the box must get (0, 0)")


@check(
    "08.3.parallel",
    points=2,
    hint="a component of 0 never crosses its two planes: either it is between them (faces "
    "belong to the box) or it misses",
    sole="the case in which 0 is divided by 0",
)
def parallel_to_faces(t):
    """Directions with components of 0: between the faces, outside them, and within a face."""
    low, high = random_box(t)
    middle, size = (low + high) / 2, high - low
    x = np.array([1.0, 0.0, -0.0])
    start = middle - np.array([1.0, 0.0, 0.0]) * size
    origins = np.tile(start, (5, 1))
    origins[1, 1] = high[1] + 0.1  # outside the slab
    origins[2, 2] = low[2] - 0.1
    origins[3, 1] = low[1]  # within a face
    origins[4, 2] = high[2]
    near, far = t.call("ray_box", low, high, origins, np.tile(x, (5, 1)), returns=spans(5))
    hits = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
    t.close("t_near", near, hits * 0.5 * size[0], reveal=True)
    t.close("t_far", far, hits * 1.5 * size[0], reveal=True)

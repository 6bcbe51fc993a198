"""Task 05.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.failures import CheckFailed
from photograd_course.grading.generators import unit_vectors

from .common import CLOSE, distances, same_hits, sphere

check = checks_for(calls=("march_sdf",))

MARCHED = Tolerance(1e-7, "a sphere tracing stops 1e-9 short at most, wrong ones by 1e-2 or more")
SLOPES = Tolerance(1e-4, "finite differences leave 1e-6, wrong ones are off by 1e-1 or more")
COUNTED = Tolerance(1e-12, "whole numbers")


class Surface:
    """A service that tells distances, and counts for how many points."""

    def __init__(self, shape, most=100_000):
        self.shape, self.most, self.asked = shape, most, 0

    def __call__(self, places):
        if not (isinstance(places, np.ndarray) and places.ndim == 2 and places.shape[1] == 3):
            raise CheckFailed("march_sdf: sdf wants places, an array of shape (M, 3)")
        if len(places) == 0:
            raise CheckFailed("march_sdf: sdf is tested no point at all: no ray is on its way")
        if not np.isfinite(places).all():
            raise CheckFailed("march_sdf: sdf is tested a point that is not finite")
        self.asked += len(places)
        if self.asked > self.most:
            raise CheckFailed("march_sdf: asks without end")
        return self.shape(places)


def ball(center, radius, by=None):
    """Distance to a sphere; p is the radius, or moves the center along `by`."""

    def shape(x):
        away = np.linalg.norm(x - center, axis=1)
        gradient = (x - center) / away[:, None]
        return away - radius, gradient, -np.ones(len(x)) if by is None else -gradient @ by

    return shape


def wall(normal, height):
    """Distance to a plane, below 0 behind it; p is its height along the normal."""

    def shape(x):
        return x @ normal - height, np.tile(normal, (len(x), 1)), -np.ones(len(x))

    return shape


def both(first, second, p_first=True):
    """Two shapes as one; p belongs to one of them."""

    def shape(x):
        one, two = first(x), second(x)
        nearer = one[0] < two[0]
        return (
            np.where(nearer, one[0], two[0]),
            np.where(nearer[:, None], one[1], two[1]),
            np.where(nearer == p_first, one[2] if p_first else two[2], 0.0),
        )

    return shape


def marched(t, shape, origins, directions, t_max=50.0, steps=400):
    """(t, d_t, points tested)."""
    service = Surface(shape)
    parts = Items(distances(len(origins)), Array((len(origins),)), names=("t", "d_t"))
    got, d_t = t.call("march_sdf", service, origins, directions, t_max, steps, returns=parts)
    return got, d_t, service.asked


def onto_ball(t, count, center, radius):
    """(origins, unit directions, right) of rays that hit a ball from outside, not grazing."""
    n, d = unit_vectors(t.rng, count), unit_vectors(t.rng, count)
    d = np.where(np.sum(n * d, axis=1, keepdims=True) > 0, -d, d) - 0.4 * n
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    right = t.rng.uniform(0.3, 5, count)
    return center + radius * n - right[:, None] * d, d, right


def past_ball(t, count, center, radius):
    """(origins, unit directions) of rays that pass a ball at 1.05 to 2 radii."""
    d = unit_vectors(t.rng, count)
    s = np.cross(d, unit_vectors(t.rng, count))
    s *= t.rng.uniform(1.05, 2, (count, 1)) * radius / np.linalg.norm(s, axis=1, keepdims=True)
    return center + s - t.rng.uniform(1, 4, (count, 1)) * d, d


@check(
    "05.4.met",
    points=4,
    tolerance=MARCHED,
    hint="handout, equation (13): go ahead by |f|, from inside too; nothing can be nearer",
    sole="that the surface is found, and only it",
)
def surfaces_are_met(t):
    """Rays hit a ball, from outside and inside, and what stands behind it; others pass."""
    for _ in range(2):
        center, radius = sphere(t)
        origins, directions, right = onto_ball(t, 15, center, radius)
        away = past_ball(t, 10, center, radius)
        inside = center + 0.5 * radius * unit_vectors(t.rng, 5)
        ahead = unit_vectors(t.rng, 5)
        b = np.sum((inside - center) * ahead, axis=1)
        through = -b + np.sqrt(b**2 + 0.75 * radius**2)
        everything = np.concatenate([origins, away[0], inside])
        ways = np.concatenate([directions, away[1], ahead])
        right = np.concatenate([right, np.full(10, np.inf), through])
        got, d_t, _ = marched(t, ball(center, radius), everything, ways)
        same_hits(t, got, right)
        t.require(not d_t[np.isinf(got)].any(), "d_t is zero where nothing is hit")
    normal = unit_vectors(t.rng, 1)[0]
    origins, directions = past_ball(t, 10, np.zeros(3), 1.0)
    height = float((origins @ normal).min()) - 2.5
    scene = both(ball(np.zeros(3), 1.0), wall(normal, height))
    falls = directions @ normal
    right = np.where(falls < -0.2, (height - origins @ normal) / falls, np.inf)
    kept = np.abs(falls) > 0.2
    got, _, _ = marched(t, scene, origins[kept], directions[kept])
    same_hits(t, got, right[kept])


def differences(t, make, origins, directions, eps=1e-2):
    """The derivative of the submission's own t by p, by four differences."""
    at = {k: marched(t, make(k * eps), origins, directions)[0] for k in (-2, -1, 1, 2)}
    kept = np.isfinite(np.stack(list(at.values()))).all(axis=0)
    safe = {k: np.where(kept, value, 0.0) for k, value in at.items()}
    return (8 * (safe[1] - safe[-1]) - (safe[2] - safe[-2])) / (12 * eps), kept


@check(
    "05.4.derivative",
    points=5,
    tolerance=SLOPES,
    hint="handout, equation (15): the point is held on the surface while p changes",
    sole="the gate: differences of the submission's own sphere tracing",
)
def the_derivative_of_a_hit(t):
    """d_t is what differences of t by p say: a radius, a point, a height."""
    center, radius = sphere(t)
    by, normal = unit_vectors(t.rng, 1)[0], unit_vectors(t.rng, 1)[0]
    origins, directions, _ = onto_ball(t, 12, center, radius)
    onto = np.sum(directions * normal, axis=1)
    slanted = np.where((onto > 0)[:, None], -directions, directions)[np.abs(onto) > 0.25]
    above = t.rng.uniform(-1, 1, slanted.shape) + 4 * normal
    cases = (
        (lambda p: ball(center, radius + p), origins, directions),
        (lambda p: ball(center + p * by, radius, by), origins, directions),
        (lambda p: wall(normal, p), above, slanted),
    )
    for make, o, d in cases:
        got, d_t, _ = marched(t, make(0.0), o, d)
        right, kept = differences(t, make, o, d)
        kept &= np.isfinite(got)
        t.require(
            int(kept.sum()) * 2 > len(o) > 0,
            "half of the rays or more miss",
            hint="05.4.met looks at what is hit",
        )
        t.require(float(np.abs(right[kept]).max()) > 0.1, "t does not depend on p")
        t.close("d_t", d_t[kept], right[kept])


@check(
    "05.4.cost",
    points=3,
    hint="ask only for rays that are neither there nor beyond t_max, at most `steps` times",
    sole="evaluations are counted, not seconds",
)
def few_questions(t):
    """A ray straight onto a wall needs two questions, no ray has more than `steps`."""
    up = np.array([0.0, 0, 1])
    origins = np.array([[0, 0, 1.0], [1, 0, 2], [5, 2, 4], [0, 0, 8], [3, 3, 1]])
    down = np.tile(-up, (5, 1))
    got, _, asked = marched(t, wall(up, 0.0), origins, down)
    same_hits(t, got, origins[:, 2], COUNTED)
    t.require(asked == 10, f"five rays straight onto a wall: {asked} points, 10 are enough")
    got, _, asked = marched(t, wall(up, 0.0), origins, down, t_max=4.0)
    same_hits(t, got, np.array([1, 2, 4, np.inf, 1]), COUNTED, hint="t_max itself still counts")
    t.require(asked == 9, f"with t_max 4: {asked} points, 9 are enough")
    got, _, asked = marched(t, wall(up, 0.0), origins, down, steps=1)
    t.require(bool(np.isinf(got).all()), "one step is not enough to arrive at a wall")
    t.require(asked == 5, f"with steps 1 five rays ask for {asked} points, 5 are right")
    got, _, asked = marched(t, wall(up, 0.0), CLOSE * up[None], down[:1])
    same_hits(t, got, np.array([CLOSE]), COUNTED, hint="there is *below* CLOSE")
    # Past slanted walls the distance shrinks by the same factor each time.
    cosine = np.array([0.5, 0.75, 0.9])
    slanted = np.stack([np.sqrt(1 - cosine**2), np.zeros(3), -cosine], axis=1)
    got, _, asked = marched(t, wall(up, 0.0), np.tile(up, (3, 1)), slanted)
    needed = int((np.ceil(np.log(CLOSE) / np.log(1 - cosine)) + 1).sum())
    t.require(bool(np.isfinite(got).all()), "rays onto a wall miss it")
    t.require(abs(asked - needed) <= 3, f"three slanted rays: {asked} points, {needed} are needed")
    _, _, asked = marched(t, wall(up, 0.0), np.tile(up, (2, 1)), np.tile(up, (2, 1)), t_max=40.0)
    t.require(asked <= 14, f"two rays away from a wall, to t_max 40: {asked} points, 12 are enough")

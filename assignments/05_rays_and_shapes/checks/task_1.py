"""Task 05.1, public checks."""

import numpy as np
from photograd_course.grading import Tolerance, checks_for
from photograd_course.grading.generators import unit_vectors

from .common import EXACT, T_MIN, distances, lengths, same_hits, sphere

check = checks_for(calls=("hit_sphere",), tolerance=EXACT)

FAR = Tolerance(1e-5, "right ones are off by 1e-8, the quadratic formula by 1e-3")


def hit(t, origins, directions, center, radius):
    return t.call(
        "hit_sphere", origins, directions, center, radius, returns=distances(len(origins))
    )


def rays_onto(t, count, center, radius):
    """(origins, directions, right, outward normals) of rays that hit a sphere from outside."""
    n, d = unit_vectors(t.rng, count), unit_vectors(t.rng, count)
    d = np.where(np.sum(n * d, axis=1, keepdims=True) > 0, -d, d) - 0.1 * n
    d *= lengths(t, count)
    right = t.rng.uniform(0.2, 6, count)
    return center + radius * n - right[:, None] * d, d, right, n


def rays_within(t, count, center, radius):
    """(origins, directions, right) of rays that start inside a sphere, or on it and go inside."""
    _, d, _, n = rays_onto(t, count, center, radius)
    chord = -2 * radius * np.sum(n * d, axis=1) / np.sum(d * d, axis=1)
    share = np.where(np.arange(count) % 3 == 0, 0.0, t.rng.uniform(0.05, 0.95, count))
    origins = center + radius * n + (share * chord)[:, None] * d
    return origins, d, (1 - share) * chord


@check(
    "05.1.outside",
    points=3,
    hint="handout, equation (5): from where the ray is nearest, h back",
    sole="where most rays come from",
)
def spheres_from_outside(t):
    """Rays aimed at a point of a sphere from outside hit it there, whatever their length."""
    for _ in range(3):
        center, radius = sphere(t)
        origins, directions, right, _ = rays_onto(t, 20, center, radius)
        same_hits(t, hit(t, origins, directions, center, radius), right)


@check(
    "05.1.inside",
    points=2,
    hint="handout, equation (6): where the first of the two does not count, take the second",
    sole="what refraction and shadows need",
)
def spheres_from_inside(t):
    """Rays that start inside hit the far side; rays that start on the sphere, not their start."""
    for _ in range(3):
        center, radius = sphere(t)
        origins, directions, right = rays_within(t, 20, center, radius)
        same_hits(t, hit(t, origins, directions, center, radius), right)


@check(
    "05.1.misses",
    points=2,
    hint="nothing behind the origin is hit, nor where h² < 0; a ray that touches hits",
    sole="what is not there must not be seen",
)
def spheres_missed(t):
    """Rays past a sphere and away from it hit nothing; one that touches it does."""
    cases = (
        ((-3, 1, 0), (1, 0, 0), 3.0),  # touches
        ((-3, 0, -1), (0.5, 0, 0), 6.0),
        ((-3, 1.0001, 0), (1, 0, 0), np.inf),
        ((-3, 1, 1), (1, 0, 0), np.inf),
        ((3, 0, 0), (1, 0, 0), np.inf),  # behind
        ((0, 0, 2), (0, 0, 4), np.inf),
        ((0, 0, 0), (0, 2, 0), 0.5),
        ((1, 0, 0), (1, 0, 0), np.inf),  # on it, away
        ((-1, 0, 0), (1, 0, 0), 2.0),
        ((0, 3, 0), (0, -0.25, 0), 8.0),
        ((0.5, 0, 0), (1, 0, 0), 0.5),
    )
    shift = np.round(t.rng.uniform(-4, 4, 3) * 8) / 8
    origins, directions = (np.array([case[k] for case in cases], float) for k in (0, 1))
    right = np.array([case[2] for case in cases])
    same_hits(t, hit(t, origins + shift, directions, shift, 1.0), right)
    # Spheres as small as T_MIN: what lies at T_MIN itself does not count.
    for center, right in ((2 * T_MIN, 3 * T_MIN), (0.0, np.inf)):
        got = hit(t, np.zeros((1, 3)), np.array([[1.0, 0, 0]]), np.array([center, 0, 0]), T_MIN)
        same_hits(t, got, np.array([right]), hint="T_MIN itself does not count, what is above does")


@check(
    "05.1.far",
    points=1,
    tolerance=FAR,
    hint="handout, end of section 1: subtract points before you square them",
)
def a_sphere_far_away(t):
    """A sphere of radius 1 is hit on its surface from ten million meters away as well."""
    n = unit_vectors(t.rng, 30)
    d = unit_vectors(t.rng, 30)
    d = np.where(np.sum(n * d, axis=1, keepdims=True) > 0, -d, d) - 0.2 * n
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    origins = n - 1e7 * d
    got = hit(t, origins, d, np.zeros(3), 1.0)
    t.require(bool(np.isfinite(got).all()), "rays aimed at the sphere from far away miss it")
    away = np.linalg.norm(origins + got[:, None] * d, axis=1)
    t.close("distance from the center", away, np.ones(30))

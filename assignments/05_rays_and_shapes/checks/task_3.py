"""Task 05.3, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.generators import unit_vectors

from .common import EXACT

check = checks_for(calls=("refract",), tolerance=EXACT)


def refracted(t, directions, normals, eta):
    count = len(directions)
    return t.call(
        "refract",
        directions,
        normals,
        eta,
        returns=Items(Array((count, 3)), Array((count,), "bool"), names=("out", "through")),
    )


def arrivals(t, count, most=1.5, inside=False):
    """(directions, normals) that make angles up to `most` with the normal."""
    n = unit_vectors(t.rng, count)
    s = np.cross(n, unit_vectors(t.rng, count))
    s /= np.linalg.norm(s, axis=1, keepdims=True)
    angle = t.rng.uniform(0.05, most, (count, 1))
    return np.sin(angle) * s + (1 if inside else -1) * np.cos(angle) * n, n


@check(
    "05.3.snell",
    points=4,
    hint="handout, equations (10) and (11): the part along the surface is divided by the ratio",
    sole="the law itself, from both sides",
)
def snells_law(t):
    """The part along the surface changes by the ratio, the length stays 1, the side changes."""
    for eta, inside, most in (
        (1.5, False, 1.5),
        (1.5, True, 0.7),
        (0.75, False, 0.8),
        (0.75, True, 1.5),
        (1.0, False, 1.5),
    ):
        d, n = arrivals(t, 15, most, inside)
        out, through = refracted(t, d, n, eta)
        t.require(
            bool(through.all()),
            "light is held back that should get through",
            hint="through is True where equation (11) has a root",
        )
        t.close("length", np.linalg.norm(out, axis=1), np.ones(15))
        t.require(
            bool((np.sum(out * n, axis=1) * np.sum(d * n, axis=1) > 0).all()),
            "refracted light goes on to the other side of the surface",
        )
        before, after = np.cross(n, d), np.cross(n, out)
        ends = (before, after * eta) if not inside else (before * eta, after)
        t.close("part along the surface", ends[1], ends[0])


@check(
    "05.3.back",
    points=2,
    hint="paths of light are reversible: from inside the ratio is 1 / eta",
    sole="light goes back the way it came",
)
def refraction_is_reversible(t):
    """The reversed refracted ray is refracted into the reversed incident ray."""
    for eta in (1.33, 2.4):
        d, n = arrivals(t, 15)
        out, _ = refracted(t, d, n, eta)
        again, through = refracted(t, -out, n, eta)
        t.require(bool(through.all()), "the reversed ray must be refracted, too")
        t.close("refracted direction of the reversed ray", again, -d)


@check(
    "05.3.total",
    points=3,
    hint="handout, equation (12): where (11) has no root everything is reflected",
    sole="the critical angle",
)
def total_reflection(t):
    """Beyond the critical angle, and only there, light from inside is reflected."""
    eta = 1.5
    critical = np.arcsin(1 / eta)
    n = unit_vectors(t.rng, 12)
    s = np.cross(n, unit_vectors(t.rng, 12))
    s /= np.linalg.norm(s, axis=1, keepdims=True)
    more = np.array([-0.3, -1e-2, -1e-5, 1e-5, 1e-2, 0.3] * 2)
    angle = (critical + more)[:, None]
    d = np.sin(angle) * s + np.cos(angle) * n
    out, through = refracted(t, d, n, eta)
    t.require(bool((through == (more < 0)).all()), "through is wrong near the critical angle")
    back = more > 0
    t.close("reflected, along the surface", np.cross(n, out)[back], np.cross(n, d)[back])
    t.close(
        "reflected, along the normal", np.sum(out * n, axis=1)[back], -np.sum(d * n, axis=1)[back]
    )
    _, through = refracted(t, *arrivals(t, 8, 1.5), eta)
    t.require(bool(through.all()), "from outside into glass some light always is refracted")
    flat = np.array([[1.0, 0, 0]]), np.array([[0.0, 1, 0]])
    _, through = refracted(t, *flat, 1.0)
    t.require(not through[0], "where k is 0 nothing is refracted")

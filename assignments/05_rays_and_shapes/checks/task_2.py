"""Task 05.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.generators import unit_vectors

from .common import EXACT, T_MIN, distances, lengths, same_hits

check = checks_for(calls=("hit_triangle",))


def triangles(t, origin, direction, corners):
    parts = Items(distances(len(corners)), Array((len(corners), 2)), names=("t", "weights"))
    return t.call("hit_triangle", origin, direction, corners, returns=parts)


def aimed(t, count, parts, ahead):
    """(origin, direction, corners): triangles of which a ray passes the points with these parts.

    `parts` (count, 2) are the weights of b and c, `ahead` (count,) the t at which they are passed.
    """
    origin, direction = t.rng.uniform(-2, 2, 3), unit_vectors(t.rng, 1)[0] * lengths(t, 1)[0, 0]
    ab, ac = (
        unit_vectors(t.rng, count) * lengths(t, count),
        unit_vectors(t.rng, count) * lengths(t, count),
    )
    slim = np.abs(np.cross(ab, ac) @ direction) < 0.2 * np.linalg.norm(direction)
    ab[slim] = np.roll(direction, 1) * [1, 1, -1]
    ac[slim] = np.cross(direction, ab[slim])
    a = origin + ahead[:, None] * direction - parts[:, :1] * ab - parts[:, 1:] * ac
    return origin, direction, np.stack([a, a + ab, a + ac], axis=1)


def inner_parts(t, count):
    """Weights of b and c (count, 2) well inside."""
    return 0.02 + 0.94 * t.rng.dirichlet(np.ones(3), count)[:, 1:]


def outer_parts(t, count):
    """Weights of b and c (count, 2) of which exactly one of three is below 0, or two are."""
    inner = t.rng.dirichlet(np.ones(3), count)
    which = np.arange(count) % 3
    moved = t.rng.uniform(0.05, 1.5, count) + inner[np.arange(count), which]
    inner[np.arange(count), which] -= moved
    inner[np.arange(count), (which + 1) % 3] += moved
    return inner[:, 1:]


@check(
    "05.2.inside",
    points=4,
    tolerance=EXACT,
    hint="handout, equations (8) and (9): volumes over their sum are the weights",
    sole="t and the weights, from both sides",
)
def places_inside_triangles(t):
    """A ray through a known point of a triangle hits it there, from either side."""
    for _ in range(3):
        parts, ahead = inner_parts(t, 20), t.rng.uniform(0.1, 5, 20)
        origin, direction, corners = aimed(t, 20, parts, ahead)
        got, weights = triangles(t, origin, direction, corners)
        same_hits(t, got, ahead, hint="a triangle is hit from both sides")
        t.close("weights", weights, parts, hint="the first is that of b, the second that of c")


@check(
    "05.2.misses",
    points=3,
    tolerance=EXACT,
    hint="all three volumes have one sign, and t is above T_MIN",
    sole="what is not there must not be seen",
)
def places_outside_triangles(t):
    """Beside a triangle, behind the origin, along its plane and without area: nothing is hit."""
    for _ in range(3):
        parts = np.concatenate([inner_parts(t, 12), outer_parts(t, 24)])
        ahead = t.rng.uniform(0.1, 5, 36) * np.where(np.arange(36) % 3 == 2, -1, 1)
        ahead[12:] = np.abs(ahead[12:])
        origin, direction, corners = aimed(t, 36, parts, ahead)
        right = np.where((np.arange(36) < 12) & (ahead > 0), ahead, np.inf)
        got, weights = triangles(t, origin, direction, corners)
        same_hits(t, got, right)
        missed = np.isinf(right)
        t.require(not weights[missed].any(), "weights are zeros where nothing is hit")
    flat = np.array(
        [
            [[1, 0, 0], [2, 0, 0], [2, 1, 0]],  # the ray lies in its plane
            [[1, 0, 0], [2, 1, 1], [3, 2, 2]],  # no area
            [[2, 1, 1], [2, 1, 1], [2, 1, 1]],
            [[3, -1, -1], [3, 2, -1], [3, -1, 2]],
            [[0, -1, -1], [0, 2, -1], [0, -1, 2]],  # the ray starts on it
            [[2 * T_MIN, -1, -1], [2 * T_MIN, 1, -1], [2 * T_MIN, 0, 1]],  # at T_MIN itself
            [[3, -0.25, -0.25], [3, 0.75, -0.25], [3, -0.25, 0.25]],
        ],
        float,
    )
    got, _ = triangles(t, np.zeros(3), np.array([2.0, 0, 0]), flat)
    same_hits(t, got, np.array([np.inf, np.inf, np.inf, 1.5, np.inf, np.inf, 1.5]))


def sheet(t, n, jitter):
    """(corners (2 n n, 3, 3), vertices (n + 1, n + 1, 3)) of a bumpy sheet around z = 0."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    v = np.stack([x, y, np.zeros(x.shape)], axis=2)
    v += jitter * t.rng.uniform(-1, 1, v.shape)
    a, b, c, d = v[:-1, :-1], v[1:, :-1], v[1:, 1:], v[:-1, 1:]
    both = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    return both.reshape(-1, 3, 3), v


@check(
    "05.2.edges",
    points=4,
    hint="handout, section 2: on an edge both have one number with two signs, and 0 counts",
    sole="light must not leak between two triangles",
)
def no_light_between_triangles(t):
    """Rays onto edges and corners of a sheet hit it; rays onto its faces hit one triangle."""
    n = 5
    for jitter in (0.0, 0.3):
        corners, v = sheet(t, n, jitter)
        s = t.rng.random((40, 1))
        i, j = t.rng.integers(1, n - 1, (2, 40))
        ends = v[i, j], v[i + np.arange(40) % 2, j + (np.arange(40) + 1) // 2 % 2]
        s[::8] = 0.0
        s = np.round(s * 8) / 8 if jitter == 0 else s
        edge = (1 - s) * ends[0] + s * ends[1]
        own = corners[t.rng.integers(0, len(corners), 20)]
        face = np.einsum("nk,nkc->nc", 0.04 + 0.88 * t.rng.dirichlet(np.ones(3), 20), own)
        for k, place in enumerate(np.concatenate([edge, face])):
            tilt = t.rng.uniform(-0.3, 0.3, 2) if jitter else np.zeros(2)
            direction = np.array([*tilt, -1.0]) * (1.0 if jitter == 0 else lengths(t, 1)[0, 0])
            direction *= 1 if k % 3 else -1  # from below
            got, _ = triangles(t, place - 4 * direction, direction, corners)
            many = int(np.isfinite(got).sum())
            t.require(many > 0, "a ray leaks between two triangles with a common edge")
            t.require(k < 40 or many == 1, f"a ray onto one triangle hits {many}")

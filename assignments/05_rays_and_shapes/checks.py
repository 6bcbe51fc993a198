"""Checks of assignment 05. What costs is counted, in places, boxes and things; never in seconds."""

from __future__ import annotations

import numpy as np
from photograd_course.grading import Array, Items, Subject, Tolerance, check
from photograd_course.grading.failures import CheckFailed

# Evidence: worst of the solution and the alternatives over several seeds, against the nearest of
# all named wrong solutions.
EXACT = Tolerance(1e-9, "right ones differ by 1e-12 or less, wrong ones by 1e-3 or more")
FAR = Tolerance(1e-5, "right ones are off by 1e-8, the quadratic formula by 1e-3")
MARCHED = Tolerance(1e-7, "a march stops 1e-9 short at most, wrong ones by 1e-2 or more")
SLOPES = Tolerance(1e-4, "differences leave 1e-6, wrong ones are off by 1e-1 or more")
COUNTED = Tolerance(1e-12, "whole numbers")

T_MIN, CLOSE, LEAF = 1e-9, 1e-9, 2


class Distances:
    """An array (R,) of float64, each above 0; infinite where nothing is met."""

    def __init__(self, count):
        self.count = count

    def require(self, value, where):
        fits = isinstance(value, np.ndarray) and value.dtype == np.float64
        if not fits or value.shape != (self.count,):
            got = f"{value.dtype} {value.shape}" if isinstance(value, np.ndarray) else type(value)
            raise CheckFailed(
                f"{where}: expected a float64 array of shape ({self.count},), got {got}"
            )
        if not (value > 0).all():
            at = int(np.argwhere(~(value > 0))[0, 0])
            raise CheckFailed(
                f"{where}: t at index {at} is {value[at]}; "
                "it is above 0, and infinite where nothing is met"
            )


class Distance:
    """A float above 0, or infinity."""

    def require(self, value, where):
        if isinstance(value, bool) or not isinstance(value, float) or not value > 0:
            raise CheckFailed(f"{where}: expected a float above 0, or infinity, got {value!r}")


class Whole:
    """An int64 array with any number of rows and this many axes."""

    def require(self, value, where):
        fits = isinstance(value, np.ndarray) and value.dtype == np.int64 and value.ndim == 1
        if not fits:
            got = f"{value.dtype} {value.shape}" if isinstance(value, np.ndarray) else type(value)
            raise CheckFailed(f"{where}: expected an int64 array of shape (...,), got {got}")


class Boxes:
    """A finite array (N, 2, 3) of float64."""

    def require(self, value, where):
        fits = isinstance(value, np.ndarray) and value.dtype == np.float64 and value.ndim == 3
        if not fits or value.shape[1:] != (2, 3) or not np.isfinite(value).all():
            got = f"{value.dtype} {value.shape}" if isinstance(value, np.ndarray) else type(value)
            raise CheckFailed(f"{where}: expected finite float64 numbers (N, 2, 3), got {got}")


class WholeNumber:
    """An int."""

    def require(self, value, where):
        if isinstance(value, bool) or not isinstance(value, int):
            raise CheckFailed(f"{where}: expected an int, got {type(value).__name__}")


def same_hits(t, got, right, tolerance=None, hint=""):
    """The same rays meet something, at the same t."""
    wrong = np.isfinite(got) != np.isfinite(right)
    if wrong.any():
        at = int(np.argwhere(wrong)[0, 0])
        told = "meets nothing" if np.isinf(got[at]) else "meets something"
        t.require(
            False,
            f"{int(wrong.sum())} of {len(got)} rays are wrong: number {at} {told}, which is not so",
            hint=hint,
        )
    met = np.isfinite(right)
    if met.any():
        t.close("t", got[met], right[met], tolerance, hint=hint)


def units(t, count):
    """Random unit vectors (count, 3)."""
    v = t.rng.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def lengths(t, count):
    """Random lengths (count, 1) of directions."""
    return np.exp(t.rng.uniform(-1.5, 1.5, (count, 1)))


# 05.1 ---------------------------------------------------------------------------------------------


def sphere(t):
    return t.rng.uniform(-3, 3, 3), float(t.rng.uniform(0.5, 2.5))


def hit(t, origins, directions, center, radius):
    return t.call(
        "hit_sphere", origins, directions, center, radius, returns=Distances(len(origins))
    )


def rays_onto(t, count, center, radius):
    """(origins, directions, right, outward normals) of rays that meet a sphere from outside."""
    n, d = units(t, count), units(t, count)
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
    task="05.1",
    points=3,
    calls=("hit_sphere",),
    tolerance=EXACT,
    hint="handout, equation (5): from where the ray is nearest, h back",
    sole="where most rays come from",
)
def spheres_from_outside(t):
    """Rays aimed at a place of a sphere from outside meet it there, whatever their length."""
    for _ in range(3):
        center, radius = sphere(t)
        origins, directions, right, _ = rays_onto(t, 20, center, radius)
        same_hits(t, hit(t, origins, directions, center, radius), right)


@check(
    "05.1.inside",
    task="05.1",
    points=2,
    calls=("hit_sphere",),
    tolerance=EXACT,
    hint="handout, equation (6): where the first of the two does not count, take the second",
    sole="what refraction and shadows need",
)
def spheres_from_inside(t):
    """Rays that start inside meet the far side; rays that start on the sphere, not their start."""
    for _ in range(3):
        center, radius = sphere(t)
        origins, directions, right = rays_within(t, 20, center, radius)
        same_hits(t, hit(t, origins, directions, center, radius), right)


@check(
    "05.1.misses",
    task="05.1",
    points=2,
    calls=("hit_sphere",),
    tolerance=EXACT,
    hint="nothing behind the origin is met, nor where h² < 0; a ray that touches meets",
    sole="what is not there must not be seen",
)
def spheres_missed(t):
    """Rays past a sphere and away from it meet nothing; one that touches it does."""
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
    task="05.1",
    points=1,
    calls=("hit_sphere",),
    tolerance=FAR,
    hint="handout, end of section 1: subtract places before you square them",
)
def a_sphere_far_away(t):
    """A sphere of radius 1 is met on its surface from ten million metres away as well."""
    n = units(t, 30)
    d = units(t, 30)
    d = np.where(np.sum(n * d, axis=1, keepdims=True) > 0, -d, d) - 0.2 * n
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    origins = n - 1e7 * d
    got = hit(t, origins, d, np.zeros(3), 1.0)
    t.require(bool(np.isfinite(got).all()), "rays aimed at the sphere from far away miss it")
    away = np.linalg.norm(origins + got[:, None] * d, axis=1)
    t.close("distance from the centre", away, np.ones(30))


# 05.2 ---------------------------------------------------------------------------------------------


def triangles(t, origin, direction, corners):
    parts = Items(Distances(len(corners)), Array((len(corners), 2)), names=("t", "weights"))
    return t.call("hit_triangle", origin, direction, corners, returns=parts)


def aimed(t, count, parts, ahead):
    """(origin, direction, corners): triangles of which a ray passes the places with these parts.

    `parts` (count, 2) are the weights of b and c, `ahead` (count,) the t at which they are passed.
    """
    origin, direction = t.rng.uniform(-2, 2, 3), units(t, 1)[0] * lengths(t, 1)[0, 0]
    ab, ac = units(t, count) * lengths(t, count), units(t, count) * lengths(t, count)
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
    task="05.2",
    points=4,
    calls=("hit_triangle",),
    tolerance=EXACT,
    hint="handout, equations (8) and (9): volumes over their sum are the weights",
    sole="t and the weights, from both sides",
)
def places_inside_triangles(t):
    """A ray through a known place of a triangle meets it there, from either side."""
    for _ in range(3):
        parts, ahead = inner_parts(t, 20), t.rng.uniform(0.1, 5, 20)
        origin, direction, corners = aimed(t, 20, parts, ahead)
        got, weights = triangles(t, origin, direction, corners)
        same_hits(t, got, ahead, hint="a triangle is met from both sides")
        t.close("weights", weights, parts, hint="the first is that of b, the second that of c")


@check(
    "05.2.misses",
    task="05.2",
    points=3,
    calls=("hit_triangle",),
    tolerance=EXACT,
    hint="all three volumes have one sign, and t is above T_MIN",
    sole="what is not there must not be seen",
)
def places_outside_triangles(t):
    """Beside a triangle, behind the origin, along its plane and without area: nothing is met."""
    for _ in range(3):
        parts = np.concatenate([inner_parts(t, 12), outer_parts(t, 24)])
        ahead = t.rng.uniform(0.1, 5, 36) * np.where(np.arange(36) % 3 == 2, -1, 1)
        ahead[12:] = np.abs(ahead[12:])
        origin, direction, corners = aimed(t, 36, parts, ahead)
        right = np.where((np.arange(36) < 12) & (ahead > 0), ahead, np.inf)
        got, weights = triangles(t, origin, direction, corners)
        same_hits(t, got, right)
        missed = np.isinf(right)
        t.require(not weights[missed].any(), "weights are zeros where nothing is met")
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
    task="05.2",
    points=4,
    calls=("hit_triangle",),
    hint="handout, section 2: on an edge both have one number with two signs, and 0 counts",
    sole="light must not leak between two triangles",
)
def no_light_between_triangles(t):
    """Rays onto edges and corners of a sheet meet it; rays onto its faces meet one triangle."""
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
            t.require(k < 40 or many == 1, f"a ray onto one triangle meets {many}")


# 05.3 ---------------------------------------------------------------------------------------------


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
    n = units(t, count)
    s = np.cross(n, units(t, count))
    s /= np.linalg.norm(s, axis=1, keepdims=True)
    angle = t.rng.uniform(0.05, most, (count, 1))
    return np.sin(angle) * s + (1 if inside else -1) * np.cos(angle) * n, n


@check(
    "05.3.snell",
    task="05.3",
    points=4,
    calls=("refract",),
    tolerance=EXACT,
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
    task="05.3",
    points=2,
    calls=("refract",),
    tolerance=EXACT,
    hint="the way back is the way there: from inside the ratio is 1 / eta",
    sole="light goes back the way it came",
)
def light_goes_back(t):
    """What leaves the other way round arrives where it came from."""
    for eta in (1.33, 2.4):
        d, n = arrivals(t, 15)
        out, _ = refracted(t, d, n, eta)
        again, through = refracted(t, -out, n, eta)
        t.require(bool(through.all()), "light does not get back out the way it came in")
        t.close("way back", again, -d)


@check(
    "05.3.total",
    task="05.3",
    points=3,
    calls=("refract",),
    tolerance=EXACT,
    hint="handout, equation (12): where (11) has no root everything is mirrored",
    sole="the critical angle",
)
def total_reflection(t):
    """Beyond the critical angle, and only there, light from inside is mirrored."""
    eta = 1.5
    critical = np.arcsin(1 / eta)
    n = units(t, 12)
    s = np.cross(n, units(t, 12))
    s /= np.linalg.norm(s, axis=1, keepdims=True)
    more = np.array([-0.3, -1e-2, -1e-5, 1e-5, 1e-2, 0.3] * 2)
    angle = (critical + more)[:, None]
    d = np.sin(angle) * s + np.cos(angle) * n
    out, through = refracted(t, d, n, eta)
    t.require(bool((through == (more < 0)).all()), "through is wrong near the critical angle")
    back = more > 0
    t.close("mirrored, along the surface", np.cross(n, out)[back], np.cross(n, d)[back])
    t.close(
        "mirrored, along the normal", np.sum(out * n, axis=1)[back], -np.sum(d * n, axis=1)[back]
    )
    _, through = refracted(t, *arrivals(t, 8, 1.5), eta)
    t.require(bool(through.all()), "from outside into glass some light always gets through")
    flat = np.array([[1.0, 0, 0]]), np.array([[0.0, 1, 0]])
    _, through = refracted(t, *flat, 1.0)
    t.require(not through[0], "where k is 0 nothing gets through")


# 05.4 ---------------------------------------------------------------------------------------------


class Surface:
    """A service that tells distances, and counts for how many places."""

    def __init__(self, shape, most=100_000):
        self.shape, self.most, self.asked = shape, most, 0

    def __call__(self, places):
        if not (isinstance(places, np.ndarray) and places.ndim == 2 and places.shape[1] == 3):
            raise CheckFailed("march_sdf: sdf wants places, an array of shape (M, 3)")
        if len(places) == 0:
            raise CheckFailed("march_sdf: sdf is asked for no place at all: no ray is on its way")
        if not np.isfinite(places).all():
            raise CheckFailed("march_sdf: sdf is asked for a place that is not finite")
        self.asked += len(places)
        if self.asked > self.most:
            raise CheckFailed("march_sdf: asks without end")
        return self.shape(places)


def ball(center, radius, by=None):
    """Distance to a sphere; p is the radius, or moves the centre along `by`."""

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
    """(t, d_t, places asked for)."""
    service = Surface(shape)
    parts = Items(Distances(len(origins)), Array((len(origins),)), names=("t", "d_t"))
    got, d_t = t.call("march_sdf", service, origins, directions, t_max, steps, returns=parts)
    return got, d_t, service.asked


def onto_ball(t, count, center, radius):
    """(origins, unit directions, right) of rays that meet a ball from outside, not grazing."""
    n, d = units(t, count), units(t, count)
    d = np.where(np.sum(n * d, axis=1, keepdims=True) > 0, -d, d) - 0.4 * n
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    right = t.rng.uniform(0.3, 5, count)
    return center + radius * n - right[:, None] * d, d, right


def past_ball(t, count, center, radius):
    """(origins, unit directions) of rays that pass a ball at 1.05 to 2 radii."""
    d = units(t, count)
    s = np.cross(d, units(t, count))
    s *= t.rng.uniform(1.05, 2, (count, 1)) * radius / np.linalg.norm(s, axis=1, keepdims=True)
    return center + s - t.rng.uniform(1, 4, (count, 1)) * d, d


@check(
    "05.4.met",
    task="05.4",
    points=4,
    calls=("march_sdf",),
    tolerance=MARCHED,
    hint="handout, equation (13): go ahead by |f|, from inside too; nothing can be nearer",
    sole="that the surface is found, and only it",
)
def surfaces_are_met(t):
    """Rays meet a ball, from outside and inside, and what stands behind it; others pass."""
    for _ in range(2):
        center, radius = sphere(t)
        origins, directions, right = onto_ball(t, 15, center, radius)
        away = past_ball(t, 10, center, radius)
        inside = center + 0.5 * radius * units(t, 5)
        ahead = units(t, 5)
        b = np.sum((inside - center) * ahead, axis=1)
        through = -b + np.sqrt(b**2 + 0.75 * radius**2)
        everything = np.concatenate([origins, away[0], inside])
        ways = np.concatenate([directions, away[1], ahead])
        right = np.concatenate([right, np.full(10, np.inf), through])
        got, d_t, _ = marched(t, ball(center, radius), everything, ways)
        same_hits(t, got, right)
        t.require(not d_t[np.isinf(got)].any(), "d_t is zero where nothing is met")
    normal = units(t, 1)[0]
    origins, directions = past_ball(t, 10, np.zeros(3), 1.0)
    height = float((origins @ normal).min()) - 2.5
    scene = both(ball(np.zeros(3), 1.0), wall(normal, height))
    falls = directions @ normal
    right = np.where(falls < -0.2, (height - origins @ normal) / falls, np.inf)
    kept = np.abs(falls) > 0.2
    got, _, _ = marched(t, scene, origins[kept], directions[kept])
    same_hits(t, got, right[kept])


def differences(t, make, origins, directions, eps=1e-2):
    """The derivative of the hand-in's own t by p, by four differences."""
    at = {k: marched(t, make(k * eps), origins, directions)[0] for k in (-2, -1, 1, 2)}
    kept = np.isfinite(np.stack(list(at.values()))).all(axis=0)
    safe = {k: np.where(kept, value, 0.0) for k, value in at.items()}
    return (8 * (safe[1] - safe[-1]) - (safe[2] - safe[-2])) / (12 * eps), kept


@check(
    "05.4.derivative",
    task="05.4",
    points=5,
    calls=("march_sdf",),
    tolerance=SLOPES,
    hint="handout, equation (15): the place is held on the surface while p changes",
    sole="the gate: differences of the hand-in's own march",
)
def the_derivative_of_a_hit(t):
    """d_t is what differences of t by p say: a radius, a place, a height."""
    center, radius = sphere(t)
    by, normal = units(t, 1)[0], units(t, 1)[0]
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
            hint="05.4.met looks at what is met",
        )
        t.require(float(np.abs(right[kept]).max()) > 0.1, "t does not depend on p")
        t.close("d_t", d_t[kept], right[kept])


@check(
    "05.4.cost",
    task="05.4",
    points=3,
    calls=("march_sdf",),
    hint="ask only for rays that are neither there nor beyond t_max, at most `steps` times",
    sole="questions are counted, not seconds",
)
def few_questions(t):
    """A ray straight onto a wall needs two questions, no ray has more than `steps`."""
    up = np.array([0.0, 0, 1])
    origins = np.array([[0, 0, 1.0], [1, 0, 2], [5, 2, 4], [0, 0, 8], [3, 3, 1]])
    down = np.tile(-up, (5, 1))
    got, _, asked = marched(t, wall(up, 0.0), origins, down)
    same_hits(t, got, origins[:, 2], COUNTED)
    t.require(asked == 10, f"five rays straight onto a wall: {asked} places, 10 are enough")
    got, _, asked = marched(t, wall(up, 0.0), origins, down, t_max=4.0)
    same_hits(t, got, np.array([1, 2, 4, np.inf, 1]), COUNTED, hint="t_max itself still counts")
    t.require(asked == 9, f"with t_max 4: {asked} places, 9 are enough")
    got, _, asked = marched(t, wall(up, 0.0), origins, down, steps=1)
    t.require(bool(np.isinf(got).all()), "one step is not enough to arrive at a wall")
    t.require(asked == 5, f"with steps 1 five rays ask for {asked} places, 5 are right")
    got, _, asked = marched(t, wall(up, 0.0), CLOSE * up[None], down[:1])
    same_hits(t, got, np.array([CLOSE]), COUNTED, hint="there is *below* CLOSE")
    # Past slanted walls the distance shrinks by the same factor each time.
    cosine = np.array([0.5, 0.75, 0.9])
    slanted = np.stack([np.sqrt(1 - cosine**2), np.zeros(3), -cosine], axis=1)
    got, _, asked = marched(t, wall(up, 0.0), np.tile(up, (3, 1)), slanted)
    needed = int((np.ceil(np.log(CLOSE) / np.log(1 - cosine)) + 1).sum())
    t.require(bool(np.isfinite(got).all()), "rays onto a wall miss it")
    t.require(abs(asked - needed) <= 3, f"three slanted rays: {asked} places, {needed} are needed")
    _, _, asked = marched(t, wall(up, 0.0), np.tile(up, (2, 1)), np.tile(up, (2, 1)), t_max=40.0)
    t.require(asked <= 14, f"two rays away from a wall, to t_max 40: {asked} places, 12 are enough")


# 05.5 ---------------------------------------------------------------------------------------------


def some_boxes(t, count, stretch=(1.0, 1.0, 1.0)):
    """(low, high), both (count, 3), of things of many sizes, in a region that is stretched."""
    middle = t.rng.uniform(-5, 5, (count, 3)) * stretch
    half = np.exp(t.rng.uniform(-4, 0, (count, 3)))
    return middle - half, middle + half


def built(t, low, high):
    """The hand-in's tree, looked at: (boxes, first, count, order), every rule of form kept."""
    parts = Items(Boxes(), Whole(), Whole(), Whole(), names=("boxes", "first", "count", "order"))
    boxes, first, count, order = t.call("build_bvh", low, high, returns=parts)
    nodes = len(boxes)
    t.require(nodes == len(first) == len(count) > 0, "boxes, first and count differ in length")
    t.require(
        np.array_equal(np.sort(order), np.arange(len(low))),
        "order must hold the number of each thing once",
    )
    t.require(bool(((count >= 0) & (count <= LEAF)).all()), f"a leaf holds 1 to {LEAF} things")
    waiting, used, owned = [0], np.zeros(nodes, np.int64), np.zeros(len(low), np.int64)
    while waiting:
        node = waiting.pop()
        used[node] += 1
        at, things = int(first[node]), int(count[node])
        t.require(
            at >= 0 and at + (things or 2) <= (len(low) if things else nodes),
            "first points beyond the end",
        )
        owned[at : at + things] += 1
        if not things:
            t.require(not used[at : at + 2].any(), "two nodes share a child, or one is its own")
            waiting += [at, at + 1]
    t.require(bool((used == 1).all()), "a node belongs to no parent")
    t.require(bool((owned == 1).all()), "a thing is in no leaf, or in several")
    return boxes, first, count, order


def held(tree):
    """For each node the numbers of the things below it."""
    _, first, count, order = tree
    found, way = [None] * len(first), [0]
    for node in way:  # which grows meanwhile
        if not count[node]:
            way += [first[node], first[node] + 1]
    for node in reversed(way):
        at = first[node]
        below = order[at : at + count[node]] if count[node] else np.concatenate(found[at : at + 2])
        found[node] = below
    return found


SIZES = (1, 2, 3, 7, 40)


@check(
    "05.5.boxes",
    task="05.5",
    points=4,
    calls=("build_bvh",),
    tolerance=EXACT,
    hint="handout, equation (16): the smallest corner of all, and the largest",
    sole="a box that is too small loses things, one too large costs",
)
def boxes_fit(t):
    """Every thing is in one leaf, and every box is the smallest that holds what is below it."""
    for count in SIZES:
        low, high = some_boxes(t, count)
        tree = built(t, low, high)
        things = held(tree)
        right = np.array([[low[mine].min(axis=0), high[mine].max(axis=0)] for mine in things])
        t.close(f"boxes of {count} things", tree[0], right)


@check(
    "05.5.halves",
    task="05.5",
    points=2,
    calls=("build_bvh",),
    hint="handout, equation (17): half of the things to each side, down to LEAF",
    sole="no path is longer than the logarithm",
)
def halves_are_equal(t):
    """Siblings hold equally many things, up to one; and nothing is cut that fits into a leaf."""
    for count in SIZES:
        tree = built(t, *some_boxes(t, count))
        _, first, many, _ = tree
        sizes = np.array([len(mine) for mine in held(tree)])
        inner = many == 0
        t.require(bool((sizes[inner] > LEAF).all()), "a node is cut that would fit into a leaf")
        apart = np.abs(sizes[first[inner]] - sizes[first[inner] + 1])
        t.require(bool((apart <= 1).all()), "siblings differ by more than one thing")


@check(
    "05.5.axis",
    task="05.5",
    points=3,
    calls=("build_bvh",),
    hint="cut across the axis on which the middles of the boxes are spread most",
    sole="halves that lie apart are what lets a ray skip one",
)
def halves_lie_apart(t):
    """The middles of siblings are apart along the axis on which they are spread most."""
    for stretch in ((1, 1, 1), (1, 9, 1), (1, 1, 9), (9, 1, 1)):
        low, high = some_boxes(t, 24, stretch)
        # A long thing across: its box is large, its middle is not far out.
        low[0], high[0] = -30 * np.roll([1, 0, 0], t.rng.integers(3)), np.array([1.0, 1, 1])
        tree = built(t, low, high)
        _, first, many, _ = tree
        things, middle = held(tree), (low + high) / 2
        for node in np.flatnonzero(many == 0):
            axis = int(np.argmax(np.ptp(middle[things[node]], axis=0)))
            one, two = (middle[things[first[node] + k], axis] for k in (0, 1))
            split = one.max() <= two.min() or two.max() <= one.min()
            t.require(bool(split), "the halves of a node mix along the axis of largest spread")


# 05.6 ---------------------------------------------------------------------------------------------


class Scene:
    """Rectangles, each across one axis: what a ray meets, told and counted."""

    def __init__(self, low, high):
        self.low, self.high = low, high
        self.axis = np.argmin(high - low, axis=1)
        self.boxes = None
        self.asked, self.met, self.most = [], [], 5_000

    def ray(self, origin, direction):
        self.origin, self.direction = origin, direction
        self.asked, self.met = [], []

    def times(self, numbers):
        """t (K,) of rectangles."""
        rows = np.arange(len(numbers))
        axis = self.axis[numbers]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (self.low[numbers, axis] - self.origin[axis]) / self.direction[axis]
            place = self.origin + t[:, None] * self.direction
        place[rows, axis] = self.low[numbers, axis]
        inside = ((place >= self.low[numbers]) & (place <= self.high[numbers])).all(axis=1)
        return np.where(inside & (t > T_MIN), t, np.inf)

    def box(self, node):
        whole = isinstance(node, int) and not isinstance(node, bool)
        if not whole or not 0 <= node < len(self.boxes):
            raise CheckFailed("traverse: box wants the number of a node")
        self.asked.append(node)
        if len(self.asked) > self.most:
            raise CheckFailed("traverse: asks without end")
        return self.boxes[node]

    def meet(self, numbers):
        numbers = np.asarray(numbers)
        whole = numbers.ndim == 1 and numbers.size and numbers.dtype.kind == "i"
        if not whole or not ((numbers >= 0) & (numbers < len(self.low))).all():
            raise CheckFailed("traverse: meet wants numbers (K,) of things, one or more")
        self.met += numbers.tolist()
        return self.times(numbers)


def rectangles(t, count, size=1.0, stretch=(1.0, 1.0, 1.0)):
    """A scene of random rectangles."""
    low = t.rng.uniform(-5, 5, (count, 3)) * stretch
    high = low + size * t.rng.uniform(0.3, 1.5, (count, 3))
    axis = t.rng.integers(0, 3, count)
    high[np.arange(count), axis] = low[np.arange(count), axis]
    return Scene(low, high)


def grow(t, scene):
    """The hand-in's tree for a scene, and its boxes for the scene's service."""
    tree = built(t, scene.low, scene.high)
    scene.boxes = tree[0]
    return tree


def first_met(t, scene, tree, origin, direction):
    """(t, number) of the hand-in."""
    scene.ray(origin, direction)
    parts = Items(Distance(), WholeNumber(), names=("t", "number"))
    _, first, count, order = tree
    return t.call(
        "traverse", first, count, order, scene.box, scene.meet, origin, direction, returns=parts
    )


def right_answer(t, scene, got, hint=""):
    """The nearest of all, asked one by one."""
    every = scene.times(np.arange(len(scene.low)))
    nearest = float(every.min())
    said = "nothing" if np.isinf(got[0]) else f"t = {got[0]:.6g}"
    asked = "nothing" if np.isinf(nearest) else "something"
    same = np.isinf(got[0]) == np.isinf(nearest)
    t.require(same, f"a ray meets {asked}, yours meets {said}", hint=hint)
    if np.isinf(nearest):
        t.require(got[1] == -1, "a ray that meets nothing has the number -1")
        return
    t.close("t", got[0], nearest, EXACT, hint=hint)
    t.require(0 <= got[1] < len(every) and every[got[1]] == nearest, "t is right, number is not")


@check(
    "05.6.nearest",
    task="05.6",
    points=4,
    calls=("traverse",),
    needs=("build_bvh",),
    hint="handout, equation (19): a box may be skipped only if it is missed or begins behind "
    "the best so far",
    sole="the same answer as from asking everything",
)
def the_nearest_of_all(t):
    """The first thing that rays meet is the one found by asking all."""
    for count, size in ((1, 1.0), (3, 1.0), (60, 1.0), (30, 6.0)):  # the last ones overlap a lot
        scene = rectangles(t, count, size)
        tree = grow(t, scene)
        for k in range(10):
            origin, direction = t.rng.uniform(-6, 6, 3), units(t, 1)[0] * lengths(t, 1)[0, 0]
            if k % 2:  # aimed at one
                which = t.rng.integers(count)
                target = t.rng.uniform(scene.low[which], scene.high[which])
                direction = (target - origin) * t.rng.uniform(0.2, 1.4)
            right_answer(t, scene, first_met(t, scene, tree, origin, direction))


@check(
    "05.6.axes",
    task="05.6",
    points=3,
    calls=("traverse",),
    needs=("build_bvh",),
    hint="where a component of the direction is 0, the origin is between both faces or not",
    sole="what random rays never do, and those of a camera always",
)
def rays_along_axes(t):
    """Rays along axes and in planes, from places on faces too, meet what they should."""
    scene = rectangles(t, 40, 2.0)
    tree = grow(t, scene)
    for k in range(18):
        origin, direction = t.rng.uniform(-5, 5, 3), units(t, 1)[0]
        direction[k % 3] = 0.0
        if k % 2:
            direction[(k + 1) % 3] = 0.0
        which = t.rng.integers(40)
        target = t.rng.uniform(scene.low[which], scene.high[which])
        origin = np.where(direction == 0, target, origin)
        right_answer(t, scene, first_met(t, scene, tree, origin, direction))
    # One rectangle, and rays through its edges and corners: they run along faces of its box.
    scene = Scene(np.array([[2.0, -1, 0.5]]), np.array([[2.0, 1, 3]]))
    tree = grow(t, scene)
    for y, z in ((-1, 2), (1, 2), (0, 0.5), (0, 3), (1, 3), (-1, 0.5), (1.5, 2)):
        for x, ahead in ((0.0, 0.5), (5.0, -1.0)):
            answer = first_met(t, scene, tree, np.array([x, y, z]), np.array([ahead, 0, 0]))
            right_answer(t, scene, answer, "0/0 is no number: deal with such axes by themselves")


def lanes(t, rows, deep):
    """A scene of rectangles across x, `deep` of them one behind the other in rows x rows lanes."""
    x, y, z = np.meshgrid(np.arange(deep), np.arange(rows), np.arange(rows), indexing="ij")
    low = np.stack([x, y, z], axis=3).reshape(-1, 3).astype(float)
    low += t.rng.uniform(0.05, 0.15, low.shape)
    high = low + np.array([0.0, 0.7, 0.7])
    return Scene(low, high)


@check(
    "05.6.cost",
    task="05.6",
    points=3,
    calls=("traverse",),
    needs=("build_bvh",),
    hint="handout, equation (20): the nearer box first, and what begins behind the best, never",
    sole="what a tree is for: questions are counted, not seconds",
)
def few_boxes_are_asked_for(t):
    """A ray through many things asks for the boxes that it enters before its hit, and siblings."""
    scene = lanes(t, 4, 16)
    tree = grow(t, scene)
    boxes, _, count, _ = tree
    for k in range(12):
        ahead = 1.0 if k % 2 else -1.0
        lane = t.rng.integers(0, 4, 2) + 0.4
        origin = np.array([-2.0 if ahead > 0 else 18.0, *lane])
        if k % 3 == 0:
            origin[0] = t.rng.uniform(3, 12)
        got = first_met(t, scene, tree, origin, np.array([ahead, 0.0, 0.0]))
        right_answer(t, scene, got)
        end = origin[0] + ahead * got[0]
        inside = ((boxes[:, 0, 1:] <= lane) & (lane <= boxes[:, 1, 1:])).all(axis=1)
        begins = boxes[:, 0, 0] <= end + 1e-9 if ahead > 0 else boxes[:, 1, 0] >= end - 1e-9
        passed = boxes[:, 1, 0] < origin[0] if ahead > 0 else boxes[:, 0, 0] > origin[0]
        entered = inside & begins & ~passed
        needed = 1 + 2 * int((entered & (count == 0)).sum())
        things = int(count[entered].sum())
        t.require(
            len(scene.asked) <= needed,
            f"{len(scene.asked)} boxes were asked for, {needed} are enough",
        )
        t.require(
            len(scene.met) <= things, f"{len(scene.met)} things were asked for, {things} are enough"
        )


@check(
    "05.6.growth",
    task="05.6",
    points=2,
    calls=("traverse",),
    needs=("build_bvh",),
    hint="16 times as many things are four more levels, not 16 times as many boxes",
    sole="growth, by counts",
)
def questions_grow_like_a_logarithm(t):
    """With 16 times as many things of a sheet, fewer than twice as many boxes are asked for."""
    means = []
    for rows in (8, 32):
        scene = lanes(t, rows, 1)
        scene.low[:, 1:], scene.high[:, 1:] = scene.low[:, 1:] / rows, scene.high[:, 1:] / rows
        tree = grow(t, scene)
        asked = 0
        for k in range(9):
            which = t.rng.integers(rows * rows)
            target = t.rng.uniform(scene.low[which], scene.high[which])
            origin = target - [2.0, *t.rng.uniform(-0.3, 0.3, 2)] if k % 3 else target - [2.0, 0, 0]
            right_answer(t, scene, first_met(t, scene, tree, origin, target - origin))
            asked += len(scene.asked)
        means.append(asked / 9)
    t.require(
        means[1] < 2 * means[0],
        f"64 things: {means[0]:.1f} boxes a ray, 1024 things: {means[1]:.1f}",
    )


def ring():
    """Triangles (256, 3, 3) of a ring, with coordinates that float32 has exactly."""
    turn, across = 2 * np.pi * np.arange(16) / 16, 2 * np.pi * np.arange(8) / 8
    far = 2 + 0.75 * np.cos(across)
    height = np.broadcast_to(0.75 * np.sin(across), (16, 8))
    v = np.stack([far * np.cos(turn)[:, None], height, far * np.sin(turn)[:, None]], axis=2)
    v = np.round(v * 64) / 64
    a, b = v, np.roll(v, -1, axis=1)
    d, c = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    both_halves = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    return both_halves.reshape(-1, 3, 3)


def ring_rays():
    """(origins, directions) of 24 rays from all around the ring."""
    k = np.arange(24)
    height, phi = 1 - (k + 0.5) / 12, 2.399963 * k
    flat = np.sqrt(1 - height * height)
    origins = np.round(256 * np.stack([flat * np.cos(phi), height, flat * np.sin(phi)], axis=1))
    s, far = 1.7 * phi + 0.3, np.where(k % 4 == 3, 0.5, 2.2)
    to = np.round(64 * np.stack([far * np.cos(s), 0.5 * np.sin(3 * k), far * np.sin(s)], axis=1))
    return origins / 64, (to - origins) / 64


# What Embree [Wald2014] says about them, through the C++ core: triangles, and t where there is one.
EMBREE = (
    2,
    165,
    87,
    -1,
    147,
    68,
    7,
    57,
    17,
    114,
    193,
    48,
    174,
    254,
    76,
    188,
    106,
    40,
    204,
    -1,
    10,
    187,
    93,
    -1,
)
EMBREE_T = (
    0.8074094252247,
    0.8333343913262,
    0.8203379780611,
    0.6868570173722,
    0.8616933137047,
    0.7339925628934,
    1.510409875712,
    0.4864799483926,
    0.3117000289521,
    0.3291869230618,
    0.4012528131706,
    0.3723334201136,
    0.2246670824919,
    0.5828264512131,
    0.3993073220366,
    0.821178456555,
    0.8116245224668,
    0.8129629882266,
    0.8471657567662,
    0.7978106266098,
    0.8077895024417,
)


@check(
    "05.6.embree",
    task="05.6",
    points=2,
    calls=("traverse",),
    needs=("build_bvh", "hit_triangle"),
    tolerance=EXACT,
    hint="traverse on triangles: the other checks of this task are simpler",
    sole="the whole, against a library that films are made with",
)
def as_embree_has_it(t):
    """Your tree and triangles find what Embree finds: the triangle, and where."""
    origins, directions = ring_rays()
    parts = Items(Distances(24), Whole(), names=("t", "number"))
    got, numbers = t.call("trace_mesh", ring(), origins, directions, returns=parts)
    right = np.array(EMBREE)
    t.require(len(numbers) == 24, "a number for each ray")
    wrong = int((numbers != right).sum())
    t.require(wrong == 0, f"{wrong} of 24 rays meet another triangle, or none")
    t.close("t", got[right >= 0], np.array(EMBREE_T))


# >>> hidden
def struck(t, n):
    """What `hit_sphere` takes: n rays near a sphere."""
    return t.rng.uniform(-6, 6, (n, 3)), units(t, n) * lengths(t, n), *sphere(t)


def crossed(t, n):
    """What `hit_triangle` takes: n triangles, every other one missed."""
    parts = np.concatenate([inner_parts(t, n - n // 2), outer_parts(t, n // 2)])
    return aimed(t, n, parts, t.rng.uniform(-2, 5, n))


def approached(t, n):
    """What `march_sdf` takes: n rays that meet a ball."""
    center, radius = sphere(t)
    return Surface(ball(center, radius)), *onto_ball(t, n, center, radius)[:2], 50.0, 400


def stacked(t, n):
    """What `build_bvh` takes."""
    low = t.rng.uniform(-5, 5, (n, 3))
    return low, low + t.rng.uniform(0.2, 1.0, (n, 3))


def searched(t, n):
    """What `traverse` takes: n things, and a ray towards one of them."""
    scene = rectangles(t, n, 3.0)
    scene.boxes, *tree = t.reference.build_bvh(scene.low, scene.high)
    origin = t.rng.uniform(-4, 4, 3)
    scene.ray(origin, (scene.low[0] + scene.high[0]) / 2 - origin)
    return *tree, lambda k: scene.box(int(k)), scene.meet, origin, scene.direction


@check(
    "05.1.hidden",
    task="05.1",
    points=2,
    calls=("hit_sphere",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at spheres that are not known beforehand",
    battery=[Subject("hit_sphere", struck, Distances, rows=(0, 1))],
)
def spheres_at_random(t):
    """Random rays and random spheres, of all kinds at once."""
    for _ in range(4):
        center, radius = sphere(t)
        outside, within = rays_onto(t, 12, center, radius), rays_within(t, 12, center, radius)
        origins = np.concatenate([outside[0], within[0], t.rng.uniform(-6, 6, (30, 3))])
        directions = np.concatenate([outside[1], within[1], units(t, 30) * lengths(t, 30)])
        right = t.reference.hit_sphere(origins, directions, center, radius)
        same_hits(t, hit(t, origins, directions, center, radius), right)


@check(
    "05.2.hidden",
    task="05.2",
    points=2,
    calls=("hit_triangle",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at triangles that are not known beforehand",
    battery=[
        Subject("hit_triangle", crossed, lambda n: Items(Distances(n), Array((n, 2))), rows=(2,))
    ],
)
def triangles_at_random(t):
    """Random rays and triangles, met and missed."""
    for _ in range(4):
        parts = np.concatenate([inner_parts(t, 20), outer_parts(t, 20)])
        ahead = t.rng.uniform(-2, 5, 40)
        given = aimed(t, 40, parts, ahead)
        right, expected = t.reference.hit_triangle(*given)
        got, weights = triangles(t, *given)
        same_hits(t, got, right)
        t.close("weights", weights, expected)


@check(
    "05.3.hidden",
    task="05.3",
    points=2,
    calls=("refract",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at directions that are not known beforehand",
    battery=[
        Subject(
            "refract",
            lambda t, n: (*arrivals(t, n), 0.7),
            lambda n: Items(Array((n, 3)), Array((n,), "bool")),
            rows=(0, 1),
        )
    ],
)
def glass_at_random(t):
    """Random directions from both sides, many of them beyond the critical angle."""
    for eta in (1.5, 0.6, 2.0):
        outer, inner = arrivals(t, 20), arrivals(t, 20, inside=True)
        d, n = (np.concatenate([one, two]) for one, two in zip(outer, inner, strict=True))
        right, expected = t.reference.refract(d, n, eta)
        out, through = refracted(t, d, n, eta)
        t.require(bool((through == expected).all()), "through is wrong for some rays")
        t.close("out", out, right)


@check(
    "05.4.hidden",
    task="05.4",
    points=2,
    calls=("march_sdf",),
    visibility="hidden",
    tolerance=MARCHED,
    sole="the same mistakes at scenes that are not known beforehand",
    battery=[
        Subject(
            "march_sdf",
            approached,
            lambda n: Items(Distances(n), Array((n,))),
            rows=(1, 2),
            tolerance=SLOPES,
        )
    ],
)
def marches_at_random(t):
    """Random scenes: what is met, the derivative, and how many places are asked for."""
    for p_first in (True, False):
        center, radius = sphere(t)
        normal = units(t, 1)[0]
        scene = both(ball(center, radius), wall(normal, -6.0), p_first)
        origins, directions, _ = onto_ball(t, 15, center, radius)
        more = past_ball(t, 15, center, radius)
        inside = center + 0.5 * radius * units(t, 5)
        origins = np.concatenate([origins, more[0], inside])
        directions = np.concatenate([directions, more[1], units(t, 5)])
        for t_max, steps in ((30.0, 400), (6.0, 12)):
            service = Surface(scene)
            right, slopes = t.reference.march_sdf(service, origins, directions, t_max, steps)
            got, d_t, asked = marched(t, scene, origins, directions, t_max, steps)
            same_hits(t, got, right)
            grazing = np.abs(slopes) > 20  # where 1e-9 of t is much of a slope
            t.close("d_t", d_t[~grazing], slopes[~grazing])
            said = f"{asked} places were asked for, {service.asked} are enough"
            t.require(asked <= 1.02 * service.asked, said)


@check(
    "05.5.hidden",
    task="05.5",
    points=2,
    calls=("build_bvh",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at things that are not known beforehand; growth",
    battery=[
        Subject(
            "build_bvh",
            stacked,
            lambda _: Items(Boxes(), Whole(), Whole(), Whole()),
            has_right=False,
        )
    ],
)
def trees_at_random(t):
    """Random things: the boxes fit, and rays ask for few more of them when there are many more."""
    means = []
    for count in (64, 1024):
        middle = t.rng.uniform(-5, 5, (count, 3)) * [1.0, 2.0, 1.0]
        half = 2.0 * count ** (-1 / 2) * t.rng.uniform(0.2, 1, (count, 3))
        low, high = middle - half, middle + half
        tree = built(t, low, high)
        things = held(tree)
        right = np.array([[low[mine].min(axis=0), high[mine].max(axis=0)] for mine in things])
        t.close(f"boxes of {count} things", tree[0], right)
        asked = 0
        for _ in range(24):
            scene = Scene(low, high)
            scene.boxes = tree[0]
            scene.ray(t.rng.uniform(-8, 8, 3), units(t, 1)[0])
            t.reference.traverse(
                tree[1],
                tree[2],
                tree[3],
                lambda k, s=scene: s.box(int(k)),
                scene.meet,
                scene.origin,
                scene.direction,
            )
            asked += len(scene.asked)
        means.append(asked / 24)
    t.require(
        means[1] < 4 * means[0],
        f"64 things: {means[0]:.1f} boxes for a ray, 1024 things: {means[1]:.1f}; "
        "fewer than four times as many are enough",
    )


@check(
    "05.6.hidden",
    task="05.6",
    points=2,
    calls=("traverse",),
    needs=("build_bvh",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes in scenes that are not known beforehand",
    battery=[
        Subject("traverse", searched, lambda _: Items(Distance(), WholeNumber()), sizes=(1, 2, 64))
    ],
)
def scenes_at_random(t):
    """Random rays in random scenes: the answer, and how many boxes and things it takes."""
    # Of 3, 6, 12 ... things a third are alone in their leaves, and those boxes are flat.
    for count, size in ((3, 1.5), (24, 6.0), (96, 1.5)):
        scene = rectangles(t, count, size)
        low, high = scene.low, scene.high
        tree = t.reference.build_bvh(low, high)
        scene.boxes = tree[0]
        mine, enough = [0, 0], [0, 0]
        for _ in range(8):
            which = t.rng.integers(count)
            target = t.rng.uniform(low[which], high[which])
            origin = t.rng.uniform(-4, 4, 3)
            direction = (target - origin) * t.rng.uniform(0.2, 1.4)
            right_answer(t, scene, first_met(t, scene, tree, origin, direction))
            mine = [mine[0] + len(scene.asked), mine[1] + len(scene.met)]
            scene.ray(origin, direction)
            t.reference.traverse(
                tree[1],
                tree[2],
                tree[3],
                lambda k, s=scene: s.box(int(k)),
                scene.meet,
                origin,
                direction,
            )
            enough = [enough[0] + len(scene.asked), enough[1] + len(scene.met)]
        for what, got, right in zip(("boxes", "things"), mine, enough, strict=True):
            t.require(got <= 1.05 * right, f"{got} {what} were asked for, {right} are enough")


# <<< hidden

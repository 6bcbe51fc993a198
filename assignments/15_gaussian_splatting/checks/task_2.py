"""Task 15.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, GATE, ahead, in_world, some_camera

check = checks_for(calls=("project",), tolerance=EXACT)

SAMPLED = Tolerance(
    1e-4, "a Gaussian of 1 mm leaves 5e-6, the nearest wrong one (lens_no_third_column) 0.28"
)


def shapes(rng, n, size=0.5):
    """Symmetric positive definite matrices (n, 3, 3)."""
    m = size * rng.normal(size=(n, 3, 3))
    return m @ m.swapaxes(1, 2) + 0.1 * size**2 * np.eye(3)


def symmetric(six):
    """Matrices (n, 3, 3) of the entries xx, xy, xz, yy, yz, zz."""
    return six[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)


def folded(d_cov):
    """The derivative with respect to the six numbers of `symmetric`, for any halves."""
    both = d_cov + d_cov.swapaxes(1, 2)
    both = np.where(np.eye(3) > 0, d_cov, both)
    return both.reshape(-1, 9)[:, [0, 1, 2, 4, 5, 8]]


def seen(t, means, cov, camera):
    """The values of `project`."""
    n = len(means)
    parts = Items(Array((n, 2)), Array((n, 3)), Array((n,)), names=("mean2d", "cov2d", "depth"))
    return t.call("adapters.project", means, cov, camera, returns=parts)


def seen_back(t, means, cov, camera, g):
    """Result of the `back` of `project`."""
    parts = Items(Array(means.shape), Array(cov.shape), names=("d_means", "d_cov"))
    return t.call("adapters.project_back", means, cov, camera, g[:, :2], g[:, 2:], returns=parts)


def outside(rng, camera, k):
    """Directions (8, 2) k times as far outside as the limits: sides first, then corners."""
    size = np.array([camera["width"], camera["height"]])
    low = (-0.15 * size - camera["center"]) / camera["focal"]
    high = (1.15 * size - camera["center"]) / camera["focal"]
    side = rng.uniform(-0.2, 0.2, (8, 2))
    side[0, 0], side[1, 0], side[2, 1], side[3, 1] = low[0], high[0], low[1], high[1]
    side[4], side[5], side[6], side[7] = low, high, [low[0], high[1]], [high[0], low[1]]
    return np.where(np.abs(side) > 0.25, k * side, side)


@check(
    "15.2.means",
    points=3,
    hint="handout, equations (9) and (10): rotate, move, divide by t_z, stretch, move",
    sole="needs no covariance",
)
def where_means_are_seen(t):
    """A point on the ray through a place of the screen is seen there, at its depth."""
    camera = some_camera(t.rng)
    place, z = t.rng.uniform(-10.0, 30.0, (7, 2)), t.rng.uniform(1.0, 5.0, 7)
    side = (place - camera["center"]) / camera["focal"]
    points = in_world(camera, np.concatenate([side, np.ones((7, 1))], axis=1) * z[:, None])
    mean2d, _, depth = seen(t, points, shapes(t.rng, 7), camera)
    t.close("mean2d", mean2d, place, reveal=True)
    t.close("depth", depth, z, reveal=True)


@check(
    "15.2.sampled",
    points=3,
    tolerance=SAMPLED,
    hint="handout, equations (11) and (12): J is the derivative of (10) with respect to t",
    sole="needs no formula: only your own means",
)
def the_covariance_of_projected_points(t):
    """Points spread like a small Gaussian are seen spread as your cov2d says."""
    camera = some_camera(t.rng)
    means = in_world(camera, ahead(t.rng, 4))
    cov = shapes(t.rng, 4, size=1e-3)
    _, cov2d, _ = seen(t, means, cov, camera)
    for k in range(4):
        half = np.sqrt(3) * np.linalg.cholesky(cov[k]).T
        points = means[k] + np.concatenate([half, -half])
        places, *_ = seen(t, points, np.repeat(cov[k : k + 1], 6, axis=0), camera)
        off = places - places.mean(axis=0)
        sample = (off.T @ off / 6)[[0, 0, 1], [0, 1, 1]]
        t.close("cov2d", cov2d[k], sample, SAMPLED)


@check(
    "15.2.limits",
    points=2,
    hint="handout, equation (13): only J sees the clamped direction, and mean2d does not",
    sole="asks what is clamped and what is not, on each side",
)
def what_is_held_outside(t):
    """Outside the limits cov2d is that of the limit, while mean2d goes on."""
    camera = some_camera(t.rng)
    cov = np.repeat(shapes(t.rng, 1), 8, axis=0)
    state, found = t.rng.bit_generator.state, []
    for k in (1.0, 1.2, 2.0):
        t.rng.bit_generator.state = state
        side = outside(t.rng, camera, k)
        points = 3.0 * np.concatenate([side, np.ones((8, 1))], axis=1)
        mean2d, cov2d, _ = seen(t, in_world(camera, points), cov, camera)
        t.close("mean2d", mean2d, side * camera["focal"] + camera["center"], reveal=True)
        found.append(cov2d)
    t.close("cov2d at 1.2 times the limit", found[1], found[0])
    t.close("cov2d at twice the limit", found[2], found[0])


# What the columns of `folded` are: an index tells nothing else of the matrix.
NINE = "cov with respect to xx, xy, xz, yy, yz, zz"


def projection_gate(t, points, camera, g):
    """Both groups of `project` against finite differences, at points of the camera's frame."""
    means, six = in_world(camera, points), shapes(t.rng, len(points)).reshape(-1, 9)
    six = six[:, [0, 1, 2, 4, 5, 8]]
    d_means, d_cov = seen_back(t, means, symmetric(six), camera, g)

    def forward(point):
        mean2d, cov2d, _ = seen(t, point["means"], symmetric(point[NINE]), camera)
        return np.concatenate([mean2d, cov2d], axis=1)

    found = {NINE: folded(d_cov), "means": d_means}
    agrees_with_finite_differences(t, found, forward, {"means": means, NINE: six}, g, GATE)


@check(
    "15.2.differences",
    points=4,
    adjoints=("project",),
    tolerance=GATE,
    hint="handout, section 2: xy is two entries of a matrix. d_means: t_z stands in four "
    "entries of J and in both u; inside, J_xz depends on u as well",
    sole="the derivative itself, without the reference",
)
def the_projection_agrees_with_differences(t):
    """Moving a mean or a covariance moves its splat as your back says."""
    camera = some_camera(t.rng)
    g = random_cotangent(t.rng, (3, 5))
    projection_gate(t, ahead(t.rng, 3), camera, g)
    # The covariance of a splat alone, so that a wrong slope of the mean hides nothing.
    projection_gate(t, ahead(t.rng, 2), camera, g[:2] * [0, 0, 1, 1, 1])
    points = in_world(camera, ahead(t.rng, 2))
    none = seen_back(t, points, shapes(t.rng, 2), camera, np.zeros((2, 5)))
    require_zero_for_zero(t, {"means": none[0], "cov": none[1]})


@check(
    "15.2.held",
    points=3,
    adjoints=("project",),
    tolerance=GATE,
    hint="handout, section 2: h is constant there, but J_xz = -f h / t_z still depends on t_z; "
    "in the world an error of t_z shows in all three columns",
    sole="the branch that public code has wrong",
)
def outside_the_limits_too(t):
    """Outside of the limits, beside the picture and at its corners, differences agree as well."""
    camera = some_camera(t.rng)
    side = outside(t.rng, camera, t.rng.uniform(1.3, 2.0))
    points = np.concatenate([side, np.ones((8, 1))], axis=1) * t.rng.uniform(2.0, 3.0, (8, 1))
    projection_gate(t, points[:4], camera, random_cotangent(t.rng, (4, 5)))
    projection_gate(t, points[4:], camera, random_cotangent(t.rng, (4, 5)) * [0, 0, 1, 1, 1])

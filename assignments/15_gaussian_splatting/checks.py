"""Checks of assignment 15."""

from __future__ import annotations

import numpy as np
from photograd_course.grading import (
    Array,
    CheckFailed,
    Items,
    Record,
    Subject,
    Tolerance,
    agree,
    check,
)
from photograd_course.grading.adjoint_gate import (
    random_cotangent,
    require_cheap,
    require_gradients,
    require_zero_for_zero,
)

# Evidence: worst of the solution and three alternatives, against the nearest of all named wrong
# solutions.
EXACT = Tolerance(
    1e-10, "right ones differ by at most 5e-15, the nearest wrong one (blend_no_background) by 5e-5"
)
GATE = Tolerance(
    1e-6, "differences leave 1e-9, the nearest wrong one (alpha_back_held_passes) 6e-4"
)
SAMPLED = Tolerance(
    1e-4, "a Gaussian of 1 mm leaves 5e-6, the nearest wrong one (lens_no_third_column) 0.28"
)
SCENE = ("means", "log_scales", "quats", "opacity_logits", "colors")


def turned(rng):
    """A rotation (3, 3) about any axis."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return q


def some_camera(rng):
    """A camera anywhere, whose pictures are not square."""
    pose = np.concatenate([turned(rng), rng.normal(size=(3, 1))], axis=1)
    return {
        "camera_from_world": pose,
        "focal": np.array([18.0, 22.0]),
        "center": np.array([9.0, 8.0]),
        "width": 20,
        "height": 14,
    }


def in_world(camera, t):
    """Points of the camera's frame, in the world."""
    pose = camera["camera_from_world"]
    return (t - pose[:, 3]) @ pose[:, :3]


def ahead(rng, n):
    """Points in front of the camera that it sees, no two equally deep; (n, 3)."""
    z = 2.0 + 0.25 * rng.permutation(n)
    side = rng.uniform(-0.25, 0.25, (n, 2))
    return np.concatenate([side * z[:, None], z[:, None]], axis=1)


def shapes(rng, n, size=0.5):
    """Symmetric positive definite matrices (n, 3, 3)."""
    m = size * rng.normal(size=(n, 3, 3))
    return m @ m.swapaxes(1, 2) + 0.1 * size**2 * np.eye(3)


def symmetric(six):
    """Matrices (n, 3, 3) of the entries xx, xy, xz, yy, yz, zz."""
    return six[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)


def folded(d_cov):
    """The derivative by the six numbers of `symmetric`, whichever half stands where."""
    both = d_cov + d_cov.swapaxes(1, 2)
    both = np.where(np.eye(3) > 0, d_cov, both)
    return both.reshape(-1, 9)[:, [0, 1, 2, 4, 5, 8]]


def floored(size, tolerance=EXACT):
    """A tolerance for values that may cancel: relative to a size, not to what is left."""
    return Tolerance(tolerance.relative, tolerance.evidence, floor=float(size))


# 15.1 ---------------------------------------------------------------------------------------------


def spread(t, q, s):
    """The values of `covariance`."""
    return t.call("adapters.covariance", q, s, returns=Array((len(q), 3, 3)))


def spread_back(t, q, s, g):
    """What the `back` of `covariance` returns."""
    parts = Items(Array(q.shape), Array(s.shape), names=("d_quats", "d_log_scales"))
    return t.call("adapters.covariance_back", q, s, g, returns=parts)


@check(
    "15.1.axes",
    task="15.1",
    points=2,
    calls=("covariance",),
    tolerance=EXACT,
    hint="handout, equations (4) to (6): w turns nothing, (x, y, z) is the axis",
    sole="small enough to work out by hand",
)
def known_turns(t):
    """Unturned the scales lie on the axes; about z by an angle, xx, xy, yy are known."""
    s = t.rng.uniform(-1.0, 1.0, (1, 3))
    a, b, c = np.exp(2 * s[0])
    plain = spread(t, np.array([[1.0, 0.0, 0.0, 0.0]]), s)
    t.close("cov, unturned", plain[0], np.diag([a, b, c]), reveal=True)
    for axis in range(3):
        angle = t.rng.uniform(0.2, 1.2)
        q = np.zeros((1, 4))
        q[0, 0], q[0, 1 + axis] = np.cos(angle / 2), np.sin(angle / 2)
        got = spread(t, q, s)[0]
        i, j = (axis + 1) % 3, (axis + 2) % 3
        p, r = np.exp(2 * s[0, [i, j]])
        cos, sin = np.cos(angle), np.sin(angle)
        expected = [p * cos**2 + r * sin**2, (p - r) * sin * cos, p * sin**2 + r * cos**2]
        t.close(
            f"cov, turned about the axis {'xyz'[axis]}",
            got[[i, i, j], [i, j, j]],
            expected,
            reveal=True,
        )


@check(
    "15.1.same",
    task="15.1",
    points=2,
    calls=("covariance",),
    tolerance=EXACT,
    hint="handout, section 1: divide by the length of q; M M^T is symmetric whatever M is",
    sole="needs no formula: what any covariance must be",
)
def symmetric_positive_and_free_of_length(t):
    """cov is symmetric, its eigenvalues are squared scales; q, -q and 3 q are one Gaussian."""
    q, s = t.rng.normal(size=(6, 4)), t.rng.uniform(-1.0, 1.0, (6, 3))
    cov = spread(t, q, s)
    t.close("the transpose of cov", cov.swapaxes(1, 2), cov)
    t.close("eigenvalues", np.linalg.eigvalsh(cov), np.sort(np.exp(2 * s), axis=1), reveal=True)
    t.close("cov of -q", spread(t, -q, s), cov)
    t.close("cov of 3 q", spread(t, 3 * q, s), cov)


@check(
    "15.1.differences",
    task="15.1",
    points=4,
    calls=("covariance",),
    adjoints=("covariance",),
    tolerance=GATE,
    hint="handout, equations (7) and (8); d_log_scales: M, not R; d_cov need not be symmetric",
    sole="the derivative itself, without the reference",
)
def the_shape_agrees_with_differences(t):
    """Moving q or a scale moves your covariance as your back says, group by group."""
    q, s = t.rng.normal(size=(3, 4)), t.rng.uniform(-0.7, 0.7, (3, 3))
    g = random_cotangent(t.rng, (3, 3, 3))
    d_q, d_s = spread_back(t, q, s, g)

    def forward(point):
        return spread(t, point["quats"], point["log_scales"])

    found = {"log_scales": d_s, "quats": d_q}
    require_gradients(t, found, forward, {"quats": q, "log_scales": s}, g, GATE)
    none = spread_back(t, q, s, 0 * g)
    require_zero_for_zero(t, {"quats": none[0], "log_scales": none[1]})


@check(
    "15.1.length",
    task="15.1",
    points=1,
    calls=("covariance",),
    adjoints=("covariance",),
    tolerance=EXACT,
    hint="handout, equation (8): a longer q alone changes nothing",
    sole="names what the division by the length leaves out",
)
def length_has_no_derivative(t):
    """Along q nothing changes: q . d_q = 0; at 2 q, d_q is half as long; at -q it is -d_q."""
    q, s = t.rng.normal(size=(5, 4)), t.rng.uniform(-0.7, 0.7, (5, 3))
    g = random_cotangent(t.rng, (5, 3, 3))
    d_q, _ = spread_back(t, q, s, g)
    t.require(bool(d_q.any()), "d_quats is zero")
    along = np.sum(q * d_q, axis=1)
    t.close("q . d_q", along, 0 * along, floored(np.linalg.norm(d_q)), reveal=True)
    t.close("d_q at 2 q", spread_back(t, 2 * q, s, g)[0], d_q / 2)
    t.close("d_q at -q", spread_back(t, -q, s, g)[0], -d_q)


# 15.2 ---------------------------------------------------------------------------------------------


def seen(t, means, cov, camera):
    """The values of `project`."""
    n = len(means)
    parts = Items(Array((n, 2)), Array((n, 3)), Array((n,)), names=("mean2d", "cov2d", "depth"))
    return t.call("adapters.project", means, cov, camera, returns=parts)


def seen_back(t, means, cov, camera, g):
    """What the `back` of `project` returns."""
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
    task="15.2",
    points=3,
    calls=("project",),
    tolerance=EXACT,
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
    task="15.2",
    points=3,
    calls=("project",),
    tolerance=SAMPLED,
    hint="handout, equations (11) and (12): J is the derivative of (10) by t",
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
    task="15.2",
    points=2,
    calls=("project",),
    tolerance=EXACT,
    hint="handout, equation (13): only J sees the held direction, and mean2d does not",
    sole="asks what is held and what is not, on each side",
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
NINE = "cov by xx, xy, xz, yy, yz, zz"


def projection_gate(t, points, camera, g):
    """Both groups of `project` against differences, at points of the camera's frame."""
    means, six = in_world(camera, points), shapes(t.rng, len(points)).reshape(-1, 9)
    six = six[:, [0, 1, 2, 4, 5, 8]]
    d_means, d_cov = seen_back(t, means, symmetric(six), camera, g)

    def forward(point):
        mean2d, cov2d, _ = seen(t, point["means"], symmetric(point[NINE]), camera)
        return np.concatenate([mean2d, cov2d], axis=1)

    found = {NINE: folded(d_cov), "means": d_means}
    require_gradients(t, found, forward, {"means": means, NINE: six}, g, GATE)


@check(
    "15.2.differences",
    task="15.2",
    points=4,
    calls=("project",),
    adjoints=("project",),
    tolerance=GATE,
    hint="handout, equation (14): xy is two entries of a matrix. d_means: t_z stands in four "
    "entries of J and in both u; inside, J_xz moves by u as well",
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
    task="15.2",
    points=3,
    calls=("project",),
    adjoints=("project",),
    tolerance=GATE,
    hint="handout, section 2: what is held does not move; t_z still stands under f",
    sole="the branch that public code has wrong",
)
def outside_the_limits_too(t):
    """Outside of the limits, beside the picture and at its corners, differences agree as well."""
    camera = some_camera(t.rng)
    side = outside(t.rng, camera, t.rng.uniform(1.3, 2.0))
    points = np.concatenate([side, np.ones((8, 1))], axis=1) * t.rng.uniform(2.0, 3.0, (8, 1))
    projection_gate(t, points[:4], camera, random_cotangent(t.rng, (4, 5)))
    projection_gate(t, points[4:], camera, random_cotangent(t.rng, (4, 5)) * [0, 0, 1, 1, 1])


# 15.3 ---------------------------------------------------------------------------------------------


def taken(t, m, s, o, pixels):
    """The values of `screen_alpha`."""
    shape = (len(m), len(pixels))
    return t.call("adapters.screen_alpha", m, s, o, pixels, returns=Array(shape))


def taken_back(t, m, s, o, pixels, g):
    """What the `back` of `screen_alpha` returns."""
    parts = Items(
        Array(m.shape),
        Array(s.shape),
        Array(o.shape),
        Array(m.shape),
        names=("d_mean2d", "d_cov2d", "d_opacity_logits", "pull"),
    )
    return t.call("adapters.screen_alpha_back", m, s, o, pixels, g, returns=parts)


def wide_splats(rng, n, p):
    """Splats that all pixels see, neither held nor dropped; (mean2d, cov2d, logits, pixels)."""
    s = rng.uniform(8.0, 14.0, (n, 3))
    s[:, 1] = rng.uniform(-4.0, 4.0, n)
    return rng.uniform(0.0, 4.0, (n, 2)), s, rng.uniform(0.0, 2.0, n), rng.uniform(0.0, 4.0, (p, 2))


@check(
    "15.3.round",
    task="15.3",
    points=2,
    calls=("screen_alpha",),
    tolerance=EXACT,
    hint="handout, equations (15) to (18), for a round splat",
    sole="small enough to work out by hand",
)
def a_round_splat(t):
    """In its middle alpha is the opacity, at a known distance half of it, and LOW_PASS counts."""
    logits = t.rng.uniform(-1.0, 1.0, 3)
    m, wide = t.rng.uniform(0.0, 9.0, (3, 2)), t.rng.uniform(0.0, 4.0, 3)
    s = np.stack([wide, 0 * wide, wide], axis=1)
    phi, o = t.rng.uniform(0.0, 6.0, 3), 1 / (1 + np.exp(-logits))
    far = np.sqrt(2 * np.log(2) * (wide + 0.3))
    there = m + far[:, None] * np.stack([np.cos(phi), np.sin(phi)], axis=1)
    t.close("alpha in the middle", np.diag(taken(t, m, s, logits, m)), o, reveal=True)
    t.close("alpha at half", np.diag(taken(t, m, s, logits, there)), o / 2, reveal=True)


@check(
    "15.3.ellipse",
    task="15.3",
    points=2,
    calls=("screen_alpha",),
    tolerance=EXACT,
    hint="handout, equations (16) and (17): the inverse swaps xx and yy; B dx dy stands outside "
    "of the 1/2; or dx and dy have different signs",
    sole="says whether the conic belongs to the covariance",
)
def on_an_ellipse_alpha_is_the_same(t):
    """On the ellipse of k standard deviations, alpha is the opacity times exp(-k^2 / 2)."""
    m, s, logits, _ = wide_splats(t.rng, 1, 1)
    full = s[0, [0, 1, 1, 2]].reshape(2, 2) + 0.3 * np.eye(2)
    phi, k = np.linspace(0.1, 6.0, 9), t.rng.uniform(0.5, 2.5)
    ring = m + k * np.stack([np.cos(phi), np.sin(phi)], axis=1) @ np.linalg.cholesky(full).T
    expected = np.exp(-(k**2) / 2) / (1 + np.exp(-logits[0]))
    t.close("alpha", taken(t, m, s, logits, ring), np.full((1, 9), expected), reveal=True)


@check(
    "15.3.cuts",
    task="15.3",
    points=2,
    calls=("screen_alpha",),
    adjoints=("screen_alpha",),
    tolerance=EXACT,
    hint="handout, equation (18): below ALPHA_MIN nothing, never above ALPHA_MAX; both are flat",
    sole="names the cut-off, and whether its derivative is 0",
)
def cut_offs(t):
    """What is below 1 / 255 is exactly 0, what is above 0.999 is held, and neither moves."""
    m, s = t.rng.uniform(0.0, 9.0, (1, 2)), np.array([[4.0, 0.0, 4.0]])
    for logit, alpha, expected in (
        (0.0, 0.0037, 0.0),
        (0.0, 0.0042, 0.0042),
        (9.0, 0.9993, 0.999),
        (9.0, 0.9985, 0.9985),
    ):
        o = 1 / (1 + np.exp(-logit))
        pixel = m + np.array([np.sqrt(2 * 4.3 * np.log(o / alpha)), 0.0])
        got = taken(t, m, s, np.array([logit]), pixel)
        t.close(f"alpha where o G = {alpha}", got, [[expected]], reveal=True)
        d_m, d_s, d_o, pull = taken_back(t, m, s, np.array([logit]), pixel, np.ones((1, 1)))
        for name, d in (("mean2d", d_m), ("cov2d", d_s), ("opacity_logits", d_o), ("pull", pull)):
            moves = bool(d.any())
            t.require(
                moves == (alpha == expected),
                f"d_{name} where o G = {alpha}: must {'not ' * (alpha == expected)}be 0",
            )


@check(
    "15.3.differences",
    task="15.3",
    points=4,
    calls=("screen_alpha",),
    adjoints=("screen_alpha",),
    tolerance=GATE,
    hint="handout, equations (19) and (20): derivatives by A, B, C or by the covariance, each "
    "with its own count of B; the slope of oG by the logit is oG (1 - o)",
    sole="the derivative itself, without the reference",
)
def alpha_agrees_with_differences(t):
    """Moving a splat, its covariance or its logit moves alpha as your back says."""
    m, s, o, pixels = wide_splats(t.rng, 4, 6)
    m[1] += 90.0  # not seen at all
    o[2], pixels[0] = 9.0, m[2] + 0.02  # held in one pixel
    g = random_cotangent(t.rng, (4, 6))
    d_m, d_s, d_o, _ = taken_back(t, m, s, o, pixels, g)

    def forward(point):
        return taken(t, point["mean2d"], point["cov2d"], point["opacity_logits"], pixels)

    found = {"opacity_logits": d_o, "mean2d": d_m, "cov2d": d_s}
    require_gradients(t, found, forward, {"mean2d": m, "cov2d": s, "opacity_logits": o}, g, GATE)
    names = ("mean2d", "cov2d", "opacity_logits", "pull")
    require_zero_for_zero(t, dict(zip(names, taken_back(t, m, s, o, pixels, 0 * g), strict=True)))


@check(
    "15.3.pull",
    task="15.3",
    points=2,
    calls=("screen_alpha",),
    adjoints=("screen_alpha",),
    tolerance=EXACT,
    hint="handout, equation (21): absolute values first, then the sum over pixels",
    sole="asks about pull alone",
)
def pull_does_not_cancel(t):
    """pull is the sum over pixels of the size of what each alone adds to d_mean2d."""
    m, s, o, pixels = wide_splats(t.rng, 3, 5)
    g = random_cotangent(t.rng, (3, 5))
    d_m, _, _, pull = taken_back(t, m, s, o, pixels, g)
    alone = [taken_back(t, m, s, o, pixels[k : k + 1], g[:, k : k + 1])[0] for k in range(5)]
    t.close("the sum of single pixels", np.sum(alone, axis=0), d_m)
    t.close("pull", pull, np.sum(np.abs(alone), axis=0))


# 15.4 ---------------------------------------------------------------------------------------------


def blended(t, a, c, z, b):
    """The values of `composite`."""
    return t.call("adapters.composite", a, c, z, b, returns=Array((a.shape[1], 3)))


def blended_back(t, a, c, z, b, g):
    """What the `back` of `composite` returns."""
    parts = Items(
        Array(a.shape), Array(c.shape), Array((3,)), names=("d_alpha", "d_colors", "d_background")
    )
    return t.call("adapters.composite_back", a, c, z, b, g, returns=parts)


def layers(rng, n, p):
    """Splats in no order, here and there unseen; (alpha, colors, depth, background)."""
    a = rng.uniform(0.1, 0.9, (n, p))
    a[rng.random((n, p)) < 0.3] = 0.0
    return a, rng.uniform(0.0, 1.0, (n, 3)), 1.0 + rng.permutation(n) / 3, rng.uniform(0.0, 1.0, 3)


@check(
    "15.4.layers",
    task="15.4",
    points=2,
    calls=("composite",),
    tolerance=EXACT,
    hint="handout, equation (22): T is what all splats in front let through, not this one",
    sole="small enough to work out by hand",
)
def known_layers(t):
    """Nothing shows the background; one splat mixes; of equal depth the first row is in front.

    Many rows of few depths: with three rows a sort that is not stable may look as if it were.
    """
    c, b = t.rng.uniform(0.0, 1.0, (3, 3)), t.rng.uniform(0.0, 1.0, 3)
    a = np.array([[0.0, 0.75, 0.5], [0.0, 0.0, 0.5], [0.0, 0.0, 0.2]])
    expected = [b, 0.75 * c[0] + 0.25 * b, 0.2 * c[2] + 0.4 * c[0] + 0.2 * c[1] + 0.2 * b]
    t.close("shown", blended(t, a, c, np.array([2.0, 2.0, 1.0]), b), expected, reveal=True)
    solid = np.array([[0.999], [0.5]])
    got = blended(t, solid, np.ones((2, 3)), np.array([1.0, 2.0]), np.ones(3))
    t.close("white before white", got, np.ones((1, 3)), reveal=True)
    nothing = blended(t, np.zeros((0, 2)), np.zeros((0, 3)), np.zeros(0), b)
    t.close("no splat at all", nothing, np.stack([b, b]), reveal=True)
    z, behind = np.arange(60) % 3 + 1.0, b
    a, c = t.rng.uniform(0.05, 0.15, (60, 1)), t.rng.uniform(0.0, 1.0, (60, 3))
    for k in (*range(59, 0, -3), *range(58, 0, -3), *range(57, -1, -3)):
        behind = a[k] * c[k] + (1 - a[k]) * behind
    t.close("60 rows at three depths", blended(t, a, c, z, b), behind[None], reveal=True)


@check(
    "15.4.order",
    task="15.4",
    points=3,
    calls=("composite",),
    adjoints=("composite",),
    tolerance=EXACT,
    hint="sort by depth inside; back must undo the sorting",
    sole="needs no formula: the list's order means nothing",
)
def the_order_of_the_list_does_not_matter(t):
    """Splats in another order give the same pixels, and derivatives in that other order."""
    a, c, z, b = layers(t.rng, 7, 5)
    g, other = random_cotangent(t.rng, (5, 3)), t.rng.permutation(7)
    t.close("shown", blended(t, a[other], c[other], z[other], b), blended(t, a, c, z, b))
    d_a, d_c, d_b = blended_back(t, a, c, z, b, g)
    moved = blended_back(t, a[other], c[other], z[other], b, g)
    t.close("d_alpha", moved[0], d_a[other])
    t.close("d_colors", moved[1], d_c[other])
    t.close("d_background", moved[2], d_b)


@check(
    "15.4.differences",
    task="15.4",
    points=4,
    calls=("composite",),
    adjoints=("composite",),
    tolerance=GATE,
    hint="handout, equations (23) to (25): what is behind a splat is seen less when it grows",
    sole="the derivative itself, without the reference",
)
def blending_agrees_with_differences(t):
    """Moving an alpha, a color or the background moves the pixels as your back says."""
    a, c, z, b = layers(t.rng, 6, 4)
    a[t.rng.integers(6), :2] = 0.999
    g = random_cotangent(t.rng, (4, 3))
    d_a, d_c, d_b = blended_back(t, a, c, z, b, g)

    def forward(point):
        return blended(t, point["alpha"], point["colors"], z, point["background"])

    found = {"background": d_b, "colors": d_c, "alpha": d_a}
    require_gradients(t, found, forward, {"alpha": a, "colors": c, "background": b}, g, GATE)
    names = ("alpha", "colors", "background")
    require_zero_for_zero(t, dict(zip(names, blended_back(t, a, c, z, b, 0 * g), strict=True)))


# 15.5 ---------------------------------------------------------------------------------------------

EARLIER = ("covariance", "project", "screen_alpha", "composite")


def shown(t, scene, camera, pixels, b):
    """The values of `render`."""
    shape = (len(pixels), 3)
    return t.call("adapters.render", scene, camera, pixels, b, returns=Array(shape))


def shown_back(t, scene, camera, pixels, b, g):
    """What the `back` of `render` returns."""
    shapes_of = {name: Array(array.shape) for name, array in scene.items()}
    record = Record(
        {**shapes_of, "background": Array((3,)), "pull": Array((len(scene["means"]), 2))}
    )
    return t.call("adapters.render_back", scene, camera, pixels, b, g, returns=record)


def some_scene(rng, camera, n, size=0.8):
    """Gaussians that the middle of the picture sees, none of them held or dropped there."""
    return {
        "means": in_world(camera, ahead(rng, n) * [0.5, 0.5, 1]),
        "log_scales": np.log(size) + rng.uniform(-0.3, 0.3, (n, 3)),
        "quats": rng.normal(size=(n, 4)),
        "opacity_logits": rng.uniform(-1.0, 1.0, n),
        "colors": rng.uniform(0.0, 1.0, (n, 3)),
    }


def middle_pixels(rng, camera, p):
    """Places near the middle of the picture, (p, 2)."""
    return camera["center"] + rng.uniform(-2.5, 2.5, (p, 2))


@check(
    "15.5.one",
    task="15.5",
    points=2,
    calls=("render",),
    needs=EARLIER,
    tolerance=EXACT,
    hint="handout, equation (26): the four stages in their order; the camera's depth sorts",
    sole="small enough to work out by hand",
)
def one_splat_straight_ahead(t):
    """A ball straight ahead is a round splat, and a nearer one lies over it, whichever is first."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    z = np.array([3.0, 2.0])
    scene = some_scene(t.rng, camera, 2)
    scene["means"] = in_world(camera, z[:, None] * [0.0, 0.0, 1.0])
    scene["log_scales"] = np.repeat(t.rng.uniform(-1.5, -1.0, (2, 1)), 3, axis=1)
    pixels = middle_pixels(t.rng, camera, 4)
    wide = (camera["focal"] * np.exp(scene["log_scales"][:, :2]) / z[:, None]) ** 2 + 0.3
    r = np.sum((pixels - camera["center"]) ** 2 / wide[:, None], axis=2)
    a = np.exp(-r / 2) / (1 + np.exp(-scene["opacity_logits"][:, None]))
    far, near = a[..., None] * scene["colors"][:, None]
    behind = far + (1 - a[0, :, None]) * b
    t.require(bool((a > 0.01).all()), "the case is not telling")
    got = shown(t, scene, camera, pixels, b)
    t.close("shown", got, near + (1 - a[1, :, None]) * behind, reveal=True)


@check(
    "15.5.differences",
    task="15.5",
    points=4,
    calls=("render",),
    needs=EARLIER,
    tolerance=GATE,
    hint="handout, equation (27): the stages backwards, each with what the one after it returns",
    sole="the whole chain, group by group, without the reference",
)
def the_chain_agrees_with_differences(t):
    """Moving any number of a scene moves its pixels as your back says; one Gaussian is outside."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    scene = some_scene(t.rng, camera, 4)
    # Beside the picture and beyond the limits, but large enough to be seen.
    scene["means"][1] = in_world(camera, np.array([[1.1, -0.2, 1.0]]) * 3.05)[0]
    scene["log_scales"][1] += np.log(4)
    pixels = middle_pixels(t.rng, camera, 5)
    g = random_cotangent(t.rng, (5, 3))
    got = shown_back(t, scene, camera, pixels, b, g)

    def forward(point):
        some = {name: point[name] for name in SCENE}
        return shown(t, some, camera, pixels, point["background"])

    found = {name: got[name] for name in (*reversed(SCENE), "background")}
    require_gradients(t, found, forward, {**scene, "background": b}, g, GATE)
    none = shown_back(t, scene, camera, pixels, b, 0 * g)
    require_zero_for_zero(t, none)


@check(
    "15.5.behind",
    task="15.5",
    points=1,
    calls=("render",),
    needs=EARLIER,
    tolerance=EXACT,
    hint="leave out what is not farther than NEAR in front, and give its rows zeros",
    sole="asks about culling alone",
)
def what_is_behind_the_camera_has_no_part(t):
    """Gaussians behind the camera or too near change nothing, and their derivatives are 0."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    scene = some_scene(t.rng, camera, 5)
    hidden, kept = [1, 3], [0, 2, 4]
    scene["means"][hidden] = in_world(camera, np.array([[0.1, 0.2, -2.0], [0.001, 0.0, 0.009]]))
    few = {name: array[kept] for name, array in scene.items()}
    pixels, g = middle_pixels(t.rng, camera, 4), random_cotangent(t.rng, (4, 3))
    t.close("shown", shown(t, scene, camera, pixels, b), shown(t, few, camera, pixels, b))
    got = shown_back(t, scene, camera, pixels, b, g)
    right = shown_back(t, few, camera, pixels, b, g)
    for name in (*SCENE, "pull"):
        t.require(not got[name][hidden].any(), f"d_{name}: not zero behind the camera")
        t.close(f"d_{name} of the others", got[name][kept], right[name])
    t.close("d_background", got["background"], right["background"])
    none = {name: array[hidden] for name, array in scene.items()}
    t.close("shown, of none", shown(t, none, camera, pixels, b), np.tile(b, (4, 1)), reveal=True)


# 15.6 ---------------------------------------------------------------------------------------------


def denser(t, scene, pressure, seed, most, count, adapter="densify"):
    """What `densify` returns, as a dict and the sources."""
    parts = [Array((count, *scene[name].shape[1:])) for name in SCENE]
    got = t.call(
        f"adapters.{adapter}",
        scene,
        pressure,
        seed,
        most,
        returns=Items(*parts, Array((count,)), names=(*SCENE, "source")),
    )
    return dict(zip(SCENE, got[:5], strict=True)), got[5]


def eight(rng):
    """Faint or not, small or large, pressed or not: (scene, pressure)."""
    scene = {
        "means": rng.normal(size=(8, 3)),
        "quats": rng.normal(size=(8, 4)),
        "log_scales": np.log(0.03) + rng.uniform(-0.2, 0.2, (8, 3)),
        "opacity_logits": rng.uniform(-1.0, 3.0, 8),
        "colors": rng.uniform(0.0, 1.0, (8, 3)),
    }
    # Row 2: the longest scale is above SMALL = 0.06, the mean of the three below.
    scene["log_scales"][[2, 3, 7], rng.integers(0, 3, 3)] += [1.0, 2.0, 2.0]
    scene["opacity_logits"][[0, 4]] = -5.0
    return scene, np.array([0.9, 3, 5, 1, 0, 8, 1.9, 4]) / 1000


@check(
    "15.6.rows",
    task="15.6",
    points=2,
    calls=("densify",),
    needs=("covariance",),
    tolerance=EXACT,
    hint="handout, equations (28) to (30): first those that stay, then clones, then parts "
    "twice; work on copies",
    sole="asks which rows there are, and nothing of their values",
)
def who_stays_and_who_is_new(t):
    """Faint ones go, small pressed ones are cloned, large pressed ones split, in a fixed order."""
    scene, pressure = eight(t.rng)
    got, source = denser(t, scene, pressure, 1, 100, 10)
    rows = [1, 3, 5, 6, 1, 5, 2, 7, 2, 7]
    t.close("colors", got["colors"], scene["colors"][rows], reveal=True)
    t.close("quats", got["quats"], scene["quats"][rows])
    t.close("source", source, [1, 3, 5, 6, -1, -1, -1, -1, -1, -1], reveal=True)
    again = denser(t, scene, pressure, 1, 100, 10, adapter="densify_again")
    t.require(agree(again, (got, source)), "densify has written into an array that it was given")


@check(
    "15.6.values",
    task="15.6",
    points=2,
    calls=("densify",),
    needs=("covariance",),
    tolerance=EXACT,
    hint="handout, equations (31) and (32). log-scales: minus log(SHRINK); places: L z with L "
    "of the whole",
    sole="asks about the values of new rows",
)
def clones_keep_the_middle_and_parts_are_drawn(t):
    """Two clones cover as one did; parts are smaller by 1.6, at places drawn from the whole."""
    scene, pressure = eight(t.rng)
    seed = int(t.rng.integers(1 << 20))
    got, _ = denser(t, scene, pressure, seed, 100, 10)
    rows, new = [1, 3, 5, 6, 1, 5, 2, 7, 2, 7], [6, 7, 8, 9]
    through = 1 / (1 + np.exp(got["opacity_logits"]))
    before = 1 / (1 + np.exp(scene["opacity_logits"][rows]))
    both = through.copy()
    both[[0, 2]] = through[[0, 2]] * through[[4, 5]]
    both[[4, 5]] = both[[0, 2]]
    t.close(
        "what rows let through (original and clone together; parts keep their opacity)",
        both,
        before,
        reveal=True,
    )
    t.close("opacity of a clone", through[[4, 5]], through[[0, 2]])
    scales = scene["log_scales"][rows]
    scales[new] -= np.log(1.6)
    t.close("log_scales", got["log_scales"], scales, reveal=True)
    t.close("means of the others", got["means"][:6], scene["means"][rows[:6]])
    whole = spread(t, scene["quats"][[2, 7, 2, 7]], scene["log_scales"][[2, 7, 2, 7]])
    off = got["means"][6:] - scene["means"][[2, 7, 2, 7]]
    draws = [
        np.linalg.solve(np.linalg.cholesky(each), d) for each, d in zip(whole, off, strict=True)
    ]
    expected = np.random.default_rng(seed).standard_normal((4, 3))
    t.close("places of parts, in standard deviations", np.stack(draws), expected, reveal=True)


@check(
    "15.6.most",
    task="15.6",
    points=1,
    calls=("densify",),
    needs=("covariance",),
    tolerance=EXACT,
    hint="each chosen one makes one more; the highest pressure goes first. Faint ones leave "
    "first: room is `most` minus the number that stay",
    sole="asks about the budget alone",
)
def never_more_than_most(t):
    """With room for two more, the two under the highest pressure are chosen; with none, nobody."""
    scene, pressure = eight(t.rng)
    got, source = denser(t, scene, pressure, 1, 8, 8)
    t.close("colors", got["colors"], scene["colors"][[1, 3, 5, 6, 7, 5, 2, 2]], reveal=True)
    t.close("source", source, [1, 3, 5, 6, 7, -1, -1, -1], reveal=True)
    got, source = denser(t, scene, pressure, 1, 5, 6)
    t.close("source without room", source, [1, 2, 3, 5, 6, 7], reveal=True)
    t.close(
        "logits without room", got["opacity_logits"], scene["opacity_logits"][[1, 2, 3, 5, 6, 7]]
    )


# >>> hidden
def turned_shapes(t, n):
    """What `covariance` takes."""
    return 3 * t.rng.normal(size=(n, 4)), t.rng.uniform(-2.0, 1.0, (n, 3))


def projected(t, n):
    """What `project` takes."""
    camera = some_camera(t.rng)
    return in_world(camera, ahead(t.rng, n)), shapes(t.rng, n), camera


def pictured(t, n):
    """What `render` takes: five Gaussians, n pixels."""
    camera = some_camera(t.rng)
    pixels, background = middle_pixels(t.rng, camera, n), t.rng.uniform(0.0, 1.0, 3)
    return some_scene(t.rng, camera, 5), camera, pixels, background


def pulled(t, n):
    """What the `back` of `project` takes, after what `project` takes."""
    return *projected(t, n), t.rng.normal(size=(n, 2)), t.rng.normal(size=(n, 3))


def values(name):
    """The right values, without the `back` behind them."""
    return lambda reference, *args: getattr(reference, name)(*args)[0]


def derivatives(name):
    """What the right `back` makes of the last argument."""
    return lambda reference, *args: getattr(reference, name)(*args[:-1])[-1](args[-1])


class Changed:
    """Five arrays of a scene and the rows that they come from; how many is not known beforehand."""

    def require(self, value, where):
        if not isinstance(value, list) or not all(isinstance(e, np.ndarray) for e in value):
            raise CheckFailed(f"{where}: expected a scene and the rows that its own come from")


def crowded(t, n):
    """What `densify` takes, with a seed."""
    scene = some_scene(t.rng, some_camera(t.rng), n, size=0.05)
    return scene, t.rng.exponential(0.003, n), 7, 1000


@check(
    "15.1.hidden",
    task="15.1",
    points=3,
    calls=("covariance",),
    adjoints=("covariance",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[
        Subject(
            "adapters.covariance",
            turned_shapes,
            lambda n: Array((n, 3, 3)),
            right=values("covariance"),
            rows=(0, 1),
        ),
        Subject(
            "adapters.covariance_back",
            lambda t, n: (*turned_shapes(t, n), t.rng.normal(size=(n, 3, 3))),
            lambda n: Items(Array((n, 4)), Array((n, 3))),
            right=derivatives("covariance"),
            rows=(0, 1, 2),
        ),
    ],
)
def random_shapes(t):
    """Values and both derivatives are right for random Gaussians."""
    q, s = 3 * t.rng.normal(size=(9, 4)), t.rng.uniform(-2.0, 1.0, (9, 3))
    g = random_cotangent(t.rng, (9, 3, 3))
    cov, pullback = t.reference.covariance(q, s)
    t.close("cov", spread(t, q, s), cov)
    got = spread_back(t, q, s, g)
    for name, mine, theirs in zip(("d_quats", "d_log_scales"), got, pullback(g), strict=True):
        t.close(name, mine, theirs)


@check(
    "15.2.hidden",
    task="15.2",
    points=3,
    calls=("project",),
    adjoints=("project",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[
        Subject(
            "adapters.project",
            projected,
            lambda n: Items(Array((n, 2)), Array((n, 3)), Array((n,))),
            right=lambda ref, *args: ref.project(*args)[:3],
            rows=(0, 1),
        ),
        Subject(
            "adapters.project_back",
            pulled,
            lambda n: Items(Array((n, 3)), Array((n, 3, 3))),
            rows=(0, 1, 3, 4),
            has_right=False,
        ),
    ],
)
def random_projections(t):
    """Values and both derivatives are right, inside of the limits and outside."""
    camera = some_camera(t.rng)
    side = np.concatenate([t.rng.uniform(-0.4, 0.4, (4, 2)), outside(t.rng, camera, 1.5)])
    z = t.rng.uniform(0.5, 4.0, (12, 1))
    means = in_world(camera, np.concatenate([side * z, z], axis=1))
    cov, g = shapes(t.rng, 12), random_cotangent(t.rng, (12, 5))
    *right, pullback = t.reference.project(means, cov, camera)
    for name, mine, theirs in zip(
        ("mean2d", "cov2d", "depth"), seen(t, means, cov, camera), right, strict=True
    ):
        t.close(name, mine, theirs)
    d_means, d_cov = seen_back(t, means, cov, camera, g)
    right = pullback(g[:, :2], g[:, 2:])
    t.close("d_means", d_means, right[0])
    t.close("d_cov", folded(d_cov), folded(right[1]))


@check(
    "15.3.hidden",
    task="15.3",
    points=2,
    calls=("screen_alpha",),
    adjoints=("screen_alpha",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[
        Subject(
            "adapters.screen_alpha",
            lambda t, n: wide_splats(t.rng, n, 4),
            lambda n: Array((n, 4)),
            right=values("screen_alpha"),
            rows=(0, 1, 2),
        ),
        Subject(
            "adapters.screen_alpha_back",
            lambda t, n: (*wide_splats(t.rng, n, 4), t.rng.normal(size=(n, 4))),
            lambda n: Items(Array((n, 2)), Array((n, 3)), Array((n,)), Array((n, 2))),
            right=derivatives("screen_alpha"),
            rows=(0, 1, 2, 4),
        ),
    ],
)
def random_splats(t):
    """Values and derivatives are right for splats of all kinds, cut off here and there."""
    n, pixels = 12, t.rng.uniform(0.0, 16.0, (40, 2))
    m, half = t.rng.uniform(-2.0, 18.0, (n, 2)), t.rng.normal(size=(n, 2, 2)) * 2
    full = half @ half.swapaxes(1, 2)
    s, o = full[:, [0, 0, 1], [0, 1, 1]], t.rng.uniform(-3.0, 8.0, n)
    pixels[:2] = m[:2] + 0.01
    o[:2] = 9.0
    g = random_cotangent(t.rng, (n, 40))
    alpha, pullback = t.reference.screen_alpha(m, s, o, pixels)
    t.close("alpha", taken(t, m, s, o, pixels), alpha)
    got = taken_back(t, m, s, o, pixels, g)
    names = ("d_mean2d", "d_cov2d", "d_opacity_logits", "pull")
    for name, mine, theirs in zip(names, got, pullback(g), strict=True):
        t.close(name, mine, theirs)


@check(
    "15.4.hidden",
    task="15.4",
    points=3,
    calls=("composite",),
    adjoints=("composite",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[
        Subject(
            "adapters.composite",
            lambda t, n: layers(t.rng, n, 3),
            lambda _: Array((3, 3)),
            right=values("composite"),
            sizes=(1, 2, 40),
        ),
        Subject(
            "adapters.composite_back",
            lambda t, n: (*layers(t.rng, n, 3), t.rng.normal(size=(3, 3))),
            lambda n: Items(Array((n, 3)), Array((n, 3)), Array((3,))),
            right=derivatives("composite"),
            sizes=(1, 2, 40),
        ),
    ],
)
def random_layers(t):
    """Values and derivatives are right for many layers."""
    a, c, z, b = layers(t.rng, 20, 9)
    z = np.floor(z)  # seven depths
    g = random_cotangent(t.rng, (9, 3))
    right, pullback = t.reference.composite(a, c, z, b)
    t.close("shown", blended(t, a, c, z, b), right)
    got = blended_back(t, a, c, z, b, g)
    names = ("d_alpha", "d_colors", "d_background")
    for name, mine, theirs in zip(names, got, pullback(g), strict=True):
        t.close(name, mine, theirs)


@check(
    "15.5.hidden",
    task="15.5",
    points=2,
    calls=("render",),
    needs=EARLIER,
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at unknown scenes, and what the way back costs",
    battery=[
        Subject(
            "adapters.render", pictured, lambda n: Array((n, 3)), right=values("render"), rows=(2,)
        )
    ],
)
def random_scenes(t):
    """Pixels of 150 Gaussians and their derivatives are right, at the price of a few pictures."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    scene = some_scene(t.rng, camera, 150, size=0.15)
    t0 = ahead(t.rng, 150) * [2.5, 2.5, 1] - [0, 0, 5.0]
    scene["means"] = in_world(camera, t0)
    scene["opacity_logits"] *= 3
    pixels = t.rng.uniform(0.0, 1.0, (24, 2)) * [20, 14]
    g = random_cotangent(t.rng, (24, 3))
    right, pullback = t.reference.render(scene, camera, pixels, b)
    t.close("shown", shown(t, scene, camera, pixels, b), right)
    got = shown_back(t, scene, camera, pixels, b, g)
    for name, theirs in pullback(g).items():
        t.close(f"d_{name}", got[name], theirs)
    record = Record({name: Array(array.shape) for name, array in got.items()})
    require_cheap(
        t,
        ("adapters.render", (scene, camera, pixels, b), Array(g.shape)),
        ("adapters.render_back", (scene, camera, pixels, b, g), record),
    )


@check(
    "15.6.hidden",
    task="15.6",
    points=1,
    calls=("densify",),
    needs=("covariance",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at scenes that are not known beforehand",
    battery=[Subject("adapters.densify", crowded, lambda _: Changed(), has_right=False)],
)
def random_changes(t):
    """Random scenes become what they should."""
    for most in (1000, 45):
        scene = {
            "means": t.rng.normal(size=(40, 3)),
            "quats": t.rng.normal(size=(40, 4)),
            "log_scales": np.log(0.05) + t.rng.normal(size=(40, 3)) / 3,
            "opacity_logits": t.rng.uniform(-6.0, 6.0, 40),
            "colors": t.rng.normal(size=(40, 3)),
        }
        # Opacities of 0.0202 and 0.0198, on both sides of FAINT.
        scene["opacity_logits"][:2] = np.log([0.0202 / 0.9798, 0.0198 / 0.9802])
        pressure, seed = t.rng.exponential(0.003, 40), int(t.rng.integers(1 << 20))
        pressure = np.array([0.001, 0.003, 0.006])[np.digitize(pressure, [0.0015, 0.004])]
        given = np.random.default_rng(seed)
        right, source = t.reference.densify(scene, pressure, given, most)
        got, told = denser(t, scene, pressure, seed, most, len(source))
        for name in SCENE:
            t.close(name, got[name], right[name])
        t.close("source", told, source)


def striped_picture(size):
    """What no four Gaussians can show: stripes and a disc; (size, size, 3)."""
    y, x = np.mgrid[0:size, 0:size] / size
    stripes = 0.5 + 0.5 * np.sign(np.sin(2 * np.pi * 2 * (x + 0.3 * y)))
    disc = np.hypot(x - 0.6, y - 0.4) < 0.25
    return np.where(disc[..., None], [0.9, 0.3, 0.1], stripes[..., None] * [0.2, 0.6, 0.9])


@check(
    "15.6.gain",
    task="15.6",
    points=4,
    calls=("densify",),
    needs=(*EARLIER, "render"),
    visibility="hidden",
    seconds=60.0,
    sole="the whole: what more Gaussians are good for",
)
def denser_is_better(t):
    """Stripes that four Gaussians cannot show are at least 2 dB better with up to forty."""
    size = 16
    camera = {
        "camera_from_world": np.eye(4)[:3],
        "focal": np.full(2, 16.0),
        "center": np.full(2, 8.0),
        "width": size,
        "height": size,
    }
    places = np.array([[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]])
    start = {
        "means": np.concatenate([places, np.full((4, 1), 2.0)], axis=1)
        + t.rng.uniform(-0.1, 0.1, (4, 3)),
        "log_scales": np.full((4, 3), np.log(0.25)),
        "quats": np.tile([1.0, 0, 0, 0], (4, 1)),
        "opacity_logits": np.zeros(4),
        "colors": np.full((4, 3), 0.5),
    }
    views = [[camera, striped_picture(size)]]
    seed, losses = int(t.rng.integers(1 << 20)), []
    for most in (0, 40):
        found = t.call(
            "adapters.fitted", start, views, 120, seed, np.zeros(3), most, returns=Array((120,))
        )
        losses.append(max(float(found[-5:].mean()), 1e-30))
    gain = 10 * np.log10(losses[0] / losses[1])
    t.require(gain >= 2.0, f"with densify the fit is {gain:.1f} dB better, asked 2 dB")
    t.require(losses[1] < 0.5 * found[0], "the fit hardly improves the picture")


# <<< hidden

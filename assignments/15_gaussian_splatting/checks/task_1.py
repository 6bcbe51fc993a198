"""Task 15.1, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, GATE, spread

check = checks_for(calls=("covariance",), tolerance=EXACT)


def floored(size, tolerance=EXACT):
    """A tolerance for values that may cancel: relative to a size, not to what is left."""
    return Tolerance(tolerance.relative, tolerance.evidence, floor=float(size))


def spread_back(t, q, s, g):
    """Result of the `back` of `covariance`."""
    parts = Items(Array(q.shape), Array(s.shape), names=("d_quats", "d_log_scales"))
    return t.call("adapters.covariance_back", q, s, g, returns=parts)


@check(
    "15.1.axes",
    points=2,
    hint="handout, equations (6) to (8): w turns nothing, (x, y, z) is the axis",
    sole="small enough to work out by hand",
)
def known_turns(t):
    """Unrotated the scales lie on the axes; about z by an angle, xx, xy, yy are known."""
    s = t.rng.uniform(-1.0, 1.0, (1, 3))
    a, b, c = np.exp(2 * s[0])
    plain = spread(t, np.array([[1.0, 0.0, 0.0, 0.0]]), s)
    t.close("cov, unrotated", plain[0], np.diag([a, b, c]), reveal=True)
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
    points=2,
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
    points=4,
    adjoints=("covariance",),
    tolerance=GATE,
    hint="handout, section 1, steps 1 to 4; d_cov need not be symmetric",
    sole="the derivative itself, without the reference",
)
def the_shape_agrees_with_differences(t):
    """Moving q or a scale moves your covariance as your back says, for each of the two."""
    q, s = t.rng.normal(size=(3, 4)), t.rng.uniform(-0.7, 0.7, (3, 3))
    g = random_cotangent(t.rng, (3, 3, 3))
    d_q, d_s = spread_back(t, q, s, g)

    def forward(point):
        return spread(t, point["quats"], point["log_scales"])

    found = {"log_scales": d_s, "quats": d_q}
    agrees_with_finite_differences(t, found, forward, {"quats": q, "log_scales": s}, g, GATE)
    none = spread_back(t, q, s, 0 * g)
    require_zero_for_zero(t, {"quats": none[0], "log_scales": none[1]})


@check(
    "15.1.length",
    points=1,
    adjoints=("covariance",),
    hint="handout, equation (5): a longer q alone changes nothing",
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

"""Task 11.1, public checks."""

import numpy as np
from photograd_course.grading import Tolerance, checks_for
from photograd_course.grading.generators import random_rotation, unit_vectors

from .common import EXACT, band, basis, sphere

check = checks_for(calls=("sh_basis",))

ORTHONORMAL = Tolerance(
    1e-10, "right ones leave 2e-15, the nearest wrong one (root_two_everywhere) more than 0.01"
)


@check(
    "11.1.first",
    points=2,
    tolerance=EXACT,
    hint="handout, equations (5) to (8) for l = 0 and 1; the order is m = -1, 0, 1",
    sole="small enough to compare by eye",
)
def the_first_four(t):
    """Degree 0 is 0.2821 everywhere; degree 1 is 0.4886 times (-y, z, -x)."""
    d = unit_vectors(t.rng, 6)
    t.close("degree 0", basis(t, d, 0), np.full((6, 1), 0.5 / np.sqrt(np.pi)), reveal=True)
    expected = np.sqrt(3 / (4 * np.pi)) * d[:, [1, 2, 0]] * [-1, 1, -1]
    t.close("degree 1", basis(t, d, 1)[:, 1:], expected, reveal=True)


@check(
    "11.1.addition",
    points=3,
    tolerance=EXACT,
    hint="handout, equations (7) and (8): the polynomial in z, the size of each harmonic",
    sole="names the degree in which sizes or polynomials are wrong",
)
def harmonics_of_a_degree_add_up(t):
    """Products of one degree's harmonics at two directions depend on the angle between them."""
    a, b = unit_vectors(t.rng, 20), unit_vectors(t.rng, 20)
    Ya, Yb = basis(t, a, 4), basis(t, b, 4)
    for ell in range(5):
        same = np.sum(Ya[:, band(ell)] ** 2, axis=1)
        t.close(
            f"sum of squares, degree {ell}",
            same,
            np.full(20, (2 * ell + 1) / (4 * np.pi)),
            reveal=True,
        )
        legendre = np.polynomial.legendre.legval(np.sum(a * b, axis=1), np.eye(5)[ell])
        t.close(
            f"sum of products, degree {ell}",
            np.sum((Ya * Yb)[:, band(ell)], axis=1),
            legendre * (2 * ell + 1) / (4 * np.pi),
        )


@check(
    "11.1.gram",
    points=3,
    tolerance=ORTHONORMAL,
    hint="the integral of two harmonics' product is 1 for a pair of equals, else 0",
    sole="what all the rest is built on",
)
def harmonics_are_orthonormal(t):
    """Under a quadrature that is exact to degree 8, all 25 are orthonormal."""
    d, weights = sphere(8)
    Y = basis(t, d @ random_rotation(t.rng), 4)
    t.close("integrals of products", Y.T @ (weights[:, None] * Y), np.eye(25))


@check(
    "11.1.signs",
    points=4,
    hint="column l (l + 1) + m; m > 0 has the real part, m < 0 the other",
    sole="says which column or sign is wrong, where sums of squares see nothing",
)
def order_and_signs(t):
    """Near the pole, signs and zeros say which column is which."""
    theta = t.rng.uniform(0.2, 0.35)
    size = float(t.rng.uniform(0.2, 0.3))
    for degree in (4, 2):
        for m in range(1, degree + 1):
            phi = np.array([0.0, np.pi / (2 * m)])
            d = np.stack(
                [
                    np.sin(theta) * np.cos(phi),
                    np.sin(theta) * np.sin(phi),
                    np.full(2, np.cos(theta)),
                ],
                axis=1,
            )
            Y = basis(t, d, degree)
            for ell in range(m, degree + 1):
                plus, minus = Y[:, ell * (ell + 1) + m], Y[:, ell * (ell + 1) - m]
                where = f"l = {ell}, m = {m}"
                t.require(
                    bool(plus[0] * (-1) ** m > 0 and abs(minus[0]) < 1e-12),
                    f"{where}: at phi = 0 the column of m must have the sign (-1)^m, "
                    "that of -m be zero",
                )
                t.require(
                    bool(minus[1] * (-1) ** m > 0 and abs(plus[1]) < 1e-12),
                    f"{where}: at phi = pi / (2 m) the column of -m must have the sign "
                    "(-1)^m, that of m be zero",
                )
    d = np.array([[np.sqrt(1 - size**2), 0.0, size]])
    there, back = basis(t, d, 3), basis(t, -d, 3)
    odd = np.repeat([1, -1, 1, -1], [1, 3, 5, 7])
    t.require(
        bool(np.abs(there * odd - back).max() < 1e-12),
        "at -d the odd degrees must change sign, the even ones stay",
    )

"""Task 11.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Tolerance, checks_for
from photograd_course.grading.generators import unit_vectors

from .common import EXACT, basis, sphere

check = checks_for(calls=("sh_project",), needs=("sh_basis",), tolerance=EXACT)


@check(
    "11.2.back",
    points=3,
    hint="handout, equation (9): each value counts as much as its solid angle",
    sole="what a projection is for",
)
def coefficients_come_back(t):
    """A function made of harmonics is projected to the coefficients that made it."""
    for degree in (1, 3):
        d, weights = sphere(2 * degree)
        c = t.rng.uniform(-1.0, 1.0, ((degree + 1) ** 2, 2))
        got = t.call(
            "sh_project", d, weights, basis(t, d, degree) @ c, degree, returns=Array(c.shape)
        )
        t.close(f"coefficients, degree {degree}", got, c, reveal=True)


@check(
    "11.2.rest",
    points=2,
    hint="handout, section 2: what a projection leaves is orthogonal to each harmonic",
    sole="a function that no sum of harmonics reaches",
)
def what_is_left_is_orthogonal(t):
    """What a projection leaves over has no part along any harmonic: the best that can be done."""
    d, weights = sphere(12)
    f = np.exp(3 * d @ unit_vectors(t.rng, 2).T)
    got = t.call("sh_project", d, weights, f, 2, returns=Array((9, 2)))
    Y = basis(t, d, 2)
    left = Y.T @ (weights[:, None] * (f - Y @ got))
    size = float(np.linalg.norm(Y.T @ (weights[:, None] * f)))
    t.close(
        "integrals of the rest times each harmonic",
        left,
        0 * left,
        Tolerance(EXACT.relative, EXACT.evidence, floor=size),
        reveal=True,
    )

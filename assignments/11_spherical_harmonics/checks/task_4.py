"""Task 11.4, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.generators import random_rotation, unit_vectors

from .common import EXACT, band, basis

check = checks_for(calls=("sh_rotate",), needs=("sh_basis", "sh_project"), tolerance=EXACT)


def rotated(t, c, R):
    """`sh_rotate` of the submission."""
    return t.call("sh_rotate", c, R, returns=Array(c.shape))


@check(
    "11.4.turns",
    points=4,
    hint="handout, equation (15): what stands at d after the rotation stood elsewhere before",
    sole="the definition of a rotation",
)
def a_turned_function_has_moved(t):
    """The value that was at d is at R d, for rotations about z and about any axis."""
    angle = t.rng.uniform(0.5, 2.5)
    about_z = np.array(
        [[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]]
    )
    d = unit_vectors(t.rng, 12)
    for degree, R in ((1, about_z), (2, random_rotation(t.rng)), (4, random_rotation(t.rng))):
        c = t.rng.uniform(-1.0, 1.0, ((degree + 1) ** 2, 2))
        there = basis(t, d @ R.T, degree) @ rotated(t, c, R)
        t.close(f"values, degree {degree}", there, basis(t, d, degree) @ c)


@check(
    "11.4.compose",
    points=2,
    hint="R' after R is the rotation R' R; each degree keeps its length",
    sole="needs no harmonics to be asked",
)
def turns_compose(t):
    """Two rotations are one; no rotation changes the length of any degree's coefficients."""
    c = t.rng.uniform(-1.0, 1.0, (16, 3))
    first, second = random_rotation(t.rng), random_rotation(t.rng)
    once = rotated(t, c, first)
    t.close("both rotations", rotated(t, once, second), rotated(t, c, second @ first))
    for ell in range(4):
        lengths = (np.linalg.norm(each[band(ell)], axis=0) for each in (once, c))
        t.close(f"length, degree {ell}", *lengths)

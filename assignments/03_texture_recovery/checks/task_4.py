"""Task 03.4, public checks."""

import numpy as np
from photograd_course.grading import Number, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import matrix_of

from .common import EXACT, centers

check = checks_for(
    calls=("largest_curvature",),
    needs=("bilinear_sample", "bilinear_sample_adjoint", "loss_and_grad"),
)

ESTIMATE = Tolerance(
    0.02, "300 iterations leave 2e-15, the nearest wrong one (curvature_missing_two) is off by 0.5"
)


@check(
    "03.4.rounds",
    points=4,
    tolerance=EXACT,
    hint="handout, equations (11) to (13): what stands after 0 iterations, after 1?",
    sole="says which iteration or factor is wrong; the estimate alone would not",
)
def rounds_are_as_counted(t):
    """Samples at texel centers only: the estimate after n iterations is known in closed form."""
    shape = (3, 4)
    often = t.rng.integers(1, 6, 12)
    uv = np.repeat(centers(shape), often, axis=0)
    for n in (0, 1, 2, 6):
        got = t.call("largest_curvature", shape, uv, n, returns=Number())
        mean = np.sum(often ** (2.0 * n + 1)) / np.sum(often ** (2.0 * n))
        t.close(f"estimate after {n} iterations", got, 2 * mean / len(uv), reveal=True)


@check(
    "03.4.bound",
    points=3,
    tolerance=ESTIMATE,
    hint="keep x at length 1: 300 iterations make anything else 0 or infinite",
    sole="asks what the function is for, after many iterations",
)
def many_rounds_find_the_largest_eigenvalue(t):
    """After 300 iterations the estimate is the Hessian's largest eigenvalue within 2 %."""
    shape = (8, 7)
    uv = t.rng.uniform(0.0, 1.0, (150, 2)) ** 2
    got = t.call("largest_curvature", shape, uv, 300, returns=Number())
    matrix = matrix_of(t, "bilinear_sample", shape, uv)
    t.close("largest eigenvalue", got, np.linalg.norm(matrix, 2) ** 2 * 2 / len(uv))

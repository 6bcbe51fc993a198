"""Task 91.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Tolerance, hidden_check

FITTED = Tolerance(1e-8, "two solvers of the normal equations differ by some 1e-13")


@hidden_check("91.5.unseen", points=3, calls=("predict",), tolerance=FITTED)
def poses_held_out_are_met(t):
    """The cubic that made the values is met at poses that were held out."""
    cubic = np.polynomial.Polynomial(t.rng.uniform(-1.0, 1.0, 4))
    poses, unseen = t.rng.uniform(-1.0, 1.0, 20), t.rng.uniform(-1.0, 1.0, 5)
    got = t.call("predict", poses, cubic(poses), unseen, returns=Array((5,)))
    t.close("values", got, cubic(unseen))

"""Task 91.3, public checks."""

import numpy as np
from photograd_course.grading import Array, check

from .common import ROUNDING


@check("91.3.services", points=3, calls=("descend",), tolerance=ROUNDING)
def a_quadratic_contracts(t):
    """On a quadratic of curvature lambda each step shrinks x by 1 - tau lambda."""
    curvature = t.rng.uniform(0.5, 1.5, 3)
    x0 = t.rng.uniform(1.0, 2.0, 3)
    trail = t.call("descend", lambda x: curvature * x, x0, 0.5, 4, returns=Array((5, 3)))
    factor = (1 - 0.5 * curvature)[None, :] ** np.arange(5)[:, None]
    t.close("points", trail, factor * x0)

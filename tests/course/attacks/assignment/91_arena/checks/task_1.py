"""Task 91.1, public checks."""

import numpy as np
from photograd_course.grading import Number, check

from .common import ROUNDING


@check("91.1.value", points=3, calls=("weighted_sum",), tolerance=ROUNDING)
def value_at_known_points(t):
    """exp(0) = 1 and exp(-log 2) = 1/2 give the sums they must."""
    w = t.rng.uniform(1.0, 2.0, 5)
    t.close("s", t.call("weighted_sum", w, np.zeros(5), returns=Number()), w.sum(), reveal=True)
    halves = np.full(5, np.log(2.0))
    t.close("s", t.call("weighted_sum", w, halves, returns=Number()), w.sum() / 2, reveal=True)

"""Task 02.2, hidden checks."""

import numpy as np
from photograd_course.grading import hidden_check

from ..common import EXACT, gates


@hidden_check(
    "02.2.many",
    points=2,
    calls=("Value.maximum",),
    tolerance=EXACT,
    sole="the same mistakes at unseen places",
)
def maximum_at_random(t):
    """maximum is right at 100 random places."""
    a, b = t.rng.normal(0.0, 3.0, (2, 100))
    found = gates(t, "max", a, b)
    t.close("values of maximum", found["values"], np.maximum(a, b))
    t.close(
        "local derivatives of maximum", found["slopes"], np.stack([a > b, a < b], 1).astype(float)
    )

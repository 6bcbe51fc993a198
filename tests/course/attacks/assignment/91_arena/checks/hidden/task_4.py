"""Task 91.4, hidden checks."""

import numpy as np
from photograd_course.grading import Number, hidden_check

from ..common import ROUNDING


@hidden_check("91.4.tail", points=3, calls=("brightness",), tolerance=ROUNDING)
def the_mean_keeps_its_fireflies(t):
    """With a heavy tail, too, the mean is that of the samples drawn."""
    drawn = []

    def draw(n):
        if not 0 <= n <= 4000:  # what it makes stays in our memory
            raise ValueError(n)
        drawn.append(t.rng.pareto(1.5, int(n)))
        return drawn[-1]

    mean = t.call("brightness", draw, 4000, returns=Number())
    count = sum(map(len, drawn))
    t.require(count == 4000, f"expected 4000 samples to be drawn, got {count}")
    t.close("mean", mean, np.concatenate(drawn).mean())

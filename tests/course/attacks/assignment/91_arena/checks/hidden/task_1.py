"""Task 91.1, hidden checks."""

from photograd_course.grading import Number, hidden_check

from ..common import ROUNDING


@hidden_check("91.1.hidden", points=3, calls=("weighted_sum",), tolerance=ROUNDING)
def value_at_random_points(t):
    """The sum is right at random points."""
    w, x = t.rng.uniform(0.5, 2.0, 7), t.rng.uniform(-2.0, 2.0, 7)
    s = t.call("weighted_sum", w, x, returns=Number())
    t.close("s", s, t.reference.weighted_sum(w, x))

"""Task 90.2, hidden checks."""

from photograd_course.grading import Array, Items, Number, hidden_check
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import ROUNDING


@hidden_check(
    "90.2.cost",
    points=3,
    calls=("weighted_sum_backward",),
    needs=("weighted_sum",),
    tolerance=ROUNDING,
    seconds=5.0,
)
def the_derivative_is_cheap(t):
    """With 4,000 parameters the derivative is right, and costs a few forward calls."""
    w, x = t.rng.uniform(0.5, 2.0, 2000), t.rng.uniform(-2.0, 2.0, 2000)
    pair = Items(Array((2000,)), Array((2000,)), names=("d_w", "d_x"))
    d_w, d_x = t.call("weighted_sum_backward", w, x, 0.7, returns=pair)
    right = t.reference.weighted_sum_backward(w, x, 0.7)
    t.close("d_w", d_w, right[0])
    t.close("d_x", d_x, right[1])
    require_cheap(
        t, ("weighted_sum", (w, x), Number()), ("weighted_sum_backward", (w, x, 0.7), pair)
    )

"""Task 90.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, check
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)


@check("90.2.differences", points=3, calls=("weighted_sum_backward",), needs=("weighted_sum",))
def derivatives_agree_with_differences(t):
    """Both derivatives agree with central differences of your own forward function."""
    point = {"w": t.rng.uniform(0.5, 2.0, 6), "x": t.rng.uniform(-1.0, 1.0, 6)}
    d_s = float(random_cotangent(t.rng, (1,))[0])
    pair = Items(Array((6,)), Array((6,)), names=("d_w", "d_x"))
    d_w, d_x = t.call("weighted_sum_backward", point["w"], point["x"], d_s, returns=pair)

    def forward(p):
        return t.call("weighted_sum", p["w"], p["x"], returns=Number())

    agrees_with_finite_differences(t, {"w": d_w, "x": d_x}, forward, point, np.asarray(d_s))
    d_w, d_x = t.call("weighted_sum_backward", point["w"], point["x"], 0.0, returns=pair)
    require_zero_for_zero(t, {"w": d_w, "x": d_x})

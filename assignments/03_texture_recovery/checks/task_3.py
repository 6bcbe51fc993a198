"""Task 03.3, public checks."""

import numpy as np
from photograd_course.grading import Tolerance, checks_for
from photograd_course.grading.adjoint_gate import agrees_with_finite_differences

from .common import EXACT, loss_and_grad

check = checks_for(calls=("loss_and_grad",))

QUADRATIC = Tolerance(
    1e-6, "differences of a quadratic leave 6e-11, the nearest wrong one (grad_missing_two) 0.5"
)


@check(
    "03.3.value",
    points=3,
    needs=("bilinear_sample",),
    tolerance=EXACT,
    hint="handout, equation (9): sum over channels, divide by N",
    sole="tests the loss only",
)
def the_loss_of_a_constant(t):
    """Constant texture, constant measurements: the loss is the squared distance of two colors."""
    is_, should = t.rng.uniform(0.0, 1.0, (2, 3))
    uv = t.rng.uniform(0.0, 1.0, (17, 2))
    T, target = np.tile(is_, (4, 2, 1)), np.tile(should, (17, 1))
    loss, _ = loss_and_grad(t, T, uv, target)
    t.close("L", loss, np.sum((is_ - should) ** 2), reveal=True)


@check(
    "03.3.differences",
    points=5,
    tolerance=QUADRATIC,
    needs=("bilinear_sample", "bilinear_sample_adjoint"),
    hint="handout, equation (10): 2/N times the adjoint of the residuals",
    sole="the gradient itself, without the reference",
)
def the_gradient_agrees_with_differences(t):
    """Raising one texel by a little changes your loss by as much as your gradient says."""
    T = t.rng.uniform(0.0, 1.0, (3, 4, 2))
    uv, target = t.rng.uniform(0.0, 1.0, (30, 2)), t.rng.uniform(0.0, 1.0, (30, 2))
    _, d_T = loss_and_grad(t, T, uv, target)

    def forward(point):
        return loss_and_grad(t, point["T"], uv, target)[0]

    agrees_with_finite_differences(t, {"T": d_T}, forward, {"T": T}, np.ones(()), QUADRATIC)

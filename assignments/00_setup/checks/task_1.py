"""Task 00.1, public checks."""

import numpy as np
from photograd_course.grading import Array, Number, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import agrees_with_finite_differences

check = checks_for(calls=("loss_gradient",))

ROUNDING = Tolerance(
    1e-12, "two ways to write the same quotient differ by 2e-16, the nearest wrong one by 0.5"
)
# For differences, too, of which the check itself is made: they are caught as such, not as wrong.
SAME = Tolerance(
    1e-6, "two calls differ by nothing, a central difference by 1e-10, mistakes by 0.5"
)


@check(
    "00.1.differences",
    points=1,
    tolerance=SAME,
    hint="handout, section 1: derive one square, divide as the mean does",
    sole="the derivative itself; the step below shows the same mistakes at work",
)
def agrees_with_differences(t):
    """Raising one pixel by a little changes the loss by as much as your derivative says."""
    picture, photograph = t.rng.uniform(0.0, 1.0, (2, 3, 4))
    gradient = t.call("loss_gradient", picture, photograph, returns=Array((3, 4)))

    def forward(point):
        return t.call("loss", point["picture"], photograph, returns=Number())

    agrees_with_finite_differences(
        t, {"picture": gradient}, forward, {"picture": picture}, np.ones(())
    )
    swapped = t.call("loss_gradient", photograph, picture, returns=Array((3, 4)))
    t.close("gradient where the images are swapped", swapped, -gradient)
    again = t.call("loss_gradient", picture, photograph, returns=Array((3, 4)))
    t.close("gradient of the first images again", again, gradient)


@check(
    "00.1.step",
    points=0.5,
    tolerance=ROUNDING,
    sole="the same mistakes as a step downhill shows them: why they matter",
)
def one_step_reaches_the_photograph(t):
    """A step of half as many units as there are pixels lands on the photograph itself."""
    for what in ("picture after the step", "another picture after its step"):
        picture, photograph = t.rng.uniform(0.0, 1.0, (2, 5, 7))
        gradient = t.call("loss_gradient", picture, photograph, returns=Array((5, 7)))
        t.close(what, picture - picture.size / 2 * gradient, photograph)

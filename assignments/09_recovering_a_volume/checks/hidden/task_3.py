"""Task 09.3, hidden checks."""

from photograd_course.grading import Subject, hidden_check

from ..common import EXACT, loss_and_slope
from .common import alike


@hidden_check(
    "09.3.hidden",
    points=2,
    calls=("mse_and_cotangent",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[Subject("mse_and_cotangent", alike, lambda n: loss_and_slope((n, 3)))],
)
def losses_of_random_batches(t):
    """Loss and derivative are right for random batches."""
    for n in (1, 3, 50):
        pixels, truth = t.rng.uniform(-0.2, 1.2, (2, n, 3))
        got = t.call("mse_and_cotangent", pixels, truth, returns=loss_and_slope((n, 3)))
        right = t.reference.mse_and_cotangent(pixels, truth)
        t.close("loss", got[0], right[0])
        t.close("d_pixels", got[1], right[1])

"""Task 09.1, hidden checks."""

from photograd_course.grading import Number, Subject, hidden_check

from ..common import EXACT
from ..task_1 import DECIBELS
from .common import alike


@hidden_check(
    "09.1.hidden",
    points=1,
    calls=("psnr",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[Subject("psnr", alike, lambda _: Number(), tolerance=DECIBELS)],
)
def decibels_of_random_pictures(t):
    """Decibels are right for random pictures."""
    for shape in ((6, 5, 3), (40, 3), (2, 3, 4, 3)):
        a, b = t.rng.uniform(-0.5, 1.5, (2, *shape))
        got = t.call("psnr", a, b, returns=Number())
        t.close("decibels", got, t.reference.psnr(a, b), DECIBELS)

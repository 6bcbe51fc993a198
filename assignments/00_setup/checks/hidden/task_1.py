"""Task 00.1, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..task_1 import ROUNDING


@hidden_check(
    "00.1.hidden",
    points=0.5,
    calls=("loss_gradient",),
    tolerance=ROUNDING,
    sole="the same mistakes in unseen images, of any size",
    battery=[
        Subject(
            "loss_gradient",
            lambda t, n: t.rng.uniform(0.0, 1.0, (2, n, 3)),
            lambda n: Array((n, 3)),
        )
    ],
)
def gradients_of_random_images(t):
    """The gradient is right for random images, of any size."""
    picture, photograph = t.rng.uniform(0.0, 1.0, (2, 6, 9))
    got = t.call("loss_gradient", picture, photograph, returns=Array((6, 9)))
    t.close("gradient", got, t.reference.loss_gradient(picture, photograph))

"""Task 03.3, hidden checks."""

from photograd_course.grading import Array, Items, Number, Subject, hidden_check

from ..common import EXACT, loss_and_grad
from .common import measured


@hidden_check(
    "03.3.hidden",
    points=4,
    calls=("loss_and_grad",),
    needs=("bilinear_sample", "bilinear_sample_adjoint"),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[Subject("loss_and_grad", measured, lambda _: Items(Number(), Array((3, 5, 2))))],
)
def loss_and_gradient_of_random_textures(t):
    """Loss and gradient are right, cheap or not, on random textures and measurements."""
    for shape, n in (((4, 6, 3), 50), ((5, 2, 1), 7), ((60, 40, 9), 50)):
        T, uv = t.rng.uniform(0.0, 1.0, shape), t.rng.uniform(0.0, 1.0, (n, 2))
        target = t.rng.uniform(0.0, 1.0, (n, shape[2]))
        loss, d_T = loss_and_grad(t, T, uv, target)
        right = t.reference.loss_and_grad(T, uv, target)
        t.close("L", loss, right[0])
        t.close("d_T", d_T, right[1])

"""Task 03.1, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT, sample
from .common import sampled


@hidden_check(
    "03.1.hidden",
    points=3,
    calls=("bilinear_sample",),
    tolerance=EXACT,
    sole="the same mistakes at unseen points",
    battery=[Subject("bilinear_sample", sampled, lambda n: Array((n, 2)), rows=(1,))],
)
def samples_at_random_places(t):
    """Samples are right at random points of random textures, one texel wide ones included."""
    for shape in ((6, 3, 2), (1, 9, 1), (7, 1, 3), (1, 1, 2), (16, 11, 3), (90, 70, 1), (2, 3, 60)):
        T, uv = t.rng.uniform(-1.0, 1.0, shape), t.rng.uniform(-0.5, 1.5, (150, 2))
        t.close("samples", sample(t, T, uv), t.reference.bilinear_sample(T, uv))

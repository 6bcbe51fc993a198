"""Task 15.3, hidden checks."""

from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT
from ..task_3 import taken, taken_back, wide_splats
from .common import derivatives, values


@hidden_check(
    "15.3.hidden",
    points=2,
    calls=("screen_alpha",),
    adjoints=("screen_alpha",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[
        Subject(
            "adapters.screen_alpha",
            lambda t, n: wide_splats(t.rng, n, 4),
            lambda n: Array((n, 4)),
            right=values("screen_alpha"),
            rows=(0, 1, 2),
        ),
        Subject(
            "adapters.screen_alpha_back",
            lambda t, n: (*wide_splats(t.rng, n, 4), t.rng.normal(size=(n, 4))),
            lambda n: Items(Array((n, 2)), Array((n, 3)), Array((n,)), Array((n, 2))),
            right=derivatives("screen_alpha"),
            rows=(0, 1, 2, 4),
        ),
    ],
)
def random_splats(t):
    """Values and derivatives are right for splats of all kinds, cut off here and there."""
    n, pixels = 12, t.rng.uniform(0.0, 16.0, (300, 2))
    m, half = t.rng.uniform(-2.0, 18.0, (n, 2)), t.rng.normal(size=(n, 2, 2)) * 2
    full = half @ half.swapaxes(1, 2)
    s, o = full[:, [0, 0, 1], [0, 1, 1]], t.rng.uniform(-3.0, 8.0, n)
    pixels[:2] = m[:2] + 0.01
    o[:2] = 9.0
    g = random_cotangent(t.rng, (n, 300))
    alpha, pullback = t.reference.screen_alpha(m, s, o, pixels)
    t.close("alpha", taken(t, m, s, o, pixels), alpha)
    got = taken_back(t, m, s, o, pixels, g)
    names = ("d_mean2d", "d_cov2d", "d_opacity_logits", "absgrad")
    for name, mine, theirs in zip(names, got, pullback(g), strict=True):
        t.close(name, mine, theirs)

"""Task 03.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import CHAINED
from ..task_5 import EARLIER, recover
from .common import measured


@hidden_check(
    "03.5.recovers",
    points=4,
    calls=("recover_texture",),
    needs=EARLIER,
    seconds=20.0,
    sole="the whole: an unseen texture, recovered from samples",
    battery=[
        Subject(
            "recover_texture",
            lambda t, n: (*measured(t, 40), n),
            lambda n: Items(Array((3, 5, 2)), Array((n + 1,)), Array((3, 5), "bool")),
            sizes=(0, 1, 7),
            large=200,
            tolerance=CHAINED,
        )
    ],
)
def a_texture_is_recovered(t):
    """Fifty steps recover an unseen texture from 1,500 samples to 55 dB or better."""
    shape = (7, 6, 1)
    unknown, uv = t.rng.uniform(0.0, 1.0, shape), t.rng.uniform(0.0, 1.0, (1500, 2))
    target, T0 = t.reference.bilinear_sample(unknown, uv), np.full(shape, 0.5)
    T, _, unseen = recover(t, T0, uv, target, 50)
    # Over 300 seeds the solution reaches 62.4 dB at worst, 66 dB at the 5th percentile.
    error = float(np.mean((T - unknown) ** 2))
    t.require(
        error <= 10**-5.5, f"PSNR {-10 * np.log10(max(error, 1e-30)):.1f} dB, threshold 55 dB"
    )
    t.require(not unseen.any(), "texels are called unseen although each has samples")

"""Task 04.4, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import upper_directions

from ..common import EXACT, turned, viewer
from ..task_4 import cells, chi_square, drawn, twice


@hidden_check(
    "04.4.hidden",
    points=3,
    calls=("sample_ggx",),
    sole="the right density, whatever that of the submission is",
    battery=[
        Subject(
            "sample_ggx",
            lambda t, n: (
                upper_directions(t.rng, n),
                t.rng.uniform(0.3, 1.0, n),
                t.rng.random((n, 2)),
            ),
            lambda n: Array((n, 3)),
            rows=(0, 1, 2),
            tolerance=EXACT,
            has_right=False,
        )
    ],
)
def samples_have_the_right_density(t):
    """Samples at random views fall into cells as often as they should (chi-square)."""
    for low, high in ((0.2, 0.5), (0.5, 1.0)):
        # Rougher ones look nearly even, whatever is forgotten.
        r, z = float(t.rng.uniform(0.5, 0.7)), float(t.rng.uniform(low, high))
        wo = turned(viewer(z, 10_000), float(t.rng.uniform(0.0, 6.0)))
        shares = cells(
            lambda wi, wo=wo, r=r: t.reference.ggx_pdf(wo[: len(wi)], wi, np.full(len(wi), r))
        )

        def judge(wo=wo, r=r, shares=shares):
            return chi_square(drawn(t, wo, r, t.rng.random((10_000, 2))), shares)

        twice(t, judge, "samples do not lie as they should")

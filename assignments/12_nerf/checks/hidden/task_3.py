"""Task 12.3, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, checks_for

from ..common import EXACT
from ..task_3 import intervals, sampled

check = checks_for(calls=("sample_distances",), tolerance=EXACT, visibility="hidden")
# Chi-square of 14 degrees of freedom passes this once in a million.
CHI_SQUARE = 57.8


@check(
    "12.3.hidden",
    points=2,
    sole="the same mistakes on unseen rays",
    battery=[
        Subject(
            "sample_distances",
            lambda t, n: (*intervals(t.rng, n, 4), t.rng.random((n, 6))),
            lambda n: Array((n, 6)),
            rows=(0, 1, 2),
        )
    ],
)
def distances_on_random_rays(t):
    """Distances are right on random rays."""
    for rays, count, n in ((3, 1, 5), (4, 12, 1), (5, 6, 8), (2, 100, 150)):
        edges, weights = intervals(t.rng, rays, count)
        u = t.rng.random((rays, n))
        right = t.reference.sample_distances(edges, weights, u)
        t.close("distances", sampled(t, edges, weights, u), right)
    # The last v is rounded to 1, the end of the CDF.
    edges, weights = intervals(t.rng, 4, 3)
    weights[:, -1] += 0.1
    u = np.concatenate([t.rng.random((4, 5)), np.full((4, 1), np.nextafter(1.0, 0.0))], axis=1)
    right = t.reference.sample_distances(edges, weights, u)
    t.close("distances to the last edge", sampled(t, edges, weights, u), right)


@check("12.3.chi", points=2, sole="the distribution itself, whatever the formula")
def samples_are_distributed_as_the_weights(t):
    """Over many rays the fifteen bins of a density get their share of the samples (chi-square)."""
    weights = t.rng.uniform(0.2, 2.0, 5)
    edges = np.append(2.0, t.rng.uniform(0.1, 0.9, 5)).cumsum()
    rays, n = 2000, 4
    for _ in range(2):  # one retry: both fail once in 10^12
        every = [np.tile(each, (rays, 1)) for each in (edges, weights)]
        got = sampled(t, *every, t.rng.random((rays, n)))
        # Of the samples of one ray the first: independent of one another.
        kept = got[np.arange(rays), t.rng.integers(0, n, rays)]
        cuts = np.interp(np.arange(16) / 3, np.arange(6), edges)
        counts = np.histogram(kept, cuts)[0]
        expected = rays * np.repeat(weights / weights.sum(), 3) / 3
        far = float(np.sum((counts - expected) ** 2 / expected))
        if passed := far < CHI_SQUARE and counts.sum() == rays:
            break
    t.require(passed, f"chi-square {far:.0f}, allowed {CHI_SQUARE}")

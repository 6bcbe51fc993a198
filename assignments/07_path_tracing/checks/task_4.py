"""Task 07.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for

from .common import EXACT

check = checks_for(calls=("roulette",), tolerance=EXACT)


def played(t, beta, u):
    beta, u = np.asarray(beta, float), np.asarray(u, float)
    parts = Items(Array(beta.shape), Array(u.shape, "bool"), names=("beta", "alive"))
    return t.call("roulette", beta, u, returns=parts)


@check(
    "07.4.values",
    points=2,
    hint="equations (11) and (12): the largest channel decides, u < s continues",
    sole="one path that continues and one that ends",
)
def known_ends(t):
    """A path with (0.2, 0.5, 0.1) continues half of the time with (0.4, 1, 0.2); small beta too."""
    u = [float(t.rng.uniform(0.3, 0.49)), float(t.rng.uniform(0.51, 0.9)), 0.0, 0.5]
    beta, alive = played(t, [[0.2, 0.5, 0.1]] * 4, u)
    right = [True, False, True, False]
    t.require(alive.tolist() == right, f"alive is {alive.tolist()} for u = {u}, s = 0.5")
    t.close("beta", beta, np.outer(right, [0.4, 1, 0.2]), reveal=True)
    s = np.array([0.1, 0.001])
    beta, alive = played(t, np.outer(s, [0.4, 1, 0.2]), t.rng.uniform(0.1, 0.9) * s)
    t.require(bool(alive.all()), "a path with u < s has ended: s is 0.1 or 0.001")
    t.close(
        "beta of paths with small throughput",
        beta,
        np.tile([0.4, 1, 0.2], (2, 1)),
        reveal=True,
        hint=(
            "1 / s is 10 and 1000 here and must not be limited: it compensates for all ended paths"
        ),
    )


@check(
    "07.4.mean",
    points=3,
    hint="a surviving path is multiplied by 1 / s, which compensates for the others",
    sole="roulette must not change the mean",
)
def the_mean_is_kept(t):
    """Over 1000 evenly spaced values of u the mean of beta is unchanged."""
    u = (np.arange(1000) + 0.5) / 1000
    for _ in range(4):
        beta = t.rng.integers(1, 999, 3) / 1000
        after, _ = played(t, np.tile(beta, (1000, 1)), t.rng.permutation(u))
        t.close("mean of beta", after.mean(axis=0), beta, reveal=True)


@check(
    "07.4.ends",
    points=2,
    hint="s is at most 1; and where s is 0 do not divide by it",
    sole="large throughput is unchanged, and zero ends",
)
def bright_and_dark_paths(t):
    """A channel of 1 or more: always continues, unchanged. Zero: always ends."""
    bright = t.rng.uniform(0, 3, (20, 3))
    bright[:, 1] = t.rng.uniform(1, 3, 20)
    u = np.append(t.rng.random(18), [0.0, 1 - 2**-53])
    beta, alive = played(t, bright, u)
    t.require(bool(alive.all()), "a path with a channel of 1 or more has ended")
    t.close("beta of paths with large throughput", beta, bright)
    beta, alive = played(t, np.zeros((20, 3)), u)
    t.require(not alive.any() and not beta.any(), "a path with beta = 0 continues")

"""Task 09.1, public checks."""

import numpy as np
from photograd_course.grading import Number, Tolerance, checks_for

from .common import EXACT

check = checks_for(calls=("psnr",), tolerance=EXACT)

DECIBELS = Tolerance(EXACT.relative, EXACT.evidence, floor=100.0)


@check(
    "09.1.values",
    points=3,
    hint="handout, equation (3): decibels are ten times the decimal logarithm",
    sole="small enough to work out by hand",
)
def known_decibels(t):
    """An error of 0.1 everywhere is 20 dB, of 0.01 40 dB; twice the error costs 6.02 dB."""
    picture = t.rng.uniform(0.0, 1.0, (4, 5, 3))
    for error, decibels in ((0.1, 20.0), (0.01, 40.0), (1.0, 0.0)):
        way = np.where(t.rng.random(picture.shape) < 0.5, -error, error)
        got = t.call("psnr", picture + way, picture, returns=Number())
        t.close(f"an error of {error:g}", got, decibels, DECIBELS, reveal=True)
    rough = t.rng.normal(size=picture.shape) * 0.05
    once, twice = (t.call("psnr", picture + k * rough, picture, returns=Number()) for k in (1, 2))
    t.close("what twice the error costs", once - twice, 20 * np.log10(2), reveal=True)
    with np.errstate(divide="ignore"):
        got = t.call("psnr", picture, picture, returns=Number(finite=False))
    t.require(got == np.inf, "equal pictures have infinitely many decibels")


@check(
    "09.1.mean",
    points=2,
    hint="handout, section 1: first one mean over everything, then one logarithm",
    sole="says that the mean comes first",
)
def one_mean_for_all(t):
    """One wrong number among n has 10 log10 n decibels more than n of them, wherever it is."""
    for shape in ((4, 5, 3), (2, 3, 4, 3), (7, 3)):
        truth = t.rng.uniform(0.0, 1.0, shape)
        one = truth.copy()
        one[tuple(t.rng.integers(0, n) for n in shape)] += 0.5
        got = t.call("psnr", one, truth, returns=Number())
        all_wrong = t.call("psnr", truth - 0.5, truth, returns=Number())
        t.close(f"decibels more, {shape}", got - all_wrong, 10 * np.log10(truth.size), reveal=True)

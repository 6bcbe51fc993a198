"""Task 12.3, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import EXACT

check = checks_for(calls=("sample_distances",), tolerance=EXACT)


def sampled(t, edges, weights, u):
    """`sample_distances` of the submission."""
    return t.call("sample_distances", edges, weights, u, returns=Array(u.shape))


def intervals(rng, rays, count):
    """Edges and weights of random intervals, of any sum, some of them never to be sampled."""
    edges = np.sort(rng.uniform(2.0, 4.0, (rays, count + 1)), axis=1)
    weights = rng.uniform(0.2, 3.0, (rays, count)) * (rng.random((rays, count)) < 0.7)
    weights[np.arange(rays), rng.integers(0, count, rays)] += 1.0
    return edges, weights


@check(
    "12.3.strata",
    points=3,
    hint="handout, equation (9): as many equal parts as samples, and one sample in each",
    sole="a single interval: the stratification alone",
)
def one_sample_in_each_part(t):
    """One interval, n samples: each has a part of its own, and moves through it with u."""
    ends = np.array([[2.0, 6.0], [1.0, 1.5]])
    sizes = ends[:, 1:] - ends[:, :1]
    for n in (1, 4, 5):
        first = ends[:, :1] + sizes * np.linspace(0.0, 1.0, n, endpoint=False)
        got = sampled(t, ends, np.ones((2, 1)), np.zeros((2, n)))
        t.close(f"{n} samples, u = 0", got, first, reveal=True)
        u = t.rng.random((2, n))
        got = sampled(t, ends, np.full((2, 1), 7.0), u)
        t.close(f"{n} samples, how far into their parts", (got - first) * n / sizes, u)


@check(
    "12.3.known",
    points=2,
    hint="handout, equations (10) to (12): the interval whose CDF contains v, then how far into it",
    sole="small enough to work out by hand",
)
def known_distances(t):
    """Two intervals of weights 1 and 3: a quarter of the samples is in the first."""
    edges, u = np.array([[2.0, 3.0, 6.0]]), np.full((1, 4), 0.5)
    got = sampled(t, edges, np.array([[1.0, 3.0]]), u)
    t.close("weights 1, 3", got, np.array([[2.5, 3.5, 4.5, 5.5]]), reveal=True)
    got = sampled(t, edges, np.array([[5.0, 5.0]]), u)
    t.close("equal weights", got, np.array([[2.25, 2.75, 3.75, 5.25]]), reveal=True)
    edges = np.array([[0.0, 1.0, 2.0, 3.0]])
    got = sampled(t, edges, np.array([[0.0, 0.5, 0.0]]), u)
    t.close("weights 0, 0.5, 0", got, np.array([[1.125, 1.375, 1.625, 1.875]]), reveal=True)
    edges, weights = np.array([[0.0, 1.0, 2.0, 3.0, 4.0]]), np.array([[0.0, 1.0, 0.0, 1.0]])
    got = sampled(t, edges, weights, np.zeros((1, 2)))
    t.close("weights 0, 1, 0, 1 and u = 0", got, np.array([[1.0, 3.0]]), reveal=True)


@check(
    "12.3.inverse",
    points=4,
    hint="the share of the weight up to a sample must be (i + u) / n: weights of any sum",
    sole="the definition of the inverse, for many intervals, without the reference",
)
def the_cdf_of_a_sample_is_its_number(t):
    """The share of the weight that lies before a sample is its uniform number; rays are apart."""
    edges, weights = intervals(t.rng, 6, 7)
    u = t.rng.random((6, 9))
    got = sampled(t, edges, weights, u)
    t.require(bool((np.diff(got, axis=1) >= 0).all()), "the distances of a ray must ascend")
    for ray in range(6):
        before = np.append(0.0, weights[ray]).cumsum()
        part = np.interp(got[ray], edges[ray], before / before[-1])
        t.close(
            f"share of the weight before each sample of ray {ray}, times n",
            9 * part,
            u[ray] + np.arange(9),
        )

"""Task 04.4, public checks."""

import math

import numpy as np
from photograd_course.grading import Array, CheckFailed, checks_for
from photograd_course.grading.generators import hemisphere_quadrature, upper_directions

from .common import EXACT, densities, lobes, turned, viewer

check = checks_for(calls=("sample_ggx",))

LEVEL = 3e-4  # of one judgement; seven samples are judged
NONE_BELOW = (
    "no sample is below the surface, but some facets reflect downward: c of (15) reaches down to "
    "-v_z; and wi is returned, not w_h"
)


def drawn(t, wo, r, u2):
    """`sample_ggx` of the submission."""
    return t.call("sample_ggx", wo, np.full(len(wo), float(r)), u2, returns=Array(wo.shape))


def twice(t, judge, text):
    """Require of random samples that one of two judgements is better than LEVEL."""
    t.require(judge() >= LEVEL or judge() >= LEVEL, text)


def cells(pdf, rows=8, columns=8, order=8):
    """Shares (rows, columns) of the hemisphere's cells of height and angle, for a density."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    nodes, weights = (nodes + 1) / 2, weights / 2
    z = ((np.arange(rows)[:, None] + nodes) / rows).ravel()
    phi = ((np.arange(columns)[:, None] + nodes) * (2 * np.pi / columns)).ravel()
    z, phi = (each.ravel() for each in np.meshgrid(z, phi, indexing="ij"))
    s = np.sqrt(1 - z * z)
    values = pdf(np.stack([s * np.cos(phi), s * np.sin(phi), z], axis=1))
    sums = np.einsum("aibj,i,j->ab", values.reshape(rows, order, columns, order), weights, weights)
    return sums * (2 * np.pi / (rows * columns))


def counts(wi, shape):
    """How many directions fall into each of the cells (rows, columns) above the surface."""
    rows, columns = shape
    up = wi[wi[:, 2] > 0]
    turn = np.mod(np.arctan2(up[:, 1], up[:, 0]), 2 * np.pi) * (columns / (2 * np.pi))
    row = np.minimum((up[:, 2] * rows).astype(int), rows - 1)
    place = row * columns + np.minimum(turn.astype(int), columns - 1)
    return np.bincount(place, minlength=rows * columns).reshape(shape)


def chi_square(wi, shares):
    """p-value of directions against the shares of cells; a last cell has what is below."""
    lost = 1 - shares.sum()
    if not (np.isfinite(shares).all() and (shares >= 0).all() and lost > -1e-3):
        return 0.0
    found = counts(wi, shares.shape)
    found = np.append(found.ravel(), len(wi) - found.sum())
    expected = np.append(shares.ravel(), max(lost, 0.0)) * len(wi)
    small = expected < 5
    e = np.append(expected[~small], expected[small].sum())
    n = np.append(found[~small], found[small].sum())
    if e[-1] < 5:
        e, n = np.append(e[:-2], e[-2:].sum()), np.append(n[:-2], n[-2:].sum())
    freedom = len(e) - 1
    chi = float(((n - e) ** 2 / e).sum())
    # The tail of chi-square by Wilson and Hilferty.
    spread = 2 / (9 * freedom)
    return 0.5 * math.erfc(((chi / freedom) ** (1 / 3) - 1 + spread) / math.sqrt(2 * spread))


def compare_samples(t, wo, r, shares):
    """Fail with what is below the surface, where samples lie on average, and both by cells."""
    wi = drawn(t, wo, r, t.rng.random((len(wo), 2)))
    w, solid_angles = hemisphere_quadrature(48, 96)
    expected = solid_angles * densities(t, wo[: len(w)], w, r)
    above, share = wi[:, 2] > 0, max(float(expected.sum()), 1e-12)

    def said(below, mean):
        x, y, z = mean + 0.0
        return f"{below:.3f} below the surface, the rest on average at ({x:.2f}, {y:.2f}, {z:.2f})"

    mine = said(1 - above.mean(), wi[above].mean(axis=0) if above.any() else np.zeros(3))
    theirs = said(1 - expected.sum(), expected @ w / share)
    x, y, z = wo[0]
    raise CheckFailed(
        f"roughness {r}, viewer at ({x:.2f}, {y:.2f}, {z:.2f}): samples do not lie as your density "
        f"says; samples: {mine}; density: {theirs}",
        {"advice": NONE_BELOW if above.all() else ""},
        arrays=(counts(wi, shares.shape) / len(wi), shares),
    )


@check(
    "04.4.mirror",
    points=2,
    tolerance=EXACT,
    hint="mirror: wi = 2 (wo . h) h - wo, with h a unit vector that has z > 0 and wo . h > 0; "
    "without alpha on x and y, h of (16) is no facet that the viewer sees",
    sole="what every single sample must satisfy",
)
def samples_are_mirrored_at_facets(t):
    """Unit vectors, each reflected at a facet of the surface that the viewer sees."""
    for r in (0.1, 0.5, 1.0):
        wo = upper_directions(t.rng, 200, 0.05)
        wi = drawn(t, wo, r, t.rng.random((200, 2)))
        t.close("lengths", np.linalg.norm(wi, axis=1), np.ones(200), reveal=True)
        h = wo + wi
        t.require(bool((h[:, 2] > 0).all()), "wo + wi must point upward: a facet's normal does")
        t.require(bool(((wo * h).sum(axis=1) > 0).all()), "the viewer must see the facet")


@check(
    "04.4.rows",
    points=1,
    tolerance=EXACT,
    hint="nothing may be drawn in the function: the two numbers of a row decide about it",
    sole="the same numbers, the same directions: what debugging rests upon",
)
def numbers_decide(t):
    """The same rows of u2 give the same directions, in any order."""
    wo, u2 = upper_directions(t.rng, 50), t.rng.random((50, 2))
    order = t.rng.permutation(50)
    t.close(
        "directions in another order",
        drawn(t, wo[order], 0.6, u2[order]),
        drawn(t, wo, 0.6, u2)[order],
    )


@check(
    "04.4.chi",
    points=4,
    needs=("ggx_lobe", "ggx_pdf"),
    hint="v of (14) and w_h of (16) both have x and y times alpha, c of (15) reaches down to -v_z; "
    "axis 0 of the arrays: heights of wi from the horizon up, axis 1: angles around the normal",
    sole="the definition: samples lie as densely as the density says",
)
def samples_have_the_density(t):
    """10,000 samples fall into 64 cells as often as your density says (chi-square)."""
    for r, z in ((0.6, 0.35), (0.5, 0.9), (0.9, 0.6)):
        wo = turned(viewer(z, 10_000), float(t.rng.uniform(0.0, 6.0)))
        shares = cells(lambda wi, wo=wo, r=r: densities(t, wo[: len(wi)], wi, r))

        def judge(wo=wo, r=r, shares=shares):
            return chi_square(drawn(t, wo, r, t.rng.random((10_000, 2))), shares)

        good = judge() >= LEVEL or judge() >= LEVEL
        if not good:
            compare_samples(t, wo, r, shares)
        t.require(good, "samples do not lie as your density says")


@check(
    "04.4.mean",
    points=2,
    needs=("ggx_lobe", "ggx_pdf"),
    hint="a weight is your lobe times the cosine over your density, at your own samples",
    sole="what it is for: the mean of the weights is the furnace's albedo",
)
def weights_average_to_the_albedo(t):
    """The mean weight of 5,000 samples is the albedo that the lobe has in the furnace (z-test)."""
    wi, solid_angles = hemisphere_quadrature(64, 128)
    for r, z in ((0.7, 0.5), (1.0, 0.9)):
        right = solid_angles @ (wi[:, 2] * lobes(t, viewer(z, len(wi)), wi, r))
        wo = viewer(z, 5_000)

        def judge(wo=wo, r=r, right=right):
            got = drawn(t, wo, r, t.rng.random((5_000, 2)))
            lobe, pdf = lobes(t, wo, got, r), densities(t, wo, got, r)
            weight = np.where(pdf > 0, lobe * got[:, 2] / np.where(pdf > 0, pdf, 1), 0)
            off = abs(weight.mean() - right) / max(weight.std() / math.sqrt(5_000), 1e-12)
            return math.erfc(off / math.sqrt(2))

        twice(t, judge, f"roughness {r}, viewer at {z}: the mean weight is not the albedo")

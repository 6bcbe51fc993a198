"""Checks of assignment 04.

Seven sets of random draws are judged. Where a judgement is bad, at 3e-4, new draws get a second
one: a right solution fails in less than one of a million submissions.
"""

from __future__ import annotations

import math

import numpy as np
from photograd_course.grading import Array, CheckFailed, Items, Subject, Tolerance, check
from photograd_course.grading.adjoint_gate import (
    random_cotangent,
    require_gradients,
    require_zero_for_zero,
)

# Evidence: worst of the solution and three alternatives, against the nearest of 92 named wrong
# solutions.
EXACT = Tolerance(
    1e-11, "right ones differ by at most 2e-14, the nearest wrong one (back_differences) by 1e-9"
)
SHARP = Tolerance(
    1e-8,
    "right ones differ by 1e-15, the textbook's form of q at roughness 0.045 by some 1e-10; the "
    "nearest wrong one (lobe_no_roots) by 0.06",
)
TABLE = Tolerance(
    1e-4, "sums over directions leave 5e-7, the nearest wrong one (gltf_by_viewer) 0.006"
)
SMOOTH = Tolerance(
    1e-6, "central differences leave 4e-9, the nearest wrong one (back_color_no_ramp) 0.0014"
)
LEVEL = 3e-4  # of one judgement; seven draws are judged


def directions(rng, n, low=0.1):
    """(n, 3), unit vectors above the surface, heights from `low` up."""
    z, phi = rng.uniform(low, 1.0, n), rng.uniform(0.0, 2 * np.pi, n)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)


def viewer(z, n):
    """(n, 3), all the direction of height z in the plane y = 0."""
    return np.tile([math.sqrt(1 - z * z), 0.0, z], (n, 1))


def dome(heights, turns):
    """Directions above the surface and their solid angles, for integrals."""
    nodes, weights = np.polynomial.legendre.leggauss(heights)
    root = (nodes + 1) / 2
    z, phi = np.meshgrid(root**2, (np.arange(turns) + 0.5) * (2 * np.pi / turns), indexing="ij")
    r = np.sqrt(1 - z * z)
    w = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).reshape(-1, 3)
    return w, np.repeat(root * weights * (2 * np.pi / turns), turns)


def turned(w, angle):
    """Directions turned around the normal."""
    c, s = math.cos(angle), math.sin(angle)
    return w @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def buried(rng, n):
    """Pairs of directions of which at least one is below the surface or in it."""
    wo, wi = directions(rng, n), directions(rng, n)
    wo[::3, 2] *= -1
    wi[1::3, 2] *= -1
    wo[2::3, 2] *= -1
    wi[2::3] = -wo[2::3]  # opposite: they have no half vector
    return wo, wi


def lobes(t, wo, wi, r):
    """`ggx_lobe` of the submission."""
    return t.call("ggx_lobe", wo, wi, np.full(len(wo), float(r)), returns=Array((len(wo),)))


def densities(t, wo, wi, r):
    """`ggx_pdf` of the submission."""
    return t.call("ggx_pdf", wo, wi, np.full(len(wo), float(r)), returns=Array((len(wo),)))


# 04.1 ---------------------------------------------------------------------------------------------


def room(t, value, channels, cosines):
    """`furnace` of the submission for a model, which looks at the directions it is asked for."""

    def model(wo, wi):
        t.require(
            isinstance(wo, np.ndarray)
            and isinstance(wi, np.ndarray)
            and wo.ndim == 2
            and wo.shape == wi.shape
            and wo.shape[1] == 3,
            "f must be asked for wo and wi as arrays of one shape (M, 3)",
        )
        length = np.stack([np.linalg.norm(w, axis=1) for w in (wo, wi)])
        t.require(bool((np.abs(length - 1) < 1e-9).all()), "f must be asked for unit vectors")
        near = np.abs(wo[:, 2:] - cosines).min(axis=1)
        t.require(
            bool(
                (near < 1e-12).all()
                and (np.abs(wo[:, 1]) < 1e-12).all()
                and (wo[:, 0] > -1e-12).all()
            ),
            "wo, the first argument of f, must be a viewer: in the plane y = 0, on the side "
            "of +x, its z one of the cosines",
        )
        t.require(bool((wi[:, 2] > 0).all()), "wi must be above the surface")
        return value(wo, wi)

    return t.call("furnace", model, cosines, returns=Array((len(cosines), channels)))


@check(
    "04.1.matte",
    task="04.1",
    points=3,
    calls=("furnace",),
    tolerance=EXACT,
    hint="equation (5): each direction has its own solid angle; one row (C,) for each viewer",
    sole="the one model whose albedo everybody knows",
)
def a_matte_surface_returns_its_albedo(t):
    """f = albedo / pi returns the albedo, whoever looks."""
    albedo, cosines = t.rng.uniform(0.2, 1.0, 3), t.rng.uniform(0.1, 1.0, 4)
    got = room(t, lambda wo, wi: 0 * wi + albedo / np.pi + 0 * wo, 3, cosines)
    t.close("albedo", got, np.tile(albedo, (4, 1)), reveal=True)


@check(
    "04.1.shapes",
    task="04.1",
    points=3,
    calls=("furnace",),
    tolerance=EXACT,
    hint="the cosine is that of the light, wi; each direction has its own solid angle; one row "
    "for each viewer, whose wo is the same in all pairs of the sum",
    sole="each of the four sums wants another power of wi",
)
def models_with_a_known_integral(t):
    """Polynomials of the directions, integrated by hand."""
    cosines = t.rng.uniform(0.1, 1.0, 5)

    def value(wo, wi):
        across = wo[:, 0] * wi[:, 0] + wo[:, 1] * wi[:, 1]
        return np.stack([wo[:, 2] ** 2, wo[:, 2] * wi[:, 2] ** 2, across**2, across + 1], axis=1)

    right = np.stack(
        [np.pi * cosines**2, np.pi / 2 * cosines, np.pi / 4 * (1 - cosines**2), np.full(5, np.pi)],
        axis=1,
    )
    t.close("integrals", room(t, value, 4, cosines), right, reveal=True)


@check(
    "04.1.burley",
    task="04.1",
    points=2,
    calls=("furnace",),
    tolerance=EXACT,
    hint="mend the checks above first",
    sole="the first discovery: a famous model that makes light",
)
def a_fit_that_makes_light(t):
    """Burley's white rough surface, seen from the horizon, returns 1.5575 times the light."""

    def value(wo, wi):
        f90 = 1.5 + np.sum(wo * wi, axis=1)
        out, back = (1 + (f90 - 1) * (1 - w[:, 2]) ** 5 for w in (wo, wi))
        return (out * back / np.pi)[:, None]

    got = room(t, value, 1, np.array([1e-12]))
    right = 1.5 + 1 / 28 + 1 / 56 + 1 / 252
    t.close("albedo at the horizon", got, [[right]], SHARP, reveal=True)


# 04.2 ---------------------------------------------------------------------------------------------


@check(
    "04.2.peak",
    task="04.2",
    points=2,
    calls=("ggx_lobe",),
    tolerance=EXACT,
    hint="equations (8) and (10): alpha is the roughness squared; straight on q is 1 and L is 2",
    sole="one number that can be worked out by head",
)
def straight_back(t):
    """Light that comes from and goes to straight above: 1 / (4 pi roughness^4)."""
    up = viewer(1.0, 1)
    for r in t.rng.uniform(0.2, 1.0, 4):
        t.close("lobe straight back", lobes(t, up, up, r), [1 / (4 * np.pi * r**4)], reveal=True)


@check(
    "04.2.ball",
    task="04.2",
    points=2,
    calls=("ggx_lobe",),
    tolerance=EXACT,
    hint="at roughness 1 stretching changes nothing: q = 1, and both lengths are 1",
    sole="the roughest surface in closed form, from all sides",
)
def the_roughest_surface(t):
    """At roughness 1 facets lie as on a ball: the lobe is 1 / (2 pi (o_z + i_z))."""
    wo, wi = directions(t.rng, 20), directions(t.rng, 20)
    right = 1 / (2 * np.pi * (wo[:, 2] + wi[:, 2]))
    t.close("lobe at roughness 1", lobes(t, wo, wi, 1.0), right, reveal=True)


@check(
    "04.2.symmetry",
    task="04.2",
    points=2,
    calls=("ggx_lobe",),
    tolerance=EXACT,
    hint="every formula of section 2 treats wo and wi alike",
    sole="reciprocity: light could go the other way",
)
def light_could_go_the_other_way(t):
    """Exchanging wo and wi, or turning both around the normal, changes nothing."""
    for r in t.rng.uniform(0.3, 1.0, 3):
        wo, wi = directions(t.rng, 20), directions(t.rng, 20)
        there = lobes(t, wo, wi, r)
        t.close("lobe with wo and wi exchanged", lobes(t, wi, wo, r), there)
        angle = float(t.rng.uniform(0.5, 3.0))
        t.close(
            "lobe of turned directions", lobes(t, turned(wo, angle), turned(wi, angle), r), there
        )


@check(
    "04.2.below",
    task="04.2",
    points=1,
    calls=("ggx_lobe",),
    hint="where a direction is not above the surface the lobe is exactly 0 (0 times infinity "
    "is not 0: choose with np.where)",
    sole="half of all directions",
)
def nothing_below_the_surface(t):
    """A direction below the surface, and opposite ones: exactly 0. Above: more than 0."""
    wo, wi = buried(t.rng, 12)
    t.require(not lobes(t, wo, wi, 0.5).any(), "below the surface the lobe must be exactly 0")
    some = lobes(t, directions(t.rng, 12), directions(t.rng, 12), 0.5)
    t.require(bool((some > 0).all()), "above the surface the lobe must be more than 0")


# What a surface of perfect mirrors returns: roughness, cosine of the viewer, albedo.
MIRRORS = (
    (0.5, 1.0, 0.915812),
    (0.5, 0.6, 0.871721),
    (0.7, 1.0, 0.697750),
    (0.7, 0.3, 0.748997),
    (0.85, 0.6, 0.550531),
    (1.0, 1.0, 1 - math.log(2)),
    (1.0, 0.3, 0.560099),
)


@check(
    "04.2.energy",
    task="04.2",
    points=4,
    calls=("ggx_lobe",),
    tolerance=TABLE,
    hint="handout, section 2: D must cover the surface once, V divides by 4 o_z i_z",
    sole="the furnace decides: what each roughness returns, 1 - ln 2 among it",
)
def what_mirrors_return(t):
    """What surfaces of perfect mirrors return: 1 - ln 2 at roughness 1, seen from above."""
    wi, solid_angles = dome(64, 160)
    got = []
    for r, z, _ in MIRRORS:
        got.append(solid_angles @ (wi[:, 2] * lobes(t, viewer(z, len(wi)), wi, r)))
    places = ", ".join(f"({r:g}, {z:g})" for r, z, _ in MIRRORS)
    t.close(
        f"albedo at (roughness, cosine) {places}",
        np.array(got),
        [row[2] for row in MIRRORS],
        reveal=True,
    )


# 04.3 ---------------------------------------------------------------------------------------------


@check(
    "04.3.ball",
    task="04.3",
    points=2,
    calls=("ggx_pdf",),
    needs=("ggx_lobe",),
    tolerance=EXACT,
    hint="at roughness 1: D = 1 / pi, and wo sees 2 o_z / (1 + o_z) of the facets turned to it",
    sole="the roughest surface in closed form",
)
def a_ball_spreads_evenly(t):
    """At roughness 1 a viewer's mirrored directions are spread evenly: 1 / (2 pi (1 + o_z))."""
    wo, wi = directions(t.rng, 20), directions(t.rng, 20)
    right = 1 / (2 * np.pi * (1 + wo[:, 2]))
    t.close("density at roughness 1", densities(t, wo, wi, 1.0), right, reveal=True)


@check(
    "04.3.mass",
    task="04.3",
    points=3,
    calls=("ggx_pdf",),
    needs=("ggx_lobe",),
    tolerance=TABLE,
    hint="turning a facet by an angle turns the mirrored direction by two: equation (12)",
    sole="a density is known by its integral",
)
def what_stays_above(t):
    """Seen from straight above, facets steeper than 45 degrees mirror downwards: the rest stays."""
    wi, solid_angles = dome(96, 16)
    for r in t.rng.uniform(0.6, 1.0, 3):
        mass = solid_angles @ densities(t, viewer(1.0, len(wi)), wi, r)
        t.close("share of directions above", mass, 1 / (1 + r**4), reveal=True)


@check(
    "04.3.weight",
    task="04.3",
    points=3,
    calls=("ggx_pdf",),
    needs=("ggx_lobe",),
    tolerance=EXACT,
    hint="a sample's weight is the share of the facets seen that the light sees, too",
    sole="what the sampler is good for: no sample counts more than 1",
)
def weights_are_shares(t):
    """A sample's weight, lobe times cosine over density, is at most 1, and 1 for light from +z."""
    for r in t.rng.uniform(0.3, 1.0, 3):
        wo, wi = directions(t.rng, 60, 0.02), directions(t.rng, 60, 0.02)
        lobe, pdf = lobes(t, wo, wi, r), densities(t, wo, wi, r)
        t.require(
            bool((lobe * wi[:, 2] <= pdf * (1 + 1e-9)).all()),
            "no weight f cos / pdf of a perfect mirror may be more than 1",
        )
        up = viewer(1.0, 60)
        t.close(
            "density of wi = +z, which every facet sees",
            densities(t, wo, up, r),
            lobes(t, wo, up, r),
            reveal=True,
        )


@check(
    "04.3.below",
    task="04.3",
    points=1,
    calls=("ggx_pdf",),
    needs=("ggx_lobe",),
    hint="where a direction is not above the surface the density is exactly 0",
    sole="half of all directions",
)
def no_density_below(t):
    """A direction below the surface, and opposite ones: exactly 0. Above: more than 0."""
    wo, wi = buried(t.rng, 12)
    t.require(not densities(t, wo, wi, 0.5).any(), "below the surface it must be exactly 0")
    some = densities(t, directions(t.rng, 12), directions(t.rng, 12), 0.5)
    t.require(bool((some > 0).all()), "above the surface it must be more than 0")


# 04.4 ---------------------------------------------------------------------------------------------


def drawn(t, wo, r, u2):
    """`sample_ggx` of the submission."""
    return t.call("sample_ggx", wo, np.full(len(wo), float(r)), u2, returns=Array(wo.shape))


def twice(t, judge, text):
    """Require of random draws that one of two judgements is better than LEVEL."""
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
    w, solid_angles = dome(48, 96)
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
        {"advice": ""},
        arrays=(counts(wi, shares.shape) / len(wi), shares),
    )


@check(
    "04.4.mirror",
    task="04.4",
    points=2,
    calls=("sample_ggx",),
    tolerance=EXACT,
    hint="mirror: wi = 2 (wo . h) h - wo, with h a unit vector that has z > 0 and wo . h > 0",
    sole="what every single sample must satisfy",
)
def samples_are_mirrored_at_facets(t):
    """Unit vectors, each mirrored at a facet of the surface that the viewer sees."""
    for r in (0.1, 0.5, 1.0):
        wo = directions(t.rng, 200, 0.05)
        wi = drawn(t, wo, r, t.rng.random((200, 2)))
        t.close("lengths", np.linalg.norm(wi, axis=1), np.ones(200), reveal=True)
        h = wo + wi
        t.require(bool((h[:, 2] > 0).all()), "wo + wi must point upwards: a facet's normal does")
        t.require(bool(((wo * h).sum(axis=1) > 0).all()), "the viewer must see the facet")


@check(
    "04.4.rows",
    task="04.4",
    points=1,
    calls=("sample_ggx",),
    tolerance=EXACT,
    hint="nothing may be drawn in the function: the two numbers of a row decide about it",
    sole="the same numbers, the same directions: what debugging rests upon",
)
def numbers_decide(t):
    """The same rows of u2 give the same directions, in any order."""
    wo, u2 = directions(t.rng, 50), t.rng.random((50, 2))
    order = t.rng.permutation(50)
    t.close(
        "directions in another order",
        drawn(t, wo[order], 0.6, u2[order]),
        drawn(t, wo, 0.6, u2)[order],
    )


@check(
    "04.4.chi",
    task="04.4",
    points=4,
    calls=("sample_ggx",),
    needs=("ggx_lobe", "ggx_pdf"),
    hint="handout, equations (14) to (16); compare your samples with Figure 3",
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
    task="04.4",
    points=2,
    calls=("sample_ggx",),
    needs=("ggx_lobe", "ggx_pdf"),
    hint="mend 04.4.chi first",
    sole="what it is for: the mean of the weights is the furnace's albedo",
)
def weights_average_to_the_albedo(t):
    """The mean weight of 5,000 samples is the albedo that the lobe has in the furnace (z-test)."""
    wi, solid_angles = dome(64, 128)
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


# 04.5 ---------------------------------------------------------------------------------------------


def material(rng, n, low=0.3):
    """Base colors, metalness and roughness of n materials."""
    return rng.uniform(0.05, 0.95, (n, 3)), rng.uniform(0.1, 0.9, n), rng.uniform(low, 1.0, n)


def shaded(t, wo, wi, color, m, r):
    """`gltf` of the submission."""
    return t.call("gltf", wo, wi, color, m, r, returns=Array((len(wo), 3)))


@check(
    "04.5.straight",
    task="04.5",
    points=3,
    calls=("gltf",),
    needs=("ggx_lobe",),
    tolerance=EXACT,
    hint="straight on Schlick's ramp is 0: F is 0.04 for the varnish, the base color for metal",
    sole="ground, varnish and metal, each with a number of its own",
)
def straight_on(t):
    """Straight back, dielectric and metal can be worked out by head."""
    up = viewer(1.0, 6)
    color, _, r = material(t.rng, 6)
    height = (1 / (4 * np.pi * r**4))[:, None]
    t.close(
        "dielectric",
        shaded(t, up, up, color, np.zeros(6), r),
        0.96 * color / np.pi + 0.04 * height,
        reveal=True,
    )
    t.close("metal", shaded(t, up, up, color, np.ones(6), r), color * height, reveal=True)


@check(
    "04.5.mirror",
    task="04.5",
    points=2,
    calls=("gltf",),
    needs=("ggx_lobe",),
    tolerance=EXACT,
    hint="a white metal reflects all at every angle: what is left is the lobe",
    sole="all angles, where Schlick's ramp has nothing to say",
)
def white_metal_is_the_lobe(t):
    """White metal is `ggx_lobe`; black metal reflects only what Schlick's ramp gives it."""
    wo, wi = directions(t.rng, 20), directions(t.rng, 20)
    r = float(t.rng.uniform(0.3, 1.0))
    lobe = lobes(t, wo, wi, r)
    got = shaded(t, wo, wi, np.ones((20, 3)), np.ones(20), np.full(20, r))
    t.close("white metal", got, np.tile(lobe[:, None], 3), reveal=True)
    got = shaded(t, wo, wi, np.zeros((20, 3)), np.ones(20), np.full(20, r))
    twist = 1 - np.linalg.norm(wo + wi, axis=1) / 2  # 1 - <wo, wh>
    t.close("black metal", got, np.tile((twist**5 * lobe)[:, None], 3), reveal=True)


@check(
    "04.5.blend",
    task="04.5",
    points=2,
    calls=("gltf",),
    needs=("ggx_lobe",),
    tolerance=EXACT,
    hint="equation (20): blend the finished values, not what goes into them",
    sole="the trap of section 5",
)
def half_metal_is_half_of_each(t):
    """f is linear in the metalness: half metal is half of each, in each channel."""
    wo, wi = directions(t.rng, 20), directions(t.rng, 20)
    color, m, r = material(t.rng, 20)
    ends = [shaded(t, wo, wi, color, np.full(20, k), r) for k in (0.0, 1.0)]
    t.close(
        "blend", shaded(t, wo, wi, color, m, r), (1 - m)[:, None] * ends[0] + m[:, None] * ends[1]
    )


@check(
    "04.5.symmetry",
    task="04.5",
    points=1,
    calls=("gltf",),
    needs=("ggx_lobe",),
    tolerance=EXACT,
    hint="the angle of Fresnel's factor is that to the half vector; below the surface all is 0",
    sole="reciprocity, and nothing below",
)
def reciprocal_and_above(t):
    """Exchanging wo and wi changes nothing; below the surface everything is exactly 0."""
    wo, wi = directions(t.rng, 20), directions(t.rng, 20)
    given = material(t.rng, 20)
    t.close("f with wo and wi exchanged", shaded(t, wi, wo, *given), shaded(t, wo, wi, *given))
    wo, wi = buried(t.rng, 12)
    t.require(
        not shaded(t, wo, wi, *material(t.rng, 12)).any(), "below the surface f must be exactly 0"
    )


@check(
    "04.5.energy",
    task="04.5",
    points=1,
    calls=("gltf",),
    needs=("ggx_lobe",),
    tolerance=TABLE,
    hint="mend the checks above first",
    sole="what the furnace says: half metal lies between its ends",
)
def what_white_returns(t):
    """White of roughness 0.5, seen from 0.6: dielectric 1.0024, half metal 0.9371, metal 0.8717."""
    wi, solid_angles = dome(64, 128)
    got = []
    for m in (0.0, 0.5, 1.0):
        f = shaded(
            t,
            viewer(0.6, len(wi)),
            wi,
            np.ones((len(wi), 3)),
            np.full(len(wi), m),
            np.full(len(wi), 0.5),
        )
        got.append((solid_angles * wi[:, 2]) @ f[:, 1])
    t.close(
        "albedo of dielectric, half metal and metal",
        np.array(got),
        [1.002399, 0.937060, 0.871721],
        reveal=True,
    )


# 04.6 ---------------------------------------------------------------------------------------------

PARAMETERS = ("base_color", "metalness", "roughness")
NAMES = tuple(f"d_{name}" for name in PARAMETERS)


def slopes(t, wo, wi, color, m, r, g):
    """`gltf_backward` of the submission, by name."""
    n = len(wo)
    parts = Items(Array((n, 3)), Array((n,)), Array((n,)), names=NAMES)
    got = t.call("gltf_backward", wo, wi, color, m, r, g, returns=parts)
    return dict(zip(PARAMETERS, got, strict=True))


def near_mirrors(rng, n):
    """Pairs near the mirror direction, where the lobe is, and pairs anywhere."""
    wo = directions(rng, n, 0.3)
    wi = wo * [-1, -1, 1] + rng.normal(size=(n, 3)) * 0.15
    wi[: n // 3] = directions(rng, n // 3, 0.3)
    wi[:, 2] = np.abs(wi[:, 2])
    return wo, wi / np.linalg.norm(wi, axis=1, keepdims=True)


@check(
    "04.6.differences",
    task="04.6",
    points=5,
    calls=("gltf_backward",),
    needs=("ggx_lobe", "gltf"),
    tolerance=SMOOTH,
    hint="handout, section 6: first color and metalness, then the logarithm of D V",
    sole="the derivative itself, without the reference",
)
def agrees_with_differences(t):
    """Moving one parameter a little moves your f as your derivatives say."""
    wo, wi = near_mirrors(t.rng, 6)
    color, m, r = material(t.rng, 6)
    g = random_cotangent(t.rng, (6, 3))
    got = slopes(t, wo, wi, color, m, r, g)

    def forward(p):
        return shaded(t, wo, wi, *(p[name] for name in PARAMETERS))

    here = dict(zip(PARAMETERS, (color, m, r), strict=True))
    require_gradients(t, got, forward, here, g, SMOOTH)


@check(
    "04.6.straight",
    task="04.6",
    points=2,
    calls=("gltf_backward",),
    needs=("ggx_lobe", "gltf"),
    tolerance=EXACT,
    hint="roughness^-4 has the derivative -4 roughness^-5; alpha is the roughness squared",
    sole="the roughness alone, where it can be worked out by head",
)
def the_peak_sinks(t):
    """Straight back the lobe is 1 / (4 pi roughness^4), and so is its derivative known."""
    up = viewer(1.0, 5)
    color, _, r = material(t.rng, 5)
    g = random_cotangent(t.rng, (5, 3))
    for m, F in ((np.zeros(5), np.full((5, 3), 0.04)), (np.ones(5), color)):
        got = slopes(t, up, up, color, m, r, g)
        right = -np.sum(g * F, axis=1) / (np.pi * r**5)
        t.close("d_roughness straight back", got["roughness"], right, reveal=True)


@check(
    "04.6.linear",
    task="04.6",
    points=3,
    calls=("gltf_backward",),
    needs=("ggx_lobe", "gltf"),
    tolerance=EXACT,
    hint="f is a constant plus something times the base color; and linear in the metalness",
    sole="all digits, where differences have nine",
)
def color_and_metalness_are_linear(t):
    """f is linear in color and in metalness: any step, not only a small one, fits."""
    wo, wi = near_mirrors(t.rng, 20)
    color, m, r = material(t.rng, 20)
    g = random_cotangent(t.rng, (20, 3))
    got = slopes(t, wo, wi, color, m, r, g)
    here, step = shaded(t, wo, wi, color, m, r), t.rng.uniform(-0.5, 0.5, (20, 3))
    there = shaded(t, wo, wi, color + step, m, r)
    t.close("<step, d_base_color>", got["base_color"] * step, (there - here) * g)
    step = t.rng.uniform(0.2, 0.5, 20)
    there = shaded(t, wo, wi, color, m + step, r)
    t.close("step times d_metalness", got["metalness"] * step, np.sum((there - here) * g, axis=1))


@check(
    "04.6.zero",
    task="04.6",
    points=2,
    calls=("gltf_backward",),
    needs=("ggx_lobe", "gltf"),
    tolerance=EXACT,
    hint="below the surface f is 0 whatever the parameters; rows do not know of each other",
    sole="what must not leak: below the surface, and from row to row",
)
def nothing_leaks(t):
    """No derivative below the surface or of no loss; each row minds its own."""
    wo, wi = buried(t.rng, 12)
    given = material(t.rng, 12)
    g = random_cotangent(t.rng, (12, 3))
    for name, values in slopes(t, wo, wi, *given, g).items():
        t.require(not values.any(), f"d_{name} must be exactly 0 below the surface")
    wo, wi = near_mirrors(t.rng, 12)
    require_zero_for_zero(t, slopes(t, wo, wi, *given, 0 * g))
    order = t.rng.permutation(12)
    whole = slopes(t, wo, wi, *given, g)
    moved = slopes(t, wo[order], wi[order], *(each[order] for each in given), g[order])
    for name, values in whole.items():
        t.close(f"d_{name} in another order", moved[name], values[order])


# >>> hidden
def some_model(t, n):
    """A model that `furnace` integrates, and the cosines of n viewers."""
    a, b = t.rng.uniform(0.5, 2.0, (3, 2)), t.rng.uniform(0.3, 1.0, (1, 2))
    return lambda wo, wi: np.exp(wi @ a * wo[:, 2:]) * b + wo @ a, t.rng.uniform(0.1, 1.0, n)


def pairs(t, n):
    """Pairs of directions and their roughness."""
    return directions(t.rng, n), directions(t.rng, n), t.rng.uniform(0.3, 1.0, n)


def painted(t, n):
    """What `gltf` takes."""
    return *pairs(t, n)[:2], *material(t.rng, n)


@check(
    "04.1.hidden",
    task="04.1",
    points=2,
    calls=("furnace",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes with models that are not known beforehand",
    battery=[Subject("furnace", some_model, lambda n: Array((n, 2)), rows=(1,))],
)
def other_models(t):
    """A model that nobody has seen is integrated rightly."""
    a, b = t.rng.uniform(0.5, 2.0, (3, 2)), t.rng.uniform(0.3, 1.0, (1, 2))
    cosines = t.rng.uniform(0.1, 1.0, 3)

    def value(wo, wi):
        return np.exp(wi @ a * wo[:, 2:]) * b + wo @ a

    right = t.reference.furnace(value, cosines)
    t.close("albedo", room(t, value, 2, cosines), right)


@check(
    "04.2.hidden",
    task="04.2",
    points=3,
    calls=("ggx_lobe",),
    visibility="hidden",
    tolerance=SHARP,
    sole="the same mistakes at unknown directions, and on polished surfaces",
    battery=[Subject("ggx_lobe", pairs, lambda n: Array((n,)), rows=(0, 1, 2))],
)
def lobes_anywhere(t):
    """The lobe is right anywhere, and where it is sharp."""
    wo, wi = directions(t.rng, 60, 0.02), directions(t.rng, 60, 0.02)
    r = t.rng.uniform(0.3, 1.0, 60)
    got = t.call("ggx_lobe", wo, wi, r, returns=Array((60,)))
    t.close("lobe", got, t.reference.ggx_lobe(wo, wi, r))
    for sharp in (0.045, 0.15):
        wi = wo * [-1, -1, 1] + t.rng.normal(size=(60, 3)) * sharp**2 / 3
        wi /= np.linalg.norm(wi, axis=1, keepdims=True)
        right = t.reference.ggx_lobe(wo, wi, np.full(60, sharp))
        t.close(f"lobe at roughness {sharp}", lobes(t, wo, wi, sharp), right)


@check(
    "04.3.hidden",
    task="04.3",
    points=2,
    calls=("ggx_pdf",),
    needs=("ggx_lobe",),
    visibility="hidden",
    tolerance=SHARP,
    sole="the same mistakes at directions that are not known beforehand",
    battery=[Subject("ggx_pdf", pairs, lambda n: Array((n,)), rows=(0, 1, 2))],
)
def densities_anywhere(t):
    """The density is right anywhere."""
    wo, wi = directions(t.rng, 60, 0.02), directions(t.rng, 60, 0.02)
    r = t.rng.uniform(0.1, 1.0, 60)
    got = t.call("ggx_pdf", wo, wi, r, returns=Array((60,)))
    t.close("density", got, t.reference.ggx_pdf(wo, wi, r))


@check(
    "04.4.hidden",
    task="04.4",
    points=3,
    calls=("sample_ggx",),
    visibility="hidden",
    sole="the right density, whatever that of the submission is",
    battery=[
        Subject(
            "sample_ggx",
            lambda t, n: (directions(t.rng, n), t.rng.uniform(0.3, 1.0, n), t.rng.random((n, 2))),
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


@check(
    "04.5.hidden",
    task="04.5",
    points=3,
    calls=("gltf",),
    needs=("ggx_lobe",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes with materials that are not known beforehand",
    battery=[Subject("gltf", painted, lambda n: Array((n, 3)), rows=range(5))],
)
def materials_anywhere(t):
    """Random materials, the ends of all parameters among them."""
    wo, wi = directions(t.rng, 60, 0.02), directions(t.rng, 60, 0.02)
    color, m, r = material(t.rng, 60)
    m[:10], m[10:20], color[20:30] = 0.0, 1.0, np.eye(3)[t.rng.integers(0, 3, 10)]
    t.close("f", shaded(t, wo, wi, color, m, r), t.reference.gltf(wo, wi, color, m, r))


@check(
    "04.6.hidden",
    task="04.6",
    points=4,
    calls=("gltf_backward",),
    needs=("ggx_lobe", "gltf"),
    visibility="hidden",
    tolerance=EXACT,
    sole="eleven digits, which differences do not have",
    battery=[
        Subject(
            "gltf_backward",
            lambda t, n: (*painted(t, n), random_cotangent(t.rng, (n, 3))),
            lambda n: Items(Array((n, 3)), Array((n,)), Array((n,)), names=NAMES),
            rows=range(6),
        )
    ],
)
def derivatives_anywhere(t):
    """Every part of the adjoint is right to eleven digits."""
    wo, wi = near_mirrors(t.rng, 60)
    color, m, r = material(t.rng, 60)
    g = random_cotangent(t.rng, (60, 3))
    right = t.reference.gltf_backward(wo, wi, color, m, r, g)
    for name, mine, theirs in zip(
        NAMES, slopes(t, wo, wi, color, m, r, g).values(), right, strict=True
    ):
        t.close(name, mine, theirs)


# <<< hidden

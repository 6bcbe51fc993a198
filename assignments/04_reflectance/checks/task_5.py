"""Task 04.5, public checks."""

import numpy as np
from photograd_course.grading import checks_for
from photograd_course.grading.generators import hemisphere_quadrature, upper_directions

from .common import EXACT, TABLE, buried, lobes, material, shaded, viewer

check = checks_for(calls=("gltf",), needs=("ggx_lobe",), tolerance=EXACT)

WHITE = "a white metal reflects everything at every angle: what is left is the lobe"
BLACK = "for a black metal F(0) = (1 - <wo, wh>)^5: which cosine does your F use?"


@check(
    "04.5.straight",
    points=3,
    hint="straight on <wo, wh> is 1: F is 0.04 for the coating, the base color for metal",
    sole="base layer, coating and metal, each with a number of its own",
)
def straight_on(t):
    """Straight back, dielectric and metal can be worked out by hand."""
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
    points=2,
    hint="equation (18): a metal is F times the lobe, and F depends on <wo, wh>",
    sole="all angles: white, where F is 1, and black, where F is (1 - <wo, wh>)^5",
)
def white_metal_is_the_lobe(t):
    """White metal is `ggx_lobe`; black metal has F(0) = (1 - <wo, wh>)^5 of it."""
    wo, wi = upper_directions(t.rng, 20), upper_directions(t.rng, 20)
    r = float(t.rng.uniform(0.3, 1.0))
    lobe = lobes(t, wo, wi, r)
    got = shaded(t, wo, wi, np.ones((20, 3)), np.ones(20), np.full(20, r))
    t.close("white metal", got, np.tile(lobe[:, None], 3), reveal=True, hint=WHITE)
    got = shaded(t, wo, wi, np.zeros((20, 3)), np.ones(20), np.full(20, r))
    twist = 1 - np.linalg.norm(wo + wi, axis=1) / 2  # 1 - <wo, wh>
    right = np.tile((twist**5 * lobe)[:, None], 3)
    t.close("black metal", got, right, reveal=True, hint=BLACK)


@check(
    "04.5.blend",
    points=2,
    hint="equation (20): blend the values of the BRDFs, not f0",
    sole="the trap of section 5",
)
def half_metal_is_half_of_each(t):
    """f is linear in the metalness: half metal is half of each, in each channel."""
    wo, wi = upper_directions(t.rng, 20), upper_directions(t.rng, 20)
    color, m, r = material(t.rng, 20)
    ends = [shaded(t, wo, wi, color, np.full(20, k), r) for k in (0.0, 1.0)]
    t.close(
        "blend", shaded(t, wo, wi, color, m, r), (1 - m)[:, None] * ends[0] + m[:, None] * ends[1]
    )


@check(
    "04.5.symmetry",
    points=1,
    hint="the angle of F is that between wo and the half vector; below the surface all is 0",
    sole="reciprocity, and nothing below",
)
def reciprocal_and_above(t):
    """Exchanging wo and wi changes nothing; below the surface everything is exactly 0."""
    wo, wi = upper_directions(t.rng, 20), upper_directions(t.rng, 20)
    given = material(t.rng, 20)
    t.close("f with wo and wi exchanged", shaded(t, wi, wo, *given), shaded(t, wo, wi, *given))
    wo, wi = buried(t.rng, 12)
    t.require(
        not shaded(t, wo, wi, *material(t.rng, 12)).any(), "below the surface f must be exactly 0"
    )


@check(
    "04.5.energy",
    points=1,
    tolerance=TABLE,
    hint="equation (20) once more, summed over the hemisphere",
    sole="what the furnace says: half metal lies between its ends",
)
def what_white_returns(t):
    """White of roughness 0.5, seen from 0.6: dielectric 1.0024, half metal 0.9371, metal 0.8717."""
    wi, solid_angles = hemisphere_quadrature(64, 128)
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

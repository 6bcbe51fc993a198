"""Task 04.2, public checks."""

import math

import numpy as np
from photograd_course.grading import checks_for
from photograd_course.grading.generators import hemisphere_quadrature, upper_directions

from .common import EXACT, TABLE, buried, lobes, turned, viewer

check = checks_for(calls=("ggx_lobe",), tolerance=EXACT)


@check(
    "04.2.peak",
    points=2,
    hint="equations (8) and (10): alpha is the roughness squared; straight on q is 1 and S is 2",
    sole="one number that can be worked out by hand",
)
def straight_back(t):
    """Light that comes from and goes to straight above: 1 / (4 pi roughness^4)."""
    up = viewer(1.0, 1)
    for r in t.rng.uniform(0.2, 1.0, 4):
        t.close("lobe straight back", lobes(t, up, up, r), [1 / (4 * np.pi * r**4)], reveal=True)


@check(
    "04.2.ball",
    points=2,
    hint="at roughness 1 stretching changes nothing: q = 1, and both lengths are 1",
    sole="the roughest surface in closed form, from all sides",
)
def the_roughest_surface(t):
    """At roughness 1 facets lie as on a ball: the lobe is 1 / (2 pi (o_z + i_z))."""
    wo, wi = upper_directions(t.rng, 20), upper_directions(t.rng, 20)
    right = 1 / (2 * np.pi * (wo[:, 2] + wi[:, 2]))
    t.close("lobe at roughness 1", lobes(t, wo, wi, 1.0), right, reveal=True)


@check(
    "04.2.symmetry",
    points=2,
    hint="every formula of section 2 treats wo and wi alike",
    sole="reciprocity: light could go the other way",
)
def light_could_go_the_other_way(t):
    """Exchanging wo and wi, or turning both around the normal, changes nothing."""
    for r in t.rng.uniform(0.3, 1.0, 3):
        wo, wi = upper_directions(t.rng, 20), upper_directions(t.rng, 20)
        there = lobes(t, wo, wi, r)
        t.close("lobe with wo and wi exchanged", lobes(t, wi, wo, r), there)
        angle = float(t.rng.uniform(0.5, 3.0))
        t.close(
            "lobe of turned directions", lobes(t, turned(wo, angle), turned(wi, angle), r), there
        )


@check(
    "04.2.below",
    points=1,
    hint="where a direction is not above the surface the lobe is exactly 0 (0 times infinity "
    "is not 0: choose with np.where)",
    sole="half of all directions",
    tolerance=None,
)
def nothing_below_the_surface(t):
    """A direction below the surface, and opposite ones: exactly 0. Above: more than 0."""
    wo, wi = buried(t.rng, 12)
    t.require(not lobes(t, wo, wi, 0.5).any(), "below the surface the lobe must be exactly 0")
    some = lobes(t, upper_directions(t.rng, 12), upper_directions(t.rng, 12), 0.5)
    t.require(bool((some > 0).all()), "above the surface the lobe must be more than 0")


# What a surface of microfacets with F = 1 returns: roughness, cosine of the viewer, albedo.
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
    points=4,
    tolerance=TABLE,
    hint="handout, section 2: D must cover the surface once, (7); V of (10) is already divided by "
    "4 o_z i_z",
    sole="the furnace decides: what each roughness returns, 1 - ln 2 among it",
)
def what_mirrors_return(t):
    """What surfaces of microfacets with F = 1 return: 1 - ln 2 at roughness 1, seen from above."""
    wi, solid_angles = hemisphere_quadrature(64, 160)
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

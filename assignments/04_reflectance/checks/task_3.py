"""Task 04.3, public checks."""

import numpy as np
from photograd_course.grading import checks_for
from photograd_course.grading.generators import hemisphere_quadrature, upper_directions

from .common import EXACT, TABLE, buried, densities, lobes, viewer

check = checks_for(calls=("ggx_pdf",), needs=("ggx_lobe",))


@check(
    "04.3.ball",
    points=2,
    tolerance=EXACT,
    hint="at roughness 1: D = 1 / pi, G1(wo) = 2 o_z / (1 + o_z); and (13): where reflection "
    "spreads directions out, the density gets smaller",
    sole="the roughest surface in closed form",
)
def a_ball_spreads_evenly(t):
    """At roughness 1 a viewer's reflected directions are uniform: 1 / (2 pi (1 + o_z))."""
    wo, wi = upper_directions(t.rng, 20), upper_directions(t.rng, 20)
    right = 1 / (2 * np.pi * (1 + wo[:, 2]))
    t.close("density at roughness 1", densities(t, wo, wi, 1.0), right, reveal=True)


@check(
    "04.3.mass",
    points=3,
    tolerance=TABLE,
    hint="equations (12) and (13): turning a facet by an angle turns the reflected direction by "
    "two, which spreads the same samples over more directions",
    sole="a density is known by its integral",
)
def what_stays_above(t):
    """Seen from straight above, facets steeper than 45 degrees reflect downward: the rest stays."""
    wi, solid_angles = hemisphere_quadrature(96, 16)
    for r in t.rng.uniform(0.6, 1.0, 3):
        mass = solid_angles @ densities(t, viewer(1.0, len(wi)), wi, r)
        t.close("share of directions above", mass, 1 / (1 + r**4), reveal=True)


@check(
    "04.3.weight",
    points=3,
    tolerance=EXACT,
    hint="a weight is the fraction of the facets visible to the viewer that the light reaches as "
    "well: G1 is that of wo",
    sole="what the sampler is good for: no sample counts more than 1",
)
def weights_are_shares(t):
    """A sample's weight, lobe times cosine over density, is at most 1, and 1 for light from +z."""
    for r in t.rng.uniform(0.3, 1.0, 3):
        wo, wi = upper_directions(t.rng, 60, 0.02), upper_directions(t.rng, 60, 0.02)
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
    points=1,
    hint="where a direction is not above the surface the density is exactly 0",
    sole="half of all directions",
)
def no_density_below(t):
    """A direction below the surface, and opposite ones: exactly 0. Above: more than 0."""
    wo, wi = buried(t.rng, 12)
    t.require(not densities(t, wo, wi, 0.5).any(), "below the surface it must be exactly 0")
    some = densities(t, upper_directions(t.rng, 12), upper_directions(t.rng, 12), 0.5)
    t.require(bool((some > 0).all()), "above the surface it must be more than 0")

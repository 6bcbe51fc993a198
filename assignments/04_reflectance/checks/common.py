"""Helpers for the checks of several tasks."""

import math

import numpy as np
from photograd_course.grading import Array, Tolerance
from photograd_course.grading.generators import upper_directions

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


def viewer(z, n):
    """(n, 3), all the direction of height z in the plane y = 0."""
    return np.tile([math.sqrt(1 - z * z), 0.0, z], (n, 1))


def turned(w, angle):
    """Directions turned around the normal."""
    c, s = math.cos(angle), math.sin(angle)
    return w @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def buried(rng, n):
    """Pairs of directions of which at least one is below the surface or in it."""
    wo, wi = upper_directions(rng, n), upper_directions(rng, n)
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


def material(rng, n, low=0.3):
    """Base colors, metalness and roughness of n materials."""
    return rng.uniform(0.05, 0.95, (n, 3)), rng.uniform(0.1, 0.9, n), rng.uniform(low, 1.0, n)


def shaded(t, wo, wi, color, m, r):
    """`gltf` of the submission."""
    return t.call("gltf", wo, wi, color, m, r, returns=Array((len(wo), 3)))

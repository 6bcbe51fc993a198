"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Array, Tolerance

# Evidence: worst of the solution and three alternatives, against the nearest of 87 named wrong
# solutions.
EXACT = Tolerance(
    1e-11,
    "right ones differ by at most 3e-15, the nearest wrong one (d_coefficients_of_all) by 0.04",
)


def sphere(degree, caps=False):
    """Directions and weights, exact for polynomials up to a degree; with caps z > 0 only."""
    z, share = np.polynomial.legendre.leggauss(degree // 2 + 1)
    if caps:
        z, share = (z + 1) / 2, share / 2
    phi = np.arange(degree + 1) * (2 * np.pi / (degree + 1)) + 0.1
    z, phi = (a.ravel() for a in np.meshgrid(z, phi, indexing="ij"))
    r = np.sqrt(1 - z * z)
    weights = np.repeat(share, degree + 1) * (2 * np.pi / (degree + 1))
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1), weights


def band(ell):
    """The columns of degree l."""
    return slice(ell * ell, (ell + 1) ** 2)


def basis(t, d, degree):
    """`sh_basis` of the submission."""
    return t.call("sh_basis", d, degree, returns=Array((len(d), (degree + 1) ** 2)))

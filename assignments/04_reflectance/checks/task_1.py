"""Task 04.1, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import EXACT, SHARP

check = checks_for(calls=("furnace",), tolerance=EXACT)


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
    points=3,
    hint="equation (5): each direction has its own solid angle; one row (C,) for each viewer",
    sole="the one model whose albedo is known",
)
def a_matte_surface_returns_its_albedo(t):
    """f = albedo / pi returns the albedo for every viewer."""
    albedo, cosines = t.rng.uniform(0.2, 1.0, 3), t.rng.uniform(0.1, 1.0, 4)
    got = room(t, lambda wo, wi: 0 * wi + albedo / np.pi + 0 * wo, 3, cosines)
    t.close("albedo", got, np.tile(albedo, (4, 1)), reveal=True)


@check(
    "04.1.shapes",
    points=3,
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
    points=2,
    hint="equation (5) once more, for a BRDF that is brighter toward the horizon",
    sole="the first discovery: a famous model that is not energy-conserving",
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

"""Task 11.5, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.generators import random_rotation, unit_vectors

from .common import EXACT, basis, sphere

check = checks_for(calls=("probe_irradiance",), needs=("sh_basis",), tolerance=EXACT)


def lit(t, probes, p, n):
    """`probe_irradiance` of the submission."""
    return t.call("probe_irradiance", probes, p, n, returns=Array((len(p), probes.shape[4])))


@check(
    "11.5.constant",
    points=2,
    hint="a white sky of radiance 1 gives the irradiance pi: the factor of degree 0",
    sole="sees nothing but degree 0 and the sum of the weights",
)
def a_constant_sky(t):
    """Radiance 1 from everywhere is the irradiance pi, at any point, on any surface."""
    probes = np.zeros((3, 2, 4, 9, 1))
    probes[..., 0, :] = np.sqrt(4 * np.pi)
    p = t.rng.uniform(-0.5, 3.5, (20, 3))
    t.close(
        "irradiance",
        lit(t, probes, p, unit_vectors(t.rng, 20)),
        np.full((20, 1), np.pi),
        reveal=True,
    )


@check(
    "11.5.lambert",
    points=3,
    hint="handout, equations (17) and (18): one factor for each degree",
    sole="the integral that the factors stand for",
)
def irradiance_is_the_integral(t):
    """One probe: irradiance is the integral of light times cosine, for light of degree 4 too."""
    half, weights = sphere(8, caps=True)
    for degree in (1, 2, 4):
        c = t.rng.uniform(-1.0, 1.0, ((degree + 1) ** 2, 2))
        probes, turns = c[None, None, None], [random_rotation(t.rng) for _ in range(5)]
        expected = [(weights * half[:, 2]) @ basis(t, half @ R.T, degree) @ c for R in turns]
        normals = np.stack([R[:, 2] for R in turns])
        got = lit(t, probes, t.rng.uniform(-1.0, 1.0, (5, 3)), normals)
        t.close(f"irradiance, degree {degree}", got, np.stack(expected))


@check(
    "11.5.blend",
    points=3,
    hint="handout, equation (19): eight probes, the weights of `corners`",
    sole="looks at the interpolation, whatever the factors",
)
def an_even_change_is_blended_exactly(t):
    """Linear functions of the probe are interpolated exactly; border values are repeated."""
    shape = (4, 3, 2)
    start, slopes = t.rng.uniform(-1.0, 1.0, (9, 2)), t.rng.uniform(-1.0, 1.0, (3, 9, 2))
    cells = np.stack(np.indices(shape), axis=-1)
    probes = start + np.einsum("xyzi,ikc->xyzkc", cells, slopes)
    p, n = t.rng.uniform(-0.5, 3.5, (15, 3)), unit_vectors(t.rng, 15)
    inside = np.clip(p, 0, np.array(shape) - 1)
    alone = [start + np.einsum("i,ikc->kc", place, slopes) for place in inside]
    expected = [
        lit(t, c[None, None, None], p[:1] * 0, n[k : k + 1])[0] for k, c in enumerate(alone)
    ]
    t.close("irradiance", lit(t, probes, p, n), np.stack(expected))

"""Task 06.5, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, GATE

check = checks_for(calls=("tone_map",), tolerance=EXACT)
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def toned(t, radiance, settings, d_shown):
    """(shown, d_radiance, d_settings) of the submission."""
    shape = Array(radiance.shape)
    spec = Items(shape, shape, Array((2,)), names=("shown", "d_radiance", "d_settings"))
    return t.call("tone_map", radiance, settings, d_shown, returns=spec)


def case(t, height=3, width=4):
    """radiance, settings, d_shown."""
    radiance = t.rng.uniform(0.05, 6.0, (height, width, 3))
    settings = np.array([t.rng.uniform(-1.5, 1.5), t.rng.uniform(1.5, 5.0)])
    return radiance, settings, random_cotangent(t.rng, radiance.shape)


@check(
    "06.5.curve",
    points=4,
    hint="handout, equations (19) and (20): the exposure first; one factor for all three channels",
    sole="the curve, with values that are known",
)
def values_of_the_curve(t):
    """Black stays black, the luminance `white` becomes 1, and ratios between channels stay."""
    for white, exposure in ((1.5, 0.0), (4.0, 1.5), (3.0, -2.0)):
        settings, scale = np.array([exposure, white]), 2.0**exposure
        color = t.rng.uniform(0.2, 1.0, (1, 4, 3))
        color *= (white / scale / (color @ LUMINANCE))[..., None]
        color[0, 0] = 0.0
        shown, *_ = toned(t, color, settings, 0 * color)
        right = color * scale / white
        t.close("shown, of black and of the luminance white", shown, right, reveal=True)
        gray = np.tile(np.linspace(0.01, 3 * white, 30)[None, :, None], (1, 1, 3)) / scale
        shown, *_ = toned(t, gray, settings, 0 * gray)
        t.require(bool((np.diff(shown[0, :, 0]) > 0).all()), "a brighter gray is shown brighter")
    gray = np.array([[[0.5] * 3, [1.0] * 3, [3.0] * 3]])
    shown, *_ = toned(t, gray, np.array([1.0, 2.0]), 0 * gray)
    t.close("shown, of three grays", shown[0, :, 0], [0.625, 1.0, 15.0 / 7.0], reveal=True)


@check(
    "06.5.differences",
    points=4,
    tolerance=GATE,
    hint="handout, equations (21) to (23): the factor depends on all three channels",
    adjoints=("tone_map",),
    sole="the adjoint against finite differences",
)
def the_adjoint_agrees_with_finite_differences(t):
    """Derivatives with respect to radiance, exposure and white, of your own forward pass."""
    for _ in range(3):
        radiance, settings, g = case(t)
        _, d_radiance, d_settings = toned(t, radiance, settings, g)

        def forward(at, g=g):
            given = at["radiance"], np.concatenate([at["exposure"], at["white"]])
            return toned(t, *given, np.zeros_like(g))[0]

        point = {"radiance": radiance, "exposure": settings[:1], "white": settings[1:]}
        got = {"radiance": d_radiance, "exposure": d_settings[:1], "white": d_settings[1:]}
        agrees_with_finite_differences(t, got, forward, point, g)
    zero = toned(t, radiance, settings, np.zeros_like(g))
    require_zero_for_zero(t, {"radiance": zero[1], "settings": zero[2]})


@check(
    "06.5.exposure",
    points=1,
    hint="handout, equations (21) to (23): the derivative with respect to the exposure",
    sole="what the adjoint is for",
)
def an_exposure_is_found_by_descent(t):
    """Descent in the exposure finds the one with which a target was made."""
    radiance = t.rng.uniform(0.05, 3.0, (6, 8, 3))
    right, settings = t.rng.uniform(0.6, 1.2), np.array([0.0, 3.0])
    zeros = np.zeros_like(radiance)
    target, *_ = toned(t, radiance, np.array([right, 3.0]), zeros)
    for _ in range(60):
        shown, *_ = toned(t, radiance, settings, zeros)
        *_, d_settings = toned(t, radiance, settings, 2 * (shown - target))
        settings[0] -= 3.0 / radiance.size * d_settings[0]
    off = abs(settings[0] - right)
    t.require(
        bool(off < 1e-3), f"after 60 steps the exposure is off by {off:.1e} stops: threshold 1e-3"
    )

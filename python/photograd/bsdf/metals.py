"""Complex refractive indices of metals, for the conductors of `photograd.bsdf`."""

from __future__ import annotations

METALS = {
    "copper": {"eta": (0.30, 1.02, 1.24), "k": (3.205, 2.577, 2.397)},
    "gold": {"eta": (0.21, 0.43, 1.38), "k": (3.272, 2.455, 1.914)},
    "silver": {"eta": (0.06, 0.06, 0.04), "k": (4.152, 3.586, 2.657)},
}
"""eta + i k at 617, 549 and 451 nm for red, green and blue, as measured [Johnson1972].

Three wavelengths stand for three channels: a rendering of the whole spectrum would be less
saturated. Values go into a model as they are: `model.f({"roughness": 0.3, **METALS["gold"]}, ...)`.
"""

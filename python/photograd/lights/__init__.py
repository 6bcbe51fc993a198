"""Lights as a path tracer sees them: samples, radiance, density, and derivatives.

All are objects of numbers and arrays; `sample(points, u2)` samples one direction for each point,
`L(points, w)` (radiance) and `pdf(points, w)` are those of given directions. What stands between a
point and a light is the tracer's business. Derivatives are with respect to emission and texels, and
for a spot to the shape of its cone; positions are constants, since moving them moves the edges of
shadows. `registry()` has the classes of all lights of a few numbers.

`photograd.lights.prefilter` averages lights at infinity beforehand, for shading by lookups.
"""

from __future__ import annotations

from photograd.lights.base import Light, LightSamples
from photograd.lights.environment import EnvironmentMap, about_y
from photograd.lights.registered import (
    ConstantLight,
    DirectionalLight,
    PointLight,
    QuadLight,
    RegisteredLight,
    SkyLight,
    SphereLight,
    SpotLight,
    SunLight,
    TriangleLight,
    cap_height,
    registry,
)

__all__ = [
    "ConstantLight",
    "DirectionalLight",
    "EnvironmentMap",
    "Light",
    "LightSamples",
    "PointLight",
    "QuadLight",
    "RegisteredLight",
    "SkyLight",
    "SphereLight",
    "SpotLight",
    "SunLight",
    "TriangleLight",
    "about_y",
    "cap_height",
    "registry",
]

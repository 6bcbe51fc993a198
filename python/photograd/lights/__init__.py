"""Lights as a path tracer sees them: samples, radiance, density, and derivatives.

All are objects of numbers and arrays; `sample(points, u2)` draws one direction for each point,
`L(points, w)` (radiance) and `pdf(points, w)` ask about given ones. What stands between a point
and a light is the tracer's business. Derivatives are by emission and texels, and for a spot by
the shape of its cone; places are constants, since moving them moves the edges of shadows.

`photograd.lights.distant` has the lights at infinity as functions of direction alone;
`photograd.lights.prefilter` averages them beforehand, for shading by lookups.
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
]

"""Every light at infinity: its density, and what sun and sky are. More: test_sampled_lights.py."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.lights import RegisteredLight, SkyLight, SunLight, cap_height, registry
from photograd_course.random import uniform

from support.statistics import chi_square_p, sidak, sphere_cell_masses, sphere_counts

DIRECTION = np.array([2.0, 3.0, -6.0]) / 7.0
CONSTANTS: dict[str, dict[str, Any]] = {
    "sun": {"direction": DIRECTION, "height": cap_height(0.3)},
    "sky": {},
    "constant": {},
}


def light_of(name: str, **constants: Any) -> RegisteredLight:
    values = {**CONSTANTS[name], **constants}
    for number, parameter in enumerate(registry()[name].parameters()):
        u = uniform(3, step=number, pixel=np.arange(parameter.size))
        values[parameter.name] = parameter.lo + (parameter.hi - parameter.lo) * (0.1 + 0.8 * u)
    return registry()[name](**values)


def origin(w: Any) -> Any:
    """Where they are seen from, (N, 3)."""
    return np.zeros((len(w), 3), w.dtype)


@pytest.mark.parametrize("name", sorted(CONSTANTS))
def test_samples_have_the_stated_density(name: str) -> None:
    # The sun is around +Z, so that rows of equal height follow its rim.
    light = light_of(name, **({"direction": [0.0, 0.0, 1.0]} if name == "sun" else {}))
    samples = 1_000_000
    u2 = uniform(6, pixel=np.arange(samples)[:, None], dimension=np.arange(2))
    w = light.sample(origin(u2), u2).direction
    np.testing.assert_allclose(np.linalg.norm(w, axis=1), 1.0, atol=1e-12)
    low = 1.0 - CONSTANTS["sun"]["height"] if name == "sun" else -1.0
    z = np.linspace(low, 1.0, 21)
    masses = sphere_cell_masses(lambda v: light.pdf(origin(v), v), z, 40)
    np.testing.assert_allclose(masses.sum(), 1.0, rtol=1e-9)
    # Fixed seed; right samplers would fail for one seed in a hundred.
    assert chi_square_p(sphere_counts(w, z, 40), masses) > sidak(0.01, len(CONSTANTS))
    assert (light.L(origin(w), w) > 0).all(), "every sample sees the light"


@pytest.mark.parametrize("dtype", ["f4", "f8"])
@pytest.mark.parametrize("angle", [0.00465, 0.05, 0.5])
def test_irradiance_of_the_sun(angle: float, dtype: str) -> None:
    # The integral of L cos over a disc of angular radius a around the normal is pi L sin^2(a).
    sun = SunLight(radiance=np.ones(3), direction=DIRECTION, height=cap_height(angle))
    u2 = uniform(7, pixel=np.arange(100_000)[:, None], dimension=np.arange(2)).astype(dtype)
    w = sun.sample(origin(u2), u2).direction
    pdf = sun.pdf(origin(w), w)
    assert (pdf > 0).all(), "no sample on the rim is lost to rounding"
    estimate = (sun.L(origin(w), w)[:, 0] * (w @ DIRECTION) / pdf).mean()
    # The cosine varies by a^2 / 2 at most, so the error is far below this even in float.
    np.testing.assert_allclose(estimate, np.pi * np.sin(angle) ** 2, rtol=1e-3)


def test_radiance_of_the_sky_by_height() -> None:
    sky = SkyLight(zenith=[1.0, 0, 0], horizon=[0, 1.0, 0], ground=[0, 0, 1.0])
    w = np.array([[0, 1.0, 0], [1.0, 0, 0], [0, -1.0, 0], [0.8, 0.6, 0], [0, -0.6, 0.8]])
    expected = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.6, 0.4, 0], [0, 0.4, 0.6]]
    np.testing.assert_allclose(sky.L(origin(w), w), expected, atol=1e-15)

"""Lights without size against closed forms, and a place from which they cannot be seen."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.lights import DirectionalLight, PointLight, SphereLight, SpotLight

COLOR = np.array([1.0, 2.0, 0.5])
UNIFORM = np.array([[0.5, 0.5]])


def at(light: Any, *points: Any) -> Any:
    rows = np.array(points, np.float64)
    return light.sample(rows, np.repeat(UNIFORM, len(rows), axis=0))


def test_inverse_square() -> None:
    # On a floor below the light the irradiance is I cos / r^2 = I h / (h^2 + x^2)^(3/2).
    h, x = 2.0, np.array([0.0, 0.5, 1.0, 3.0])
    floor = np.stack([x, np.zeros(4), np.zeros(4)], axis=1)
    samples = at(PointLight([0.0, h, 0.0], COLOR), *floor)
    irradiance = samples.radiance * samples.direction[:, 1:2] / samples.pdf[:, None]
    expected = COLOR * (h / (h**2 + x**2) ** 1.5)[:, None]
    np.testing.assert_allclose(irradiance, expected, rtol=1e-14)
    np.testing.assert_allclose(samples.distance, np.sqrt(h**2 + x**2), rtol=1e-15)
    assert samples.is_delta
    without_r2 = samples.radiance * samples.distance[:, None] ** 2
    with pytest.raises(AssertionError):
        np.testing.assert_allclose(without_r2 * samples.direction[:, 1:2], expected, rtol=1e-5)


def test_a_sphere_far_away_is_a_point() -> None:
    # Seen from outside, a ball of radiance L and radius r has the intensity pi r^2 L.
    radius, place = 1e-3, np.array([1.0, 2.0, -0.5])
    ball = at(SphereLight(place, radius, COLOR), [0, 0, 0])
    point = at(PointLight(place, np.pi * radius**2 * COLOR), [0, 0, 0])
    # The disc's irradiance differs from the cap's mean cosine by sin^2(a) / 2 = 1e-7.
    np.testing.assert_allclose(ball.radiance / ball.pdf[0], point.radiance, rtol=1e-6)


def test_directional_light_is_the_same_everywhere() -> None:
    samples = at(DirectionalLight([0.0, 5.0, 0.0], COLOR), [0, 0, 0], [7, -8, 9])
    np.testing.assert_array_equal(samples.direction, [[0, 1, 0]] * 2)
    np.testing.assert_array_equal(samples.radiance, [COLOR] * 2)
    np.testing.assert_array_equal(samples.pdf, 1.0)
    assert np.isinf(samples.distance).all()


def test_fall_of_a_spot() -> None:
    outer, softness = np.cos(0.6), 0.25
    light = SpotLight([0.0, 2.0, 0.0], [0.0, -3.0, 0.0], COLOR, outer, softness)
    angle = np.array([0.0, 0.2, 0.53, 0.55, 0.57, 0.599, 0.601, 1.0])
    floor = np.stack([2.0 * np.tan(angle), np.zeros(8), np.zeros(8)], axis=1)
    samples = at(light, *floor)
    # The cone's inner edge lies where the cosine is a quarter of the way to 1.
    inner = outer + softness * (1.0 - outer)
    t = np.clip((np.cos(angle) - outer) / (inner - outer), 0.0, 1.0)
    fall = t * t * (3.0 - 2.0 * t)
    assert fall[:2].min() == 1.0
    assert (fall[2:6] > 0).all()
    assert (fall[2:6] < 1).all()
    expected = COLOR * (fall * np.cos(angle) ** 2 / 4.0)[:, None]
    np.testing.assert_allclose(samples.radiance, expected, atol=1e-14)
    np.testing.assert_array_equal(samples.pdf, (fall > 0).astype(float))


def test_a_point_in_the_light_sees_nothing() -> None:
    place = [0.5, 0.25, -1.0]
    for light in (PointLight(place, COLOR), SpotLight(place, [0, -1, 0], COLOR, 0.5, 0.5)):
        samples = at(light, place)
        assert samples.pdf[0] == 0.0
        assert (samples.radiance == 0.0).all()
        d = light.sample_backward(np.array([place]), samples, np.ones((1, 3)))
        assert all((np.asarray(value) == 0.0).all() for value in d.values())

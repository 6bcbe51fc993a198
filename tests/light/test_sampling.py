"""Lights that fill a part of the sphere: densities, samples, irradiance, and what mistakes do."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd.lights import LightSamples, QuadLight, SphereLight

from light.seen import COLOR, CORNER, EDGE_X, EDGE_Y, POINT, SEEN, quad
from support.light_proofs import Seen, polygon_irradiance, prove_density, prove_irradiance, square


@pytest.mark.parametrize("name", sorted(SEEN))
def test_samples_follow_a_density_that_integrates_to_one(name: str) -> None:
    prove_density(SEEN[name]())


@pytest.mark.parametrize("name", sorted(SEEN))
def test_irradiance(name: str) -> None:
    prove_irradiance(SEEN[name]())


@pytest.mark.parametrize("name", sorted(SEEN))
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_a_sample_agrees_with_density_and_radiance_of_its_direction(name: str, dtype: str) -> None:
    seen = SEEN[name]()
    points = seen.points(2000).astype(dtype)
    samples = seen.light.sample(points, square(2000, seed=24).astype(dtype))
    drawn = samples.pdf > 0
    assert drawn.mean() > 0.9
    assert not samples.is_delta
    pdf = seen.light.pdf(points[drawn], samples.direction[drawn])
    radiance = seen.light.L(points[drawn], samples.direction[drawn])
    # In float a sample on an edge may be seen beside it.
    same = pdf > 0
    assert same.mean() >= (0.999 if dtype == "f4" else 1.0)
    tolerance = 1e-4 if dtype == "f4" else 1e-9
    np.testing.assert_allclose(pdf[same], samples.pdf[drawn][same], rtol=tolerance)
    np.testing.assert_allclose(radiance[same], samples.radiance[drawn][same], rtol=tolerance)


@pytest.mark.parametrize("name", sorted(SEEN))
def test_float_agrees_with_double(name: str) -> None:
    seen = SEEN[name]()
    u2 = square(2000, seed=25)
    wide = seen.light.sample(seen.points(2000), u2.astype("f4").astype("f8"))
    thin = seen.light.sample(seen.points(2000).astype("f4"), u2.astype("f4"))
    for field in ("direction", "radiance", "pdf"):
        a, b = getattr(wide, field), getattr(thin, field)
        assert b.dtype == np.float32
        assert np.linalg.norm(a) > 0
        assert np.linalg.norm(a - b) <= 1e-4 * np.linalg.norm(a), field


class Wrong:
    """A light with a mistake: `change(pdf, points, w, distance)`, for its samples as well."""

    def __init__(self, right: Any, change: Callable[..., Any]) -> None:
        self.right, self.change = right, change

    def sample(self, points: Any, u2: Any) -> LightSamples:
        right = self.right.sample(points, u2)
        pdf = self.change(right.pdf, right.direction, right.distance)
        return dataclasses.replace(right, pdf=pdf)

    def pdf(self, points: Any, w: Any) -> Any:
        # Distances along w, from the plane of the quad.
        normal = np.cross(EDGE_X, EDGE_Y)
        distance = ((CORNER - points) @ normal) / (w @ normal)
        return self.change(self.right.pdf(points, w), w, distance)


class ByArea:
    """A rectangle's emission, sampled evenly over its area: density r^2 / (area cos)."""

    def __init__(self, corner: Any, edge_x: Any, edge_y: Any) -> None:
        self.corner, self.edges = corner, np.stack([edge_x, edge_y])
        self.front = np.cross(edge_x, edge_y)  # as long as the area is large

    def sample(self, points: Any, u2: Any) -> LightSamples:
        to = self.corner + u2 @ self.edges - points
        distance = np.linalg.norm(to, axis=1)
        w = to / distance[:, None]
        radiance = np.tile(COLOR, (len(w), 1))
        return LightSamples(w, distance, radiance, distance**2 / np.abs(w @ self.front), False)

    def pdf(self, points: Any, w: Any) -> Any:
        distance = ((self.corner - points) @ self.front) / (w @ self.front)
        at = points + w * distance[:, None] - self.corner
        u2 = at @ np.linalg.pinv(self.edges)
        inside = (distance > 0) & (u2 >= 0).all(axis=1) & (u2 <= 1).all(axis=1)
        return np.where(inside, distance**2 / np.abs(w @ self.front), 0.0)

    def L(self, points: Any, w: Any) -> Any:
        return np.where(self.pdf(points, w)[:, None] > 0, COLOR, 0.0)


def by_area() -> Seen:
    return dataclasses.replace(quad(), light=ByArea(CORNER, EDGE_X, EDGE_Y))


def cosine(w: Any) -> Any:
    normal = np.cross(EDGE_X, EDGE_Y)
    return np.abs(w @ normal) / np.linalg.norm(normal)


MISTAKES: dict[str, Callable[[Any, Any, Any], Any]] = {
    "no 1 / cos": lambda pdf, w, _: pdf * cosine(w),
    "no r^2": lambda pdf, _, r: pdf / r**2,
    "1 / r^2": lambda pdf, _, r: pdf / r**4,
    "over area": lambda pdf, w, r: pdf * cosine(w) / r**2,
}


def test_the_same_light_by_area_is_right_too() -> None:
    prove_density(by_area())
    prove_irradiance(by_area())


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_the_density_by_area_is_seen(mistake: str) -> None:
    right = by_area()
    wrong = dataclasses.replace(right, light=Wrong(right.light, MISTAKES[mistake]))
    for proof in (prove_density, prove_irradiance):
        with pytest.raises(AssertionError):
            proof(wrong)


def test_points_even_over_the_area_do_not_have_the_density_of_the_solid_angle() -> None:
    class Mixed:
        sample, pdf = by_area().light.sample, quad().light.pdf

    with pytest.raises(AssertionError, match="do not follow"):
        prove_density(dataclasses.replace(quad(), light=Mixed))


def test_solid_angle_is_less_noisy_than_area() -> None:
    # A light of 2 m x 2 m half a meter above the floor, seen from below its corner.
    corner, x, y = np.array([0.0, 0.5, 0.0]), np.array([2.0, 0, 0]), np.array([0, 0, 2.0])
    vertices = np.stack([corner, corner + x, corner + x + y, corner + y])
    lamps = (QuadLight(corner, x, y, COLOR), ByArea(corner, x, y))
    known = polygon_irradiance(vertices, np.zeros(3), np.array([0, 1.0, 0]))
    noise = []
    for lamp in lamps:
        samples = lamp.sample(np.zeros((100_000, 3)), square(100_000, seed=26))
        estimate = samples.radiance[:, 0] * samples.direction[:, 1] / samples.pdf
        noise.append(float(estimate.std() / known))
        assert abs(estimate.mean() - known) < 5 * known * noise[-1] / np.sqrt(len(estimate))
    assert noise[0] < 0.65
    assert noise[1] / noise[0] > 2.0


@pytest.mark.parametrize("dtype", ["f4", "f8"])
@pytest.mark.parametrize("distance", [1.0, 30.0, 3000.0])
def test_solid_angles_of_small_quads_and_balls(distance: float, dtype: str) -> None:
    # From 0.2 sr over the change to area sampling at 1e-6 sr to 2e-8 sr, where float keeps digits.
    points = np.zeros((1000, 3), dtype)
    u2 = square(1000, seed=27).astype(dtype)
    h = 0.2 * distance if distance < 2.0 else 0.2
    lamp = QuadLight([-h, distance, -h], [2 * h, 0, 0], [0, 0, 2 * h], COLOR)
    samples = lamp.sample(points, u2)
    known = 4.0 * np.arcsin(h**2 / (h**2 + distance**2))
    np.testing.assert_allclose(1.0 / samples.pdf, known, rtol=1e-5 if dtype == "f4" else 1e-4)
    ball = SphereLight([0, distance, 0], h, COLOR)
    samples = ball.sample(points, u2)
    sine = h / distance
    known = 2.0 * np.pi * sine**2 / (1.0 + np.sqrt(1.0 - sine**2))
    np.testing.assert_allclose(1.0 / samples.pdf, known, rtol=1e-5)
    assert (ball.pdf(points, samples.direction) > 0).all()
    assert (samples.distance >= (distance - h) * (1 - 1e-6)).all()
    assert (samples.distance <= distance).all()


@pytest.mark.parametrize("name", ["quad", "triangle", "sphere"])
def test_nothing_comes_from_behind_or_from_within(name: str) -> None:
    light = SEEN[name]().light
    center = CORNER + 0.5 * (EDGE_X + EDGE_Y)
    place = {
        "quad": 2.0 * center - POINT,
        "triangle": 2.0 * center - POINT,
        "sphere": np.array([0.4, 1.0, 0.6]),
    }[name]
    points = np.tile(place, (100, 1))
    samples = light.sample(np.tile(POINT, (100, 1)), square(100, seed=29))
    w = np.where(samples.pdf[:, None] > 0, samples.direction, [0.0, 0.6, 0.8])
    for directions in (w, -w):  # from behind, -w would meet the light's back
        assert (light.sample(points, square(100, seed=28)).pdf == 0).all()
        assert (light.pdf(points, directions) == 0).all()
        assert (light.L(points, directions) == 0).all()

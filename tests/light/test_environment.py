"""Environment maps: lookups, rotation, what is refused, and how well samples follow the light."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.lights import EnvironmentMap, LightSamples, about_y
from photograd_course.random import uniform

from light.seen import bilinear_oracle, environment, environment_irradiance, texels
from support.bits import same_bits
from support.light_proofs import Seen, prove_density, prove_irradiance, square


def everywhere(count: int, *, seed: int = 41) -> Any:
    """Even directions (N, 3)."""
    return _core.square_to_cap(square(count, seed=seed), 2.0)


def origin(count: int) -> Any:
    return np.zeros((count, 3))


def check_lookup(light: Any, image: Any, world_from_map: Any) -> None:
    w = everywhere(5000)
    expected = bilinear_oracle(image, w, world_from_map)
    assert expected.std() > 0.1
    # arccos of the oracle loses digits near the poles.
    np.testing.assert_allclose(light.L(origin(5000), w), expected, rtol=1e-6, atol=1e-9)


def test_lookup_is_bilinear_and_goes_around() -> None:
    check_lookup(EnvironmentMap(texels()), texels(), np.eye(3))
    check_lookup(EnvironmentMap(texels(), about_y(2.5)), texels(), about_y(2.5))


class HalfTexel:
    """The mistake: texel centers at i / n instead of (i + 1/2) / n, as a turn by half a texel."""

    def __init__(self, right: EnvironmentMap) -> None:
        turn = about_y(np.pi / right.texels.shape[1])
        self.right, self.turned = right, EnvironmentMap(right.texels, right.world_from_map @ turn)

    def L(self, points: Any, w: Any) -> Any:
        return self.turned.L(points, w)

    def sample(self, points: Any, u2: Any) -> LightSamples:
        return self.turned.sample(points, u2)

    def pdf(self, points: Any, w: Any) -> Any:
        return self.right.pdf(points, w)


class NoSine:
    """The mistake: density over the picture, divided by 2 pi^2, without 1 / sin(theta)."""

    def __init__(self, right: EnvironmentMap) -> None:
        self.right = right

    def pdf(self, points: Any, w: Any) -> Any:
        return self.right.pdf(points, w) * np.sqrt(1.0 - w[:, 1] ** 2)

    def sample(self, points: Any, u2: Any) -> LightSamples:
        samples = self.right.sample(points, u2)
        return dataclasses.replace(samples, pdf=self.pdf(points, samples.direction))


def test_half_a_texel_is_seen() -> None:
    right = environment()
    with pytest.raises(AssertionError):
        check_lookup(HalfTexel(EnvironmentMap(texels())), texels(), np.eye(3))
    with pytest.raises(AssertionError, match="do not follow"):
        prove_density(dataclasses.replace(right, light=HalfTexel(right.light)))


def test_a_forgotten_sine_is_seen() -> None:
    right = environment()
    wrong = dataclasses.replace(right, light=NoSine(right.light))
    with pytest.raises(AssertionError, match="Not equal"):
        prove_density(wrong)
    with pytest.raises(AssertionError, match="beyond"):
        prove_irradiance(wrong)


def test_a_transposed_rotation_is_seen() -> None:
    with pytest.raises(AssertionError):
        check_lookup(EnvironmentMap(texels(), about_y(2.5)), texels(), about_y(-2.5))


def test_where_things_are_in_the_picture() -> None:
    light = EnvironmentMap(texels())
    axes = np.array(
        [[0, 0, 1.0], [-1.0, 0, 0], [0, 0, -1.0], [1.0, 0, 0], [0, 1.0, 0], [0, -1.0, 0]]
    )
    found = light.L(origin(6), axes)
    middle = 0.5 * (texels()[3] + texels()[4])  # the horizon lies between rows 3 and 4
    between = 0.5 * (middle + np.roll(middle, 1, axis=0))  # column k: the left edge of texel k
    np.testing.assert_allclose(found[:4], between[[8, 12, 0, 4]], rtol=1e-12)
    # At the poles all columns meet; the lookup takes the side of phi = 0.
    np.testing.assert_allclose(found[4], 0.5 * (texels()[0, 7] + texels()[0, 8]), rtol=1e-12)
    np.testing.assert_allclose(found[5], 0.5 * (texels()[7, 7] + texels()[7, 8]), rtol=1e-12)


def test_turning_the_map_turns_the_light() -> None:
    turn = about_y(0.9) @ np.array([[1.0, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
    straight, turned = EnvironmentMap(texels()), EnvironmentMap(texels(), turn)
    w = everywhere(1000)
    for ask in ("L", "pdf"):
        here = getattr(turned, ask)(origin(1000), np.ascontiguousarray(w @ turn.T))
        np.testing.assert_allclose(here, getattr(straight, ask)(origin(1000), w), rtol=1e-9)
    u2 = square(1000, seed=42)
    a, b = (light.sample(origin(1000), u2) for light in (straight, turned))
    np.testing.assert_allclose(b.direction, a.direction @ turn.T, atol=1e-14)
    np.testing.assert_allclose(b.radiance, a.radiance, rtol=1e-9)
    # A quarter turn is a roll by a quarter of the columns: -X, three quarters along, comes to +Z.
    rolled = EnvironmentMap(np.roll(texels(), -4, axis=1))
    quarter = EnvironmentMap(texels(), about_y(np.pi / 2))
    for ask in ("L", "pdf"):
        first, second = (getattr(light, ask)(origin(1000), w) for light in (rolled, quarter))
        np.testing.assert_allclose(first, second, rtol=1e-9)


def test_a_map_of_one_color_has_no_noise() -> None:
    for light in (EnvironmentMap(np.full((8, 16, 3), 2.5)), EnvironmentMap(np.zeros((8, 16, 3)))):
        samples = light.sample(origin(1000), square(1000, seed=43))
        np.testing.assert_allclose(samples.pdf, 0.25 / np.pi, rtol=1e-12)


def test_weights_of_samples_are_bounded() -> None:
    # One bright texel in each row, with weights relative to that of its center.
    bounds = []
    for row in range(16):
        image = np.zeros((16, 32, 3))
        image[row, 5] = 1.0
        light = EnvironmentMap(image)
        samples = light.sample(origin(20_000), square(20_000, seed=44))
        seen = samples.pdf > 0
        assert seen.mean() > 0.9999
        theta, phi = np.pi * (row + 0.5) / 16, 2.0 * np.pi * (5.5 / 32 - 0.5)
        sine = np.sin(theta)
        center = np.array([[-sine * np.sin(phi), np.cos(theta), sine * np.cos(phi)]])
        usual = light.L(origin(1), center)[0, 0] / light.pdf(origin(1), center)[0]
        weight = samples.radiance[seen, 0] / samples.pdf[seen] / usual
        bounds.append((weight.min(), weight.max()))
        # And light is nowhere where the density is not.
        w = everywhere(20_000)
        dark = light.pdf(origin(20_000), w) == 0
        assert (light.L(origin(20_000), w)[dark] == 0).all()
    assert 0.66 < min(low for low, _ in bounds) < 0.75
    assert 1.5 < max(high for _, high in bounds) < 2.0
    assert 0.9 < bounds[8][0] < bounds[8][1] < 1.1


def test_one_bright_texel_gives_the_irradiance_it_should() -> None:
    image = np.full((8, 16, 3), 1e-3)
    image[1, 9] = [50.0, 20.0, 80.0]
    light = EnvironmentMap(image, about_y(0.3))
    here = environment()
    prove_irradiance(
        Seen(light, here.point, here.normal, here.chart, environment_irradiance(light))
    )


@pytest.mark.parametrize("height", [1, 2, 3, 64])
def test_small_and_odd_maps(height: int) -> None:
    light = EnvironmentMap(texels(height), uniform_share=0.2)
    here = environment()
    chart = dataclasses.replace(here.chart, light=light)
    if height < 64:
        prove_density(dataclasses.replace(here, light=light, chart=chart))
    check_lookup(light, texels(height), np.eye(3))


@same_bits("environment map")
def samples_and_gradients() -> list[Any]:
    image, points = texels(40).astype("f4"), np.zeros((20_000, 3), "f4")
    light = EnvironmentMap(image, uniform_share=0.1)
    samples = light.sample(points, square(20_000, seed=45).astype("f4"))
    d = light.L_backward(points, samples.direction, samples.radiance)
    return [samples.direction, samples.radiance, samples.pdf, d["texels"]]


def test_bad_maps_are_refused() -> None:
    good = texels()
    for value in (np.nan, np.inf, -0.1, 1e31):
        bad = good.copy()
        bad[2, 5, 1] = value
        with pytest.raises(RangeError, match="row 2, column 5"):
            EnvironmentMap(bad)
        with pytest.raises(RangeError, match="texels"):
            EnvironmentMap(good).with_texels(bad)
    for shape in ((8, 15, 3), (8, 8, 3), (0, 0, 3)):
        with pytest.raises(ShapeError, match=r"^EnvironmentMap: texels: .*\(H, 2 H, 3\)"):
            EnvironmentMap(np.ones(shape))
    with pytest.raises(ShapeError, match=r"\(H, 2 H, 3\)"):
        EnvironmentMap(np.ones((8, 16)))
    with pytest.raises(DtypeError, match="texels"):
        EnvironmentMap(np.ones((8, 16, 3), int))
    for matrix in (np.diag([1.0, 1.0, -1.0]), 2.0 * np.eye(3), np.full((3, 3), np.nan)):
        with pytest.raises(RangeError, match="world_from_map"):
            EnvironmentMap(good, matrix)
    with pytest.raises(ShapeError, match="world_from_map"):
        EnvironmentMap(good, np.eye(4))
    for share in (-0.1, 1.1, np.nan):
        with pytest.raises(RangeError, match="uniform_share"):
            EnvironmentMap(good, uniform_share=share)
    with pytest.raises(ShapeError, match="with_texels"):
        EnvironmentMap(good).with_texels(good[:4, :8])


def test_lookups_of_a_uniform_direction_sum() -> None:
    """float32 against float64 on a map as large as real ones."""
    height = 512
    u = uniform(46, pixel=np.arange(height * 2 * height)).reshape(height, 2 * height, 1)
    image = np.repeat(u**4, 3, axis=2)
    wide, thin = EnvironmentMap(image), EnvironmentMap(image.astype("f4"))
    w = everywhere(5000).astype("f4")
    a = wide.L(origin(5000), w.astype("f8"))
    b = thin.L(np.zeros((5000, 3), "f4"), w)
    assert np.linalg.norm(a - b) <= 1e-4 * np.linalg.norm(a)

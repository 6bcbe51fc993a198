"""Noise: an oracle in plain Python, its range and mean, its periods."""

from __future__ import annotations

import itertools
import math

import numpy as np
import numpy.typing as npt
import pytest
from photograd.scenes import noise
from photograd.scenes.noise import fractal_noise, gradient_noise
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.random import permutation

Array = npt.NDArray[np.float64]

EDGES = [g for g in itertools.product((-1, 0, 1), repeat=3) if sum(map(abs, g)) == 2]
BOUND = {2: 1.0, 3: 1.0363}
"""Found by `test_the_range_is_what_the_gradients_allow`."""


def points(axes: int, count: int = 4000, scale: float = 100.0) -> Array:
    return np.random.default_rng(5).uniform(-scale, scale, (count, axes))


def by_hand(point: Array, seed: int) -> float:
    """One value, with loops."""
    table = [int(entry) for entry in permutation(seed, 256)]
    cell = [math.floor(x) for x in point]
    total = 0.0
    for corner in itertools.product((0, 1), repeat=len(cell)):
        hashed, weight, offset = 0, 1.0, []
        for x, low, step in zip(point, cell, corner, strict=True):
            hashed = table[(hashed + low + step) % 256]
            t = abs(1 - step - (x - low))  # 1 at this corner, 0 at the other
            weight *= t * t * t * (10 + t * (6 * t - 15))
            offset.append(x - low - step)
        gradients = noise._GRADIENTS[len(cell)]
        gradient = gradients[hashed % len(gradients)]
        total += weight * sum(g * d for g, d in zip(gradient, offset, strict=True))
    return total


@pytest.mark.parametrize("axes", [2, 3])
def test_noise_agrees_with_the_definition(axes: int) -> None:
    where = points(axes, 40)
    expected = [by_hand(point, seed=11) for point in where]
    assert np.abs(expected).max() > 0.3
    np.testing.assert_allclose(gradient_noise(where, seed=11), expected, atol=1e-12)


def test_gradients_are_the_edges_of_a_cube_and_a_compass() -> None:
    assert {tuple(g) for g in noise._EDGES} == set(EDGES)
    for gradients in noise._GRADIENTS.values():
        np.testing.assert_allclose(np.linalg.norm(gradients, axis=1), np.sqrt(2), rtol=1e-15)
        np.testing.assert_allclose(gradients.sum(axis=0), 0.0, atol=1e-15)  # hence the mean 0


@pytest.mark.parametrize("axes", [2, 3])
def test_the_range_is_what_the_gradients_allow(axes: int) -> None:
    """The largest value at a place is had when every corner has the gradient that suits it best."""
    steps = np.linspace(0.0, 1.0, 41)
    places = np.stack(np.meshgrid(*[steps] * axes, indexing="ij"), axis=-1)
    fade = places**3 * (10.0 + places * (6.0 * places - 15.0))
    most = np.zeros(places.shape[:-1])
    for corner in itertools.product((0, 1), repeat=axes):
        weight = np.where(np.array(corner) == 1, fade, 1.0 - fade).prod(axis=-1)
        most += weight * ((places - corner) @ noise._GRADIENTS[axes].T).max(axis=-1)
    # The lattice of places misses the maximum by less than its curvature (about 6) times the
    # square of half its spacing: 1e-3.
    assert most.max() == pytest.approx(BOUND[axes], abs=1e-3)
    values = gradient_noise(points(axes, 100_000), seed=1)
    assert np.abs(values).max() <= BOUND[axes]
    assert values.max() > 0.8  # 100 000 points come near it
    assert values.min() < -0.8


@pytest.mark.parametrize("axes", [2, 3])
def test_the_mean_is_zero(axes: int) -> None:
    """Tables of 400 seeds at one place give independent values: a z-test with P(|z| > 4) = 6e-5."""
    place = np.full((1, axes), 0.37)
    values = np.array([gradient_noise(place, seed=seed)[0] for seed in range(400)])
    assert values.std() > 0.1
    assert abs(values.mean()) < 4.0 * values.std() / 20.0


def test_noise_is_zero_on_the_lattice_and_smooth_across_it() -> None:
    whole = np.floor(points(3, 200))
    np.testing.assert_array_equal(gradient_noise(whole, seed=2), 0.0)
    step = 1e-4
    face = points(3, 500)
    face[:, 0] = np.floor(face[:, 0])  # on the border between two cells
    at, before, after = (
        gradient_noise(face + shift * np.eye(3)[0], seed=2) for shift in (0.0, -step, step)
    )
    assert np.abs(after - before).max() > 1e-5
    # Value, slope and curvature continue: the second difference is curvature times step^2, and the
    # curvature on a border is 0, so that what is left is of third order: some 100 step^3.
    assert np.abs(after - 2.0 * at + before).max() < 1e-9


def test_seeds_and_octaves_are_independent() -> None:
    where = points(3)
    first = gradient_noise(where, seed=0)
    for other in (gradient_noise(where, seed=1), gradient_noise(where, seed=0, octave=1)):
        # 4000 points in as many cells: the correlation of independent noises has a standard
        # deviation of 1/63; four of those.
        assert abs(np.corrcoef(first, other)[0, 1]) < 0.064
    np.testing.assert_array_equal(first, gradient_noise(where, seed=0))


@pytest.mark.parametrize("ridged", [False, True])
def test_periods(ridged: bool) -> None:
    where = points(2, 500, scale=8.0)
    options = {"seed": 4, "octaves": 4, "ridged": ridged}
    first = fractal_noise(where, period=5, **options)  # type: ignore[arg-type]
    moved = where + np.array([5.0, -10.0])
    again = fractal_noise(moved, period=5, **options)  # type: ignore[arg-type]
    # Adding 5 rounds positions by 1e-15, which slopes of up to 8 x 3 carry on.
    np.testing.assert_allclose(first, again, atol=1e-12)
    free = fractal_noise(moved, **options)  # type: ignore[arg-type]
    assert np.abs(first - free).max() > 0.1
    np.testing.assert_allclose(
        gradient_noise(where, seed=4), gradient_noise(where + 256.0, seed=4), atol=1e-11
    )


def test_octaves_add_up() -> None:
    where = points(3, 300)
    parts = [gradient_noise(where * 2.0**k, seed=9, octave=k) for k in range(3)]
    smooth = (parts[0] + 0.4 * parts[1] + 0.16 * parts[2]) / 1.56
    np.testing.assert_allclose(
        fractal_noise(where, seed=9, octaves=3, gain=0.4), smooth, atol=1e-14
    )
    crests = sum(0.4**k * (1.0 - 2.0 * np.abs(part)) for k, part in enumerate(parts)) / 1.56
    ridged = fractal_noise(where, seed=9, octaves=3, gain=0.4, ridged=True)
    np.testing.assert_allclose(ridged, crests, atol=1e-14)
    assert 0.5 < ridged.max() <= 1.0


def test_bad_input_is_refused() -> None:
    good = points(2, 3)
    with pytest.raises(ShapeError, match=r"gradient_noise: points: expected shape \(..., 2\)"):
        gradient_noise(points(4, 3), seed=0)
    with pytest.raises(DtypeError, match="points"):
        gradient_noise(good.astype(int), seed=0)  # type: ignore[arg-type]
    with pytest.raises(RangeError, match="finite"):
        fractal_noise(good * np.nan, seed=0)
    with pytest.raises(RangeError, match="period"):
        gradient_noise(good, seed=0, period=257)
    with pytest.raises(RangeError, match="at most 32 with 4 octaves"):
        fractal_noise(good, seed=0, octaves=4, period=33)
    with pytest.raises(RangeError, match="gain"):
        fractal_noise(good, seed=0, gain=1.5)

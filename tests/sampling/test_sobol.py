"""Scrambled Sobol' points: their definition, their evenness, and that each is uniform."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd_course.random import philox4x32

from support.statistics import chi_square_p

pytestmark = pytest.mark.usefixtures("core")

Array = Any
# Degree, inner coefficients and first numbers m of the polynomials of words 0 to 3; x has none.
POLYNOMIALS = ((1, 0, [1]), None, (2, 1, [1, 3]), (3, 1, [1, 3, 1]))
OWN = 0xFFFFFFFF
ONES = 0xFFFFFFFF


def words(pixels: int, count: int, *, seed: int = 1, block: int = 0, first: int = 0) -> Array:
    pixel = np.arange(pixels, dtype=np.uint32)
    return _core.sobol_words(seed, 0, block, pixel, first, count)


def directions(polynomial: Any) -> list[int]:
    """v_k = m_k 2^(31 - k), the m_k by the recurrence in integers."""
    if polynomial is None:
        return [1 << (31 - k) for k in range(32)]
    s, a, start = polynomial
    m = list(start)
    for k in range(s, 32):
        new = m[k - s] ^ (m[k - s] << s)
        for j in range(1, s):
            new ^= ((a >> (s - 1 - j)) & 1) * (m[k - j] << j)
        m.append(new)
    return [m[k] << (31 - k) for k in range(32)]


def turned(x: int) -> int:
    return int(f"{x:032b}"[::-1], 2)


def flips(x: int, key: int) -> int:
    x ^= x * 0x3D20ADEA & ONES
    x = (x + key) & ONES
    x = x * ((key >> 16) | 1) & ONES
    x ^= x * 0x05526C56 & ONES
    return x ^ (x * 0x53A22864 & ONES)


def test_points_are_what_the_definition_says() -> None:
    tables = [directions(p) for p in POLYNOMIALS]
    for seed, pixel, block, sample in [
        (1, 0, 0, 0),
        (7, 3, 5, 1),
        (2**40 + 1, 9, 2, 63),
        (3, 2**32 - 1, 11, 4097),
    ]:
        keys = np.array([[seed & ONES, seed >> 32]], np.uint32)
        digits, order = (
            philox4x32(np.array([[pixel, OWN, 0, 2 * block + k]], np.uint32), keys)[0].tolist()
            for k in (0, 1)
        )
        index = turned(flips(turned(sample), order[0]))
        expected = []
        for v, key in zip(tables, digits, strict=True):
            x = 0
            for k in range(32):
                x ^= v[k] * ((index >> k) & 1)
            expected.append(turned(flips(turned(x), key)))
        found = _core.sobol_words(seed, 0, block, np.array([pixel], np.uint32), sample, 1)
        assert found[0, 0].tolist() == expected


@pytest.mark.parametrize(("pair", "log_volume"), [((0, 1), 6), ((1, 2), 5)])
def test_every_box_has_its_share_of_points(pair: tuple[int, int], log_volume: int) -> None:
    # 64 points, from any multiple of 64 on: as many in each box 2^-a by 2^-b, a + b = log_volume.
    for first in (0, 64, 192):
        found = words(40, 64, first=first)
        for a in range(log_volume + 1):
            b = log_volume - a
            box = [
                found[..., w].astype(np.uint64) >> np.uint64(32 - bits)
                for w, bits in zip(pair, (a, b), strict=True)
            ]
            number = np.sort((box[0] << np.uint64(b)) + box[1], axis=1)
            expected = np.repeat(np.arange(1 << log_volume), 64 >> log_volume)
            np.testing.assert_array_equal(number, np.broadcast_to(expected, number.shape))


@pytest.mark.parametrize("sample", [0, 5, 63])
def test_every_point_is_uniform(sample: int) -> None:
    # 12 tests together; a fixed seed, and p below 1e-4 in one of them by chance once in 800 seeds.
    found = words(20_000, 1, seed=3, block=2, first=sample)[:, 0]
    for word in range(4):
        counts = np.bincount(found[:, word] >> np.uint32(27), minlength=32)
        assert chi_square_p(counts.astype(float), np.full(32, 1 / 32)) > 1e-4


def test_digits_flip_independently() -> None:
    # Two points whose second digits follow different first ones: all four pairs are as likely.
    found = words(20_000, 2, seed=4, block=1)[..., 1] >> np.uint32(30)
    first, second = found[:, 0], found[:, 1]
    assert ((first >> 1) != (second >> 1)).all()  # the two halves have one point each
    counts = np.bincount(2 * (first & 1) + (second & 1), minlength=4)
    assert chi_square_p(counts.astype(float), np.full(4, 1 / 4)) > 1e-4


def test_blocks_and_pixels_have_nothing_to_do_with_each_other() -> None:
    a, b = (words(4000, 4, block=k)[..., :2].reshape(-1, 2) / 2.0**32 - 0.5 for k in (0, 1))
    neighbor = np.roll(a.reshape(4000, 4, 2), 1, axis=0).reshape(-1, 2)
    for other in (b, neighbor):
        # Of 16 000 pairs of uncorrelated numbers: the spread is 1 / 126.
        assert np.abs(12 * (a.T @ other) / len(a)).max() < 4.5 / 126


def test_means_err_less_than_those_of_independent_points() -> None:
    # Root mean squared error over 2000 pixels; the mean itself is right within its own spread.
    for name, function, mean, slope in (
        ("smooth", lambda x, y: x * y, 0.25, -1.3),
        ("edge", lambda x, y: x * x + y * y < 0.8, np.pi * 0.8 / 4, -0.65),
    ):
        errors = []
        for count in (4, 16, 64, 256):
            u = words(2000, count)[..., :2] / 2.0**32
            error = function(u[..., 0], u[..., 1]).mean(axis=1) - mean
            errors.append(np.sqrt((error**2).mean()))
            assert abs(error.mean()) < 4 * errors[-1] / np.sqrt(2000), name
        measured = np.polyfit(np.log([4, 16, 64, 256]), np.log(errors), 1)[0]
        assert measured < slope, (name, measured)

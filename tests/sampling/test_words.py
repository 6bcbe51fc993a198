"""Random words as paths draw them: uniform in every dimension, and no two dimensions go together.

Words of one sample of many pixels, of the blocks of the camera and of six vertices, for both
samplers. What is seen: a number that misses the upper 0.2 % of its range (8 standard errors above
the mean of chi-square), and one that is a function of another in 6 % of the paths (11 standard
errors of a correlation, against a threshold of 5.2).
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core

from support.statistics import chi_square_p

pytestmark = pytest.mark.usefixtures("core")
Array = Any
PIXELS, BLOCKS, SAMPLE, SEED = 1 << 17, 13, 5, 11
BINS, LIMIT = 512, 5.2
SAMPLERS = ("independent", "sobol")


@cache
def numbers(sampler: str) -> Array:
    """(dimensions, PIXELS) in [0, 1): four for each block."""
    pixel = np.arange(PIXELS, dtype=np.uint32)
    found = []
    for block in range(BLOCKS):
        if sampler == "sobol":
            found += list(_core.sobol_words(SEED, 0, block, pixel, SAMPLE, 1)[:, 0].T / 2.0**32)
        else:
            found += [_core.uniform(SEED, 0, pixel, SAMPLE, 4 * block + k) for k in range(4)]
    return np.array(found)


def least_p(u: Array) -> float:
    """The smallest p-value of uniformity among the dimensions."""
    even = np.full(BINS, 1 / BINS)
    counts = [np.bincount((row * BINS).astype(int), minlength=BINS) for row in u]
    return min(chi_square_p(row.astype(float), even) for row in counts)


def strongest_correlation(u: Array) -> float:
    """Of all pairs of dimensions and of their squares, in standard errors of independent ones."""
    x = 2 * u.astype(np.float32) - 1
    waves = np.concatenate([np.sqrt(3) * x, np.sqrt(5) * (1.5 * x * x - 0.5)])
    matrix = waves @ waves.T / np.sqrt(u.shape[1])
    same = np.tile(np.arange(len(u)), 2)
    return float(np.abs(matrix[same[:, None] != same[None, :]]).max())


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_every_dimension_is_uniform(sampler: str) -> None:
    u = numbers(sampler)
    assert least_p(u) > 1e-5  # of 52 dimensions: a false alarm for one seed in 2000
    for dimension in (0, 21, 51):
        scaled = u.copy()
        scaled[dimension] *= 1 - 0.002
        assert least_p(scaled) < 1e-7


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_no_two_dimensions_go_together(sampler: str) -> None:
    # 5356 pairs: a false alarm for one seed in 900.
    u = numbers(sampler)[:, : PIXELS // 4]
    assert strongest_correlation(u) < LIMIT
    some = slice(None, None, 16)
    for twin in (u[50, some], np.abs(2 * u[50, some] - 1)):
        mixed = u.copy()
        mixed[13, some] = twin
        assert strongest_correlation(mixed) > LIMIT

"""Philox against its published answers, and the address rule that the core shares."""

from __future__ import annotations

import numpy as np
import pytest
from photograd_course import random
from photograd_course.errors import DtypeError, RangeError, ShapeError

# The three answers for philox4x32-10 published with [Salmon2011].
KNOWN_ANSWERS = [
    (
        "00000000 00000000 00000000 00000000",
        "00000000 00000000",
        "6627e8d5 e169c58d bc57ac4c 9b00dbd8",
    ),
    (
        "ffffffff ffffffff ffffffff ffffffff",
        "ffffffff ffffffff",
        "408f276d 41c83b0e a20bc7c6 6d5451fd",
    ),
    (
        "243f6a88 85a308d3 13198a2e 03707344",
        "a4093822 299f31d0",
        "d16cfe09 94fdcceb 5001e420 24126ea1",
    ),
]


def words(text: str) -> np.ndarray:
    return np.array([int(part, 16) for part in text.split()], dtype=np.uint32)


def scalar_philox(counter: list[int], key: list[int]) -> list[int]:
    """The rounds once more with Python integers, as an oracle for the vectorized form."""
    c, k = list(counter), list(key)
    for _ in range(10):
        a, b = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [(b >> 32) ^ c[1] ^ k[0], b % 2**32, (a >> 32) ^ c[3] ^ k[1], a % 2**32]
        k = [(k[0] + 0x9E3779B9) % 2**32, (k[1] + 0xBB67AE85) % 2**32]
    return c


@pytest.mark.parametrize(("counter", "key", "answer"), KNOWN_ANSWERS)
def test_published_answers(counter: str, key: str, answer: str) -> None:
    np.testing.assert_array_equal(random.philox4x32(words(counter), words(key)), words(answer))


def test_published_answers_at_once() -> None:
    counters = np.stack([words(row[0]) for row in KNOWN_ANSWERS])
    keys = np.stack([words(row[1]) for row in KNOWN_ANSWERS])
    answers = np.stack([words(row[2]) for row in KNOWN_ANSWERS])
    np.testing.assert_array_equal(random.philox4x32(counters, keys), answers)


def test_uniform_follows_the_address_rule() -> None:
    seed = 0x0123456789ABCDEF
    for step, pixel, sample, dimension in [(0, 0, 0, 0), (7, 640, 3, 5), (2**32 - 1, 9, 2**31, 14)]:
        hashed = scalar_philox([pixel, sample, step, dimension // 4], [0x89ABCDEF, 0x01234567])
        expected = (hashed[dimension % 4] >> 8) / 2**24
        drawn = random.uniform(seed, step=step, pixel=pixel, sample=sample, dimension=dimension)
        assert drawn.dtype == np.float64
        assert drawn.shape == ()
        assert float(drawn) == expected


def test_uniform_broadcasts_and_is_independent_of_order() -> None:
    pixel, dimension = np.arange(6)[:, None], np.arange(5)[None, :]
    table = random.uniform(3, step=2, pixel=pixel, sample=1, dimension=dimension)
    assert table.shape == (6, 5)
    assert len(np.unique(table)) == 30
    for p in reversed(range(6)):
        for d in range(5):
            assert random.uniform(3, step=2, pixel=p, sample=1, dimension=d) == table[p, d]


def test_uniform_is_uniform() -> None:
    values = random.uniform(11, pixel=np.arange(64_000))
    assert values.min() >= 0.0
    assert values.max() < 1.0
    np.testing.assert_array_equal(values, values.astype(np.float32))
    counts = np.bincount((values * 64).astype(int), minlength=64)
    chi_squared = float(((counts - 1000.0) ** 2 / 1000.0).sum())
    # 63 degrees of freedom: 137 is exceeded with probability 2e-7; the seed is fixed.
    assert chi_squared < 137.0


def test_uniform_int_covers_its_range_evenly() -> None:
    values = random.uniform_int(5, 7, pixel=np.arange(70_000))
    counts = np.bincount(values, minlength=7)
    assert counts.shape == (7,)
    # 6 degrees of freedom: 42 is exceeded with probability 2e-7; the seed is fixed.
    assert float(((counts - 10_000.0) ** 2 / 10_000.0).sum()) < 42.0
    word = int(random.random_words(5, step=0, pixel=3, sample=0, dimension=0))
    assert int(random.uniform_int(5, 10**9, pixel=3)) == word * 10**9 // 2**32


def test_permutation_is_one_and_depends_on_seed_and_step() -> None:
    order = random.permutation(1, 1000)
    np.testing.assert_array_equal(np.sort(order), np.arange(1000))
    np.testing.assert_array_equal(order, random.permutation(1, 1000))
    assert (order != random.permutation(2, 1000)).any()
    assert (order != random.permutation(1, 1000, step=1)).any()
    assert random.permutation(1, 0).shape == (0,)


SIZES = [(10, 10), (1000, 400), (5_000_000, 4096), (8, 0)]


@pytest.mark.parametrize(("population", "count"), SIZES)
def test_choice_has_no_duplicates(population: int, count: int) -> None:
    picked = random.choice(9, population, count, step=4)
    assert picked.shape == (count,)
    assert len(np.unique(picked)) == count
    assert count == 0 or (picked.min() >= 0 and picked.max() < population)
    np.testing.assert_array_equal(picked, random.choice(9, population, count, step=4))


def test_choice_is_even() -> None:
    hits = np.zeros(40)
    for step in range(4000):
        hits[random.choice(2, 40, 4, step=step)] += 1
    # 39 degrees of freedom, variance of each count smaller than its mean: 98 has p < 1e-6.
    assert float(((hits - 400.0) ** 2 / 400.0).sum()) < 98.0


def test_bad_input_is_refused() -> None:
    with pytest.raises(RangeError, match="seed"):
        random.uniform(-1)
    with pytest.raises(RangeError, match="seed"):
        random.uniform(2**64)
    with pytest.raises(RangeError, match="pixel"):
        random.uniform(0, pixel=2**32)
    with pytest.raises(DtypeError, match="sample"):
        random.uniform(0, sample=np.array([0.5]))
    with pytest.raises(DtypeError, match="counter"):
        random.philox4x32(np.zeros(4, dtype=np.int64), np.zeros(2, dtype=np.uint32))  # type: ignore[arg-type]
    with pytest.raises(ShapeError, match="key"):
        random.philox4x32(np.zeros(4, dtype=np.uint32), np.zeros(3, dtype=np.uint32))
    with pytest.raises(RangeError, match="count"):
        random.choice(0, 3, 4)
    with pytest.raises(RangeError, match="bound"):
        random.uniform_int(0, 0)


def test_normal_vectors_are_normal_and_addressed_by_row() -> None:
    rows = np.arange(40_000)
    found = random.normal_vectors(7, step=3, row=rows, sample=2)
    assert found.shape == (40_000, 3)
    # Five sigma: the mean has 1 / sqrt(40,000), a variance sqrt(2 / 40,000).
    np.testing.assert_allclose(found.mean(axis=0), 0, atol=0.025)
    np.testing.assert_allclose(np.cov(found.T), np.eye(3), atol=0.036)
    inside = (np.abs(found) < 1).mean()
    assert inside == pytest.approx(0.682689, abs=5 * np.sqrt(0.68 * 0.32 / found.size))
    np.testing.assert_array_equal(
        random.normal_vectors(7, step=3, row=rows[5:9], sample=2), found[5:9]
    )
    for other in ({"step": 4, "sample": 2}, {"step": 3, "sample": 1}):
        assert not np.isclose(random.normal_vectors(7, row=rows[:9], **other), found[:9]).any()
    with pytest.raises(DtypeError, match="normal_vectors: row"):
        random.normal_vectors(7, row=np.zeros(3))

"""Encodings without parameters: golden values, adjoints, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.network import FrequencyEncoding, OneBlobEncoding
from photograd_course.gradcheck import check_gradient, taylor_slope

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants

pytestmark = pytest.mark.usefixtures("core")

ENCODINGS = {"frequency": FrequencyEncoding(4), "one blob": OneBlobEncoding(5, dimensions=2)}
each_encoding = pytest.mark.parametrize("encoding", ENCODINGS.values(), ids=ENCODINGS)


def points_of(encoding: Any, count: int, dtype: Any = np.float64) -> Any:
    return np.random.default_rng(7).random((count, encoding.dimensions)).astype(dtype)


def test_frequencies_in_their_order() -> None:
    points = np.random.default_rng(2).normal(size=(20, 3))
    angles = (2.0 ** np.arange(6)[:, None] * np.pi * points[:, None, :]).reshape(20, -1)
    expected = np.concatenate([points, np.sin(angles), np.cos(angles)], 1)
    np.testing.assert_allclose(FrequencyEncoding(6).encode(points), expected, atol=1e-13)


def test_high_octaves_of_floats_keep_their_digits() -> None:
    points = np.random.default_rng(3).random((200, 3)).astype(np.float32)
    exact = FrequencyEncoding(16).encode(points.astype(np.float64))
    assert np.abs(FrequencyEncoding(16).encode(points) - exact).max() < 1e-6


def test_golden_values() -> None:
    # p = 1/6: sin and cos of 30, 60 and 120 degrees.
    got = FrequencyEncoding(3, dimensions=1).encode(np.array([[1 / 6]]))[0]
    half, root = 0.5, np.sqrt(0.75)
    np.testing.assert_allclose(got, [1 / 6, half, root, root, root, half, -half], atol=1e-15)
    # Centers of two bins, 1/4 and 3/4, around p = 1/4: exp(0) and exp(-(2 / 2)^2 / 2).
    blob = OneBlobEncoding(2, dimensions=1).encode(np.array([[0.25]]))[0]
    np.testing.assert_allclose(blob, [1.0, 0.6065306597126334], atol=1e-15)


@each_encoding
def test_derivatives_agree_with_finite_differences(encoding: Any) -> None:
    points = points_of(encoding, 9)
    d = np.random.default_rng(1).normal(size=(9, encoding.outputs))

    def function(groups: Any) -> Any:
        return {"features": encoding.encode(groups["points"])}

    def backward(groups: Any, cotangent: Any) -> Any:
        return {"points": encoding.encode_backward(groups["points"], cotangent["features"])}

    place = {"points": points}
    report = check_gradient_mutants(function, backward, place, {"features": d}, seed=2)
    assert report, report
    assert check_gradient(function, backward, place, seed=3)
    assert taylor_slope(function, backward, place, seed=4)


@same_bits("encodings", each=ENCODINGS)
def many_points(name: str) -> list[Any]:
    encoding: Any = ENCODINGS[name]
    points = points_of(encoding, 5000, np.float32)
    d = np.random.default_rng(1).normal(size=(5000, encoding.outputs)).astype(np.float32)
    return [encoding.encode(points), encoding.encode_backward(points, d)]


def test_what_is_no_encoding_is_refused_by_name() -> None:
    for octaves in (-1, 25):
        with pytest.raises(RangeError, match="FrequencyEncoding: octaves"):
            FrequencyEncoding(octaves)
    for bins in (0, 257):
        with pytest.raises(RangeError, match="OneBlobEncoding: bins"):
            OneBlobEncoding(bins)
    with pytest.raises(ShapeError, match=r"FrequencyEncoding.encode: points"):
        FrequencyEncoding(2).encode(np.zeros((4, 2)))
    with pytest.raises(RangeError, match=r"OneBlobEncoding.encode: points"):
        OneBlobEncoding(2).encode(np.full((4, 3), np.inf))

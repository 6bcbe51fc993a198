"""The projection keeps the strongest value with its sign, against a plain loop."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.viz import signed_projection, signed_projections, signed_slices
from photograd_course.viz.scale import nice_limit, signed_scale


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_projection_matches_a_loop(axis: int, dtype: type) -> None:
    values = np.random.default_rng(3).normal(size=(3, 4, 5)).astype(dtype)
    result = signed_projection(values, axis)
    moved = np.moveaxis(values, axis, 0)
    assert result.dtype == dtype
    assert result.shape == moved.shape[1:]
    for place in np.ndindex(result.shape):
        column = [float(v) for v in moved[(slice(None), *place)]]
        assert result[place] == max(column, key=abs)


def test_of_opposite_equals_the_first_wins() -> None:
    assert signed_projection(np.array([[[-2.0, 2.0]]]), 2)[0, 0] == -2.0
    assert signed_projection(np.array([[[2.0, -2.0]]]), 2)[0, 0] == 2.0


@pytest.mark.parametrize(
    ("value", "limit"),
    [(0.0, 1.0), (0.3, 0.3), (3.1e-4, 4e-4), (9.7, 10.0), (1.0, 1.0), (2.6, 3.0)],
)
def test_limits_are_round_and_not_below(value: float, limit: float) -> None:
    assert nice_limit(value) == pytest.approx(limit, rel=1e-12)


def test_scale_says_which_ends_are_clipped() -> None:
    values = np.array([[[-3.0, 0.5, 2.0]]])
    assert signed_scale("test", [values], 4.0).extend == "neither"
    assert signed_scale("test", [values], 2.5).extend == "min"
    assert signed_scale("test", [-values], 2.5).extend == "max"
    assert signed_scale("test", [values], 1.0).extend == "both"


BAD = [
    ("values", [[[1.0]]], DtypeError, "a NumPy array"),
    ("values", np.ones((2, 2, 2), dtype=int), DtypeError, "int64"),
    ("values", np.ones((2, 2)), ShapeError, "(X, Y, Z)"),
    ("values", np.ones((2, 0, 2)), ShapeError, "(X, Y, Z)"),
    ("values", np.array([[[1.0, np.nan]]]), RangeError, "(0, 0, 1)"),
    ("bounds", np.zeros((3, 2)), ShapeError, "(2, 3)"),
    ("bounds", np.zeros((2, 3)), RangeError, "lower < upper"),
    ("limit", 0.0, RangeError, "positive"),
    ("outline", np.ones((2, 2, 2)), DtypeError, "boolean"),
    ("outline", np.ones((2, 2, 3), dtype=bool), ShapeError, "(2, 2, 2)"),
]


@pytest.mark.parametrize("draw", [signed_projections, signed_slices])
@pytest.mark.parametrize(("argument", "value", "kind", "part"), BAD)
def test_bad_input_gets_one_typed_sentence(
    draw: Any, argument: str, value: Any, kind: type[Exception], part: str
) -> None:
    good = {"values": np.ones((2, 2, 2)), "bounds": np.array([[0.0, 0, 0], [1, 1, 1]])}
    with pytest.raises(kind) as caught:
        draw(**(good | {argument: value}))
    text = str(caught.value)
    assert text.startswith(f"{draw.__name__}: {argument}: expected ")
    assert part in text


def test_a_point_outside_the_box_is_refused() -> None:
    with pytest.raises(RangeError, match="inside the box"):
        signed_slices(np.ones((2, 2, 2)), [[0, 0, 0], [1, 1, 1]], at=(0.5, 0.5, 1.5))

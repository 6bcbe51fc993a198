"""Kind, shape, dtype and finiteness are asked for before values, and nothing broadcasts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from photograd_course.grading import (
    Array,
    CheckFailed,
    Integer,
    Items,
    Number,
    Record,
    Text,
    Truth,
    asks,
)

GOOD = [
    (Array((2, 3)), np.zeros((2, 3))),
    (Array((0,)), np.zeros(0)),
    (Array((2,), "i8"), np.zeros(2, np.int64)),
    (Number(), 2.5),
    (Number(), 3),
    (Number(), (1 << 63) - 1),
    (Array((2,), finite=False), np.array([0.0, np.nan])),
    (Number(), np.array(1.0)),
    (Number(finite=False, above=0.0), math.inf),
    (Array((None, 3)), np.zeros((0, 3))),
    (Array((None, 3)), np.zeros((7, 3))),
    (Array((None,), "i8"), np.zeros(4, np.int64)),
    (Array((2,), finite=False, above=0.0), np.array([1e-9, np.inf])),
    (Integer(0, 3), 3),
    (Truth(), False),
    (Text(), "x"),
    (Items(Number(), Array((1,))), [1.0, np.zeros(1)]),
    (Record({"a": Number()}), {"a": 1.0}),
]
BAD = [
    (Array((2, 3)), np.zeros((3, 2))),
    (Array((2, 3)), np.zeros((1, 3))),  # would broadcast
    (Array((2, 3)), np.zeros(())),
    (Array((2, 3)), 0.0),
    (Array((2, 3)), [[0.0] * 3] * 2),
    (Array((2,)), np.zeros(2, np.float32)),
    (Array((2,)), np.zeros(2, np.int64)),
    (Array((2,)), np.array([0.0, np.nan])),
    (Array((2,)), np.array([np.inf, 0.0])),
    (Array((2,)), None),
    (Array((None, 3)), np.zeros((3, 2))),
    (Array((None, 3)), np.zeros(3)),
    (Array((None,), "i8"), np.zeros(3)),
    (Array((2,), finite=False, above=0.0), np.array([1.0, 0.0])),
    (Array((2,), finite=False, above=0.0), np.array([np.nan, 1.0])),
    (Array((2,), above=0.0), np.array([1.0, np.inf])),
    (Number(above=0.0), 0.0),
    (Number(finite=False, above=0.0), math.nan),
    (Number(above=0.0), math.inf),
    (Number(), float("nan")),
    (Number(), float("inf")),
    (Number(), True),
    (Number(), np.zeros(1)),
    (Number(), np.array(1.0, np.float32)),
    (Number(), "1"),
    (Number(), 10**400),  # which NumPy can't even ask for finiteness
    (Number(), -(1 << 63)),
    (Integer(), 1.0),
    (Integer(), True),
    (Integer(0, 3), 4),
    (Truth(), 1),
    (Text(2), "abc"),
    (Items(Number(), Number()), [1.0]),
    (Items(Number(), Number()), np.zeros(2)),
    (Record({"a": Number()}), {"a": 1.0, "b": 2.0}),
    (Record({"a": Number()}), {}),
]


@pytest.mark.parametrize(("spec", "value"), GOOD)
def test_what_fits_passes(spec: Number, value: object) -> None:
    spec.require(value, "f")


@pytest.mark.parametrize(("spec", "value"), BAD)
def test_what_does_not_fit_fails_with_a_sentence(spec: Number, value: object) -> None:
    with pytest.raises(CheckFailed, match=r"^f"):
        spec.require(value, "f")


def test_a_service_looks_at_what_it_is_asked() -> None:
    asked: list[object] = []
    service = asks(asked.append, Array((2,), finite=False), name="grad")
    service(np.array([1.0, np.inf]))
    for wrong in ((np.ones((1, 2)),), (np.ones(2, np.float32),), (1.0,), (), (np.ones(2),) * 2):
        with pytest.raises(CheckFailed, match="grad"):
            service(*wrong)
    assert len(asked) == 1


def test_a_forgotten_return_is_recognized() -> None:
    with pytest.raises(CheckFailed, match="return statement"):
        Array((1,)).require(None, "f")


def test_free_axes_and_bounds_are_named() -> None:
    with pytest.raises(CheckFailed, match=r"shape \(any, 3\) and dtype int64, got shape \(2, 2\)"):
        Array((None, 3), "i8").require(np.zeros((2, 2), np.int64), "boxes")
    with pytest.raises(
        CheckFailed, match=r"t: expected values above 0, or infinity, got nan at ind"
    ):
        Array((2,), finite=False, above=0.0).require(np.array([1.0, np.nan]), "t")
    with pytest.raises(CheckFailed, match=r"expected a float above 0, got -1"):
        Number(above=0.0).require(-1.0, "t")

"""What is said of a wrong answer is true, and said of each kind of mistake that numbers show."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd_course.grading.ratios import name_of
from photograd_course.grading.relations import find_relation
from photograd_course.grading.situations import lengths_of, rows_said, situation_of

Array = np.ndarray[Any, Any]
RIGHT = np.random.default_rng(1).normal(size=(5, 3))
PI = math.pi


def said(got: Any, right: Any, tolerance: float = 1e-9, lengths: tuple[int, ...] = ()) -> str:
    found = find_relation(np.asarray(got, float), np.asarray(right, float), tolerance, lengths)
    return "" if found is None else found.text


@pytest.mark.parametrize(
    ("factor", "name"),
    [
        (-1.0, "-1"),
        (2.0, "2"),
        (-2.0, "-2"),
        (0.5, "1/2"),
        (3.0, "3"),
        (1 / 3, "1/3"),
        (4.0, "4"),
        (0.25, "1/4"),
        (-2 / 3, "-2/3"),
        (PI, "pi"),
        (-1 / PI, "-1/pi"),
        (2 * PI, "2 pi"),
        (1 / (2 * PI), "1/(2 pi)"),
        (4 * PI, "4 pi"),
        (1 / (4 * PI), "1/(4 pi)"),
        (PI / 2, "pi/2"),
        (math.log(2), "ln 2"),
        (1 / math.log(2), "1/(ln 2)"),
        (1 / math.sqrt(2 * PI), "1/(sqrt(2 pi))"),
        (180 / PI, "180/pi"),
        (1 / 255, "1/255"),
        (0.123457, "0.123457"),
    ],
)
def test_a_constant_factor_has_its_name(factor: float, name: str) -> None:
    assert name_of(factor) == name
    assert f"all of yours are {name} times what is expected" in said(factor * RIGHT, RIGHT)
    for number in (0.7, np.array(0.7)):
        assert ("." in name) or f"yours is {name} times" in said(factor * number, number)


def test_the_sign_is_said_in_words() -> None:
    words = "all of yours are -1 times what is expected (your sign is reversed)"
    assert said(-RIGHT, RIGHT) == words
    assert said(-3 * RIGHT, RIGHT).endswith(
        "-3 times what is expected (your sign is reversed as well)"
    )
    found = find_relation(-RIGHT, RIGHT, 1e-9)
    assert found is not None
    assert (found.kind, found.explains) == ("all of yours are of the wrong sign", True)


@pytest.mark.parametrize("factor", [7.0, 1 / 7, 11.0, 10 / 11])
def test_a_length_of_the_arguments_is_named(factor: float) -> None:
    lengths = lengths_of([np.zeros((7, 3)), [np.zeros(11)], {"a": np.zeros(4)}, 2.0])
    assert lengths >= {3, 4, 7, 11, 21}
    n = 7 if abs(factor * 7 - 1) < 1e-9 or factor == 7 else 11
    assert f"({n} is a length" in said(factor * RIGHT, RIGHT, lengths=tuple(lengths))
    assert "length" not in said(factor * RIGHT, RIGHT)


def test_zeros_are_ignored_and_finite_differences_are_good_enough() -> None:
    right = RIGHT * (RIGHT > -0.5)
    assert "are 2 times" in said(2 * right, right)
    noise = 1e-8 * np.random.default_rng(2).normal(size=RIGHT.shape)
    assert "are 1/2 times" in said(0.5 * RIGHT, RIGHT + noise, 1e-6)
    assert said(0.5 * RIGHT, RIGHT + 1e3 * noise, 1e-6) == ""


@pytest.mark.parametrize("factor", [-1.0, 2.0, 0.5, 3.0, PI, -1 / (4 * PI)])
def test_a_rough_check_tells_plain_factors_as_far_as_it_can(factor: float) -> None:
    noise = 1 + 1e-3 * np.random.default_rng(2).normal(size=RIGHT.shape)
    text = said(factor * RIGHT * noise, RIGHT, 2e-3)
    assert text.startswith(f"all of yours are {name_of(factor)} times what is expected, as far as")
    assert said(factor * RIGHT * noise, RIGHT, 1e-4) == ""
    assert said(1.1 * factor * RIGHT * noise, RIGHT, 2e-3) == ""


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_nothing_is_said_where_a_value_is_not_finite(bad: float) -> None:
    got = -RIGHT
    got[2, 1] = bad
    assert said(got, RIGHT) == ""


ORDERS: dict[str, Callable[[Array], Array]] = {
    "your columns are those expected, in reverse order": lambda x: x[:, ::-1],
    "your rows are those expected, in reverse order": lambda x: x[::-1],
    "your columns 1 and 2 are exchanged": lambda x: x[:, [0, 2, 1]],
    "your columns are those expected, shifted by one in a circle": lambda x: np.roll(x, 1, 1),
    "your rows are those expected, in another order: 1, 0, 4, 2, 3": lambda x: x[[1, 0, 4, 2, 3]],
    "yours has the expected values in another order": lambda x: x.ravel("F").reshape(x.shape),
    "your rows are shifted by one: each is what is expected of the next": (
        lambda x: np.concatenate([x[1:], [x[0] + 1.0]])
    ),
    "your rows are shifted by one: each is what is expected of the previous": (
        lambda x: np.concatenate([[0 * x[0]], x[:-1]])
    ),
}


@pytest.mark.parametrize("text", ORDERS)
def test_right_values_at_wrong_places(text: str) -> None:
    assert said(ORDERS[text](RIGHT), RIGHT) == text


def test_transposed() -> None:
    square = RIGHT[:3]
    assert said(square.T, square) == "yours is the transpose of what is expected"
    cube = np.random.default_rng(3).normal(size=(4, 3, 3))
    assert said(cube.swapaxes(1, 2), cube).endswith("expected, axes 1 and 2 exchanged")
    assert (
        said(RIGHT[:, 0][::-1], RIGHT[:, 0]) == "your entries are those expected, in reverse order"
    )


VALUES: dict[str, Callable[[Array], Array]] = {
    "all of yours are 0.25 more than what is expected": lambda x: x + 0.25,
    "all of yours are 1 less than what is expected": lambda x: x - 1.0,
    "all of yours are the absolute values of what is expected": np.abs,
    "all of yours are the squares of what is expected": np.square,
    "all of yours are the reciprocals of what is expected": np.reciprocal,
    "all of yours are the exponentials of what is expected": np.exp,
    "all of yours are the values clamped at 0 of what is expected": lambda x: np.maximum(x, 0),
    "all of yours are the complements, 1 minus the value, of what is expected": lambda x: 1 - x,
    "yours have the wrong sign at 2 of 15 entries, and are right elsewhere": (
        lambda x: np.where(np.isin(np.arange(15), (3, 7)).reshape(x.shape), -x, x)
    ),
    "yours are 0 at 2 of 15 entries, where they should not be, and right elsewhere": (
        lambda x: np.where(np.isin(np.arange(15), (3, 7)).reshape(x.shape), 0, x)
    ),
    "all of yours are 0": lambda x: 0 * x,
    "all of yours are equal, the expected ones are not": lambda x: 0 * x + 0.3,
}


@pytest.mark.parametrize("text", VALUES)
def test_one_function_of_each_value(text: str) -> None:
    assert said(VALUES[text](RIGHT), RIGHT) == text


@pytest.mark.parametrize("text", [*ORDERS, *VALUES])
def test_hidden_checks_hear_the_kind_without_a_number_of_the_answer(text: str) -> None:
    found = find_relation({**ORDERS, **VALUES}[text](RIGHT), RIGHT, 1e-9)
    assert found is not None
    assert not re.search(r"\d\.\d|\d of \d|\d, \d|\d and \d are", found.kind)
    assert found.kind[0] != " "


def test_the_other_way_round() -> None:
    assert said(RIGHT, np.abs(RIGHT)) == "what is expected are the absolute values of yours"
    assert said(RIGHT, np.square(RIGHT)) == "what is expected are the squares of yours"
    masked = RIGHT * (np.arange(15).reshape(5, 3) % 5 > 0)
    assert said(RIGHT, masked).startswith("yours are not 0 at 3 of 15 entries")


def test_the_part_that_is_wrong() -> None:
    got = RIGHT.copy()
    got[:, 1] *= -1
    assert said(got, RIGHT) == (
        "only column 1 of yours is wrong: "
        "all of yours are -1 times what is expected (your sign is reversed)"
    )
    got = RIGHT.copy()
    got[-1] = 0.1, 0.2, 0.5
    assert said(got, RIGHT) == "only the last row of yours is wrong"
    got[0] = 0.1, 0.2, 0.5
    assert said(got, RIGHT) == "only rows 0 and 4 of yours are wrong"
    got = RIGHT[:, 0] + [0, 0, 0, 0, 1]
    found = find_relation(got, RIGHT[:, 0], 1e-9)
    assert found is not None
    assert (found.text, found.explains) == ("only the last entry of yours is wrong", False)
    assert found.kind == "only some entries of yours are wrong"


def test_a_factor_without_a_name_leaves_room_for_advice() -> None:
    found = find_relation(1.37 * RIGHT, RIGHT, 1e-9)
    assert found is not None
    assert (found.text, found.explains) == ("all of yours are 1.37 times what is expected", False)


def test_coincidences_explain_nothing() -> None:
    """Few different values: what is seen is said, and advice stays."""
    for got, right in ((2.0, 1.0), (np.full(4, -1.0), np.ones(4)), ([0, 2.0], [0, 1.0])):
        found = find_relation(np.asarray(got), np.asarray(right), 1e-9)
        assert found is not None
        assert not found.explains
    assert said(0.37, 1.0) == ""
    assert said([0.37, 0.37], [1.0, 1.0]) == ""


def test_a_random_answer_has_no_relation() -> None:
    rng = np.random.default_rng(5)
    for shape in ((), (1,), (2,), (3,), (4, 4), (2, 3, 3)):
        for _ in range(50):
            assert said(rng.normal(size=shape), rng.normal(size=shape)) == ""


def test_small_entries_are_looked_at() -> None:
    right = np.array([1e6, 1.0, 2.0, 3.0])
    assert "-1" not in said(right * [-1, 1, 1, 1], right, 1e-9)
    assert said(np.zeros(3), np.zeros(3)) == ""


def test_the_class_of_sizes_of_a_call() -> None:
    rows = {n: (np.ones((n, 3)), 0.5) for n in (0, 1, 5, 100)}
    classes = [situation_of(args) for args in rows.values()]
    assert classes == ["for no rows", "for one row", "", ""]  # many are everyday arguments
    assert [rows_said(n) for n in rows] == ["for no rows", "for one row", "", "for many rows"]
    assert situation_of([np.array([1.0, 2e6]), np.ones((1, 2))]) == "at a large magnitude"
    assert situation_of([[np.array([1.0, np.nan])]]) == "where a value is not finite"
    assert situation_of([3.0, np.ones(1)]) == ""
    assert (
        situation_of([{"balls": np.ones((0, 3))}, np.ones((4, 3))]) == ""
    )  # a scene without balls

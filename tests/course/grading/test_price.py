"""The price of an adjoint guards the points of its task."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from photograd_course.grading import Array, Check, Number, Status, Tolerance, Trial, check
from photograd_course.grading.cost import require_cheap
from photograd_course.grading.failures import StudentFailure
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.runner import Setting, run_checks

N = 3000
CODE = """
import numpy as np

def forward(x):
    return float(np.sum(np.exp(-x)))

def slope(x):
    return -np.exp(-x)

def other(x):
    return x
"""
SLOW = CODE.replace(
    "return -np.exp(-x)", "return np.array([-np.exp(-x)[i] for i in range(x.size)])"
)
EXACT = Tolerance(1e-12, "tests")


@check("1.1.value", points=3, calls=("slope",), tolerance=EXACT)
def value(t: Trial) -> None:
    """The derivative is right."""
    t.close("d_x", t.call("slope", t.rng.random(3) * 0, returns=Array((3,))), [-1.0] * 3)


@check("1.1.other", points=2, calls=("other",), tolerance=EXACT)
def other(t: Trial) -> None:
    """Another function of the task."""
    t.close("x", t.call("other", 1.0, returns=Number()), 1.0)


@check("1.2.later", points=2, calls=("slope",), tolerance=EXACT)
def later(t: Trial) -> None:
    """A later task that uses it."""
    value.body(t)


@check("1.1.cost", points=1, calls=("slope",), tolerance=EXACT)
def cost(t: Trial) -> None:
    """It is cheap."""
    value.body(t)
    x = t.rng.random(N)
    require_cheap(t, ("forward", (x,), Number()), ("slope", (x,), Array((N,))))


CHECKS: list[Check] = [value, other, cost, later]


class Late(LocalStudent):
    """Does not answer about many numbers."""

    def call(self, function: str, args: Any, *, seconds: float) -> Any:
        if getattr(args[0], "size", 0) == N:
            raise StudentFailure("timeout", "no answer")
        return super().call(function, args, seconds=seconds)


def points(kind: type[LocalStudent], text: str) -> dict[str, float]:
    def open_one(given: Mapping[str, Any]) -> LocalStudent:
        return kind({"m": text}, given)

    found = run_checks(CHECKS, lambda _: Setting("m", (1,)), open_one)
    assert all(outcome.status is Status.PASSED for outcome in found if outcome.points)
    return {outcome.id: outcome.points for outcome in found}


def test_a_written_derivative_keeps_its_points() -> None:
    assert points(LocalStudent, CODE) == {
        "1.1.value": 3.0,
        "1.1.other": 2.0,
        "1.1.cost": 1.0,
        "1.2.later": 2.0,
    }


@pytest.mark.parametrize(("kind", "text"), [(LocalStudent, SLOW), (Late, CODE)])
def test_one_that_costs_too_much_loses_those_of_its_task(
    kind: type[LocalStudent], text: str
) -> None:
    assert points(kind, text) == {
        "1.1.value": 0.0,
        "1.1.other": 2.0,
        "1.1.cost": 0.0,
        "1.2.later": 2.0,
    }


def test_a_check_of_the_price_is_known() -> None:
    assert [each.is_price for each in CHECKS] == [False, False, True, False]
    assert cost.adjoints == ("slope",)
    assert value.adjoints == ()

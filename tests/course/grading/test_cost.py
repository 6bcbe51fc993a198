"""The cap on cost holds against brute force, remembered answers and wasted time."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from photograd_course.grading import Array, CheckFailed, Number, Tolerance, Trial, check
from photograd_course.grading.cost import require_cheap, require_close
from photograd_course.grading.local import LocalStudent

N = 4000
CODE = """
import numpy as np

def fast(x):
    return np.sum(np.exp(-x))

def forward(x):
    return float(fast(x))

def slow_forward(x):
    for _ in range(1500):
        fast(x)
    return float(fast(x))

def backward(x, g):
    return -g * np.exp(-x)

def uphill(x, g):
    return g * np.exp(-x)

def by_steps(x, g):
    found = np.zeros(x.size)
    for i in range(x.size):
        moved = x.astype(complex)
        moved[i] += 1e-30j
        found[i] = g * fast(moved).imag / 1e-30
    return found

KNOWN = {}

def remembered(x, g):
    if x.size not in KNOWN:
        KNOWN[x.size] = by_steps(x, g)
    return KNOWN[x.size]
"""


@pytest.fixture
def trial() -> Trial:
    def body(t: Trial) -> None:
        """Something holds."""

    names = ("forward", "slow_forward")
    reference = SimpleNamespace(
        **dict.fromkeys(names, lambda x: float(np.sum(np.exp(-x)))),
        **dict.fromkeys(
            ("backward", "by_steps", "remembered", "uphill"), lambda x, g: -g * np.exp(-x)
        ),
    )
    made = check("1.x", points=1, calls=(), tolerance=Tolerance(1e-9, "tests"))(body)
    return Trial(made, LocalStudent({"m": CODE}), seed=(1,), module="m", reference=reference)


def price(trial: Trial, forward: str, backward: str) -> None:
    x = np.linspace(-2.0, 2.0, N)
    trial.call(backward, x, 0.7, returns=Array((N,)))  # a cache could be filled here
    require_cheap(trial, (forward, (x,), Number()), (backward, (x, 0.7), Array((N,))))


def test_an_adjoint_is_cheap(trial: Trial) -> None:
    price(trial, "forward", "backward")


def test_brute_force_is_not(trial: Trial) -> None:
    with pytest.raises(CheckFailed, match="forward calls, allowed 20"):
        price(trial, "forward", "by_steps")


def test_a_remembered_answer_is_called_one(trial: Trial) -> None:
    with pytest.raises(CheckFailed, match="returns the answer to an earlier call"):
        price(trial, "forward", "remembered")


def test_so_is_one_that_a_timed_call_was_the_first_to_get(trial: Trial) -> None:
    x = np.linspace(-2.0, 2.0, N)
    forward = ("forward", (x,), Number())
    with pytest.raises(CheckFailed, match="returns the answer to an earlier call"):
        require_cheap(trial, forward, ("remembered", (x, 0.7), Array((N,))))


def test_a_wrong_value_is_called_wrong_and_accuses_of_nothing(trial: Trial) -> None:
    with pytest.raises(CheckFailed) as caught:
        price(trial, "forward", "uphill")
    said = f"{caught.value} {caught.value.details['advice']}"
    assert "uphill, in a call that is timed: relative error 2.0e+00" in said
    assert "all of yours are -1 times what is expected" in said.lower()
    assert "earlier" not in said
    assert "arguments" not in said


def test_the_part_that_is_wrong_is_named(trial: Trial) -> None:
    right = {"a": np.ones(3), "b": [2.0, np.arange(3.0)]}
    wrong = {"a": np.ones(3), "b": [2.0, np.arange(3.0) + 1e-3]}
    with pytest.raises(CheckFailed, match="x, b, item 1: relative error"):
        require_close(trial, "x", wrong, right)
    require_close(trial, "x", right, right)


def test_a_slow_forward_function_does_not_help(trial: Trial) -> None:
    with pytest.raises(CheckFailed, match="3000 forward calls should"):
        price(trial, "slow_forward", "by_steps")


def in_steps(clock: Callable[[], float], step: float) -> Callable[[], float]:
    """A clock that counts in steps, as kernels do that count processor time by their timer."""
    return lambda: np.floor(clock() / step) * step


@pytest.mark.parametrize("attempt", range(2))
def test_a_clock_of_coarse_steps_changes_no_verdict(
    trial: Trial, monkeypatch: pytest.MonkeyPatch, attempt: int
) -> None:
    del attempt  # the steps fall differently each time
    monkeypatch.setattr(time, "process_time", in_steps(time.process_time, 0.004))
    price(trial, "forward", "backward")
    with pytest.raises(CheckFailed, match="forward calls, allowed 20"):
        price(trial, "forward", "by_steps")

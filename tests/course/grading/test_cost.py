"""The cap on cost holds against brute force, remembered answers and wasted time."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from photograd_course.grading import Array, CheckFailed, Number, Tolerance, Trial, check
from photograd_course.grading.cost import require_cheap
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
        **dict.fromkeys(("backward", "by_steps", "remembered"), lambda x, g: -g * np.exp(-x)),
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


def test_remembered_answers_do_not_belong_to_the_arguments(trial: Trial) -> None:
    with pytest.raises(CheckFailed, match="does not belong to its arguments"):
        price(trial, "forward", "remembered")


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

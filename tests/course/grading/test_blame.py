"""Whose doing it is when a check breaks: the control, a run with the solution, tells."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.grading import Array, Check, Number, Outcome, Status, Trial, check
from photograd_course.grading.adjoint_gate import agrees_with_finite_differences
from photograd_course.grading.failures import GraderFault
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.runner import run_checks

TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"
GOOD = (TOY / "toy.py").read_text(encoding="utf-8")
RIGHT = "return float(np.sum(w * np.exp(-x)))"
assert RIGHT in GOOD
Body = Callable[[Trial], None]


@pytest.fixture(scope="module")
def bundle() -> Bundle:
    return read_folder(TOY)


@pytest.fixture
def outcome(bundle: Bundle) -> Callable[..., Outcome]:
    """The outcome of one check for a text, and how often the control was opened."""
    opened: list[None] = []

    def run(body: Body, text: str = GOOD, *, control: str | None = GOOD, times: int = 1) -> Outcome:
        def open_control() -> LocalStudent:
            opened.append(None)
            return LocalStudent({"toy": control or ""})

        made: Check = check("90.1.x", points=1, calls=("weighted_sum",))(body)
        (found,) = run_checks(
            [made],
            bundle.setting,
            lambda given: LocalStudent({"toy": text}, given),
            open_control=None if control is None else open_control,
        )
        assert len(opened) == times
        return found

    return run


def rows_of_any_length(t: Trial) -> None:
    """It keeps what it is asked, and never thought of ragged rows."""
    asked = []

    def gradient(x: Any) -> Any:
        asked.append(np.array(x))
        return x

    t.call("descend", gradient, np.ones(2), 0.5, 2, returns=Array((3, 2)))
    t.require(len(np.array(asked)) == 2, "two steps")


RAGGED = GOOD.replace(
    "gradient(trail[-1])", "np.ravel(gradient(trail[-1][None] if _ else trail[-1]))"
)
assert RAGGED != GOOD


def test_a_check_that_breaks_for_this_submission_alone_has_failed(
    outcome: Callable[..., Outcome],
) -> None:
    assert outcome(rows_of_any_length, times=0).status is Status.PASSED
    failed = outcome(rows_of_any_length, RAGGED)
    assert (failed.status, failed.points, failed.reason) == (Status.FAILED, 0.0, "output")
    assert failed.details["exception"].startswith("ValueError")


def differences_of_your_own(t: Trial) -> None:
    """Its expected values come from the submission, and may overflow."""
    agrees_with_finite_differences(
        t,
        {"x": -np.exp([-0.5])},
        lambda p: t.call("weighted_sum", np.ones(1), p["x"], returns=Number()),
        {"x": np.array([0.5])},
        np.asarray(1.0),
    )


def test_expected_values_that_a_submission_makes_infinite_are_its_failure(
    outcome: Callable[..., Outcome],
) -> None:
    assert outcome(differences_of_your_own, times=0).status is Status.PASSED
    huge = GOOD.replace(RIGHT, "return 1.7e308 if x[0] > 0.5 else -1.7e308")
    with np.errstate(over="ignore"):
        failed = outcome(differences_of_your_own, huge)
    assert (failed.status, failed.reason) == (Status.FAILED, "output")
    assert "GraderFault" in failed.details["exception"]


def breaks_always(t: Trial) -> None:
    """It has a mistake."""
    t.call("weighted_sum", np.ones(1), np.ones(1), returns=Number())
    raise KeyError("ours")


def test_a_check_that_breaks_for_the_solution_too_is_ours(outcome: Callable[..., Outcome]) -> None:
    assert outcome(breaks_always).status is Status.ERROR_OURS


def test_without_the_solution_it_is_ours(outcome: Callable[..., Outcome]) -> None:
    assert outcome(rows_of_any_length, RAGGED, control=None, times=0).status is Status.ERROR_OURS


def test_a_control_that_does_not_run_accuses_nobody(outcome: Callable[..., Outcome]) -> None:
    found = outcome(rows_of_any_length, RAGGED, control="import nothing_of_the_kind")
    assert found.status is Status.ERROR_OURS


@pytest.mark.parametrize("trouble", [OSError("no file left"), MemoryError()])
def test_a_machine_in_trouble_is_ours_without_a_control(
    outcome: Callable[..., Outcome], trouble: Exception
) -> None:
    def body(_t: Trial) -> None:
        """It needs the machine."""
        raise trouble

    assert outcome(body, times=0).status is Status.ERROR_OURS


def test_a_worker_that_does_not_start_is_ours_without_a_control(bundle: Bundle) -> None:
    def no_worker(_given: object) -> LocalStudent:
        raise GraderFault("no worker")

    def no_control() -> LocalStudent:
        raise AssertionError

    found = run_checks(bundle.checks[:1], bundle.setting, no_worker, open_control=no_control)
    assert found[0].status is Status.ERROR_OURS

"""Comparisons: what passes, what fails, and what a failure may tell."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd_course.errors import RangeError
from photograd_course.grading import (
    Array,
    Check,
    CheckFailed,
    GraderFault,
    Number,
    Tolerance,
    Trial,
    check,
)
from photograd_course.grading.failures import NotFinite, StudentFailure
from photograd_course.grading.hints import fingerprint
from photograd_course.grading.local import LocalStudent

TIGHT = Tolerance(1e-6, "for these tests")
CODE = "def f(x):\n    return x + 1.0\n\ndef g(x):\n    raise ValueError('no')\n"


def trial(visibility: str = "public", tolerance: Tolerance | None = TIGHT) -> Trial:
    def body(t: Trial) -> None:
        """Something holds."""

    made: Check = check("1.x", points=1, calls=("f",), visibility=visibility, tolerance=tolerance)(
        body
    )
    return Trial(made, LocalStudent({"m": CODE}), seed=(1,), module="m")


def failure(t: Trial, got: Any, expected: Any, **options: Any) -> CheckFailed:
    with pytest.raises(CheckFailed) as caught:
        t.close("d_x", np.asarray(got), np.asarray(expected), **options)
    return caught.value


def test_close_is_relative_to_the_norm() -> None:
    t = trial()
    right = np.array([1000.0, 1e-3])
    t.close("x", right + np.array([5e-4, 0.0]), right)
    assert t.margins == [pytest.approx(0.5, rel=1e-3)]
    told = failure(t, right + np.array([2e-3, 0.0]), right)
    assert told.details["error"] == pytest.approx(2e-6, rel=1e-3)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_never_passes(bad: float) -> None:
    failure(trial(), [1.0, bad], [1.0, 2.0])


def test_zeros_never_pass_for_a_small_signal() -> None:
    failure(trial(), np.zeros(4), np.full(4, 1e-9))


def test_zero_is_close_to_zero_and_nothing_else_is() -> None:
    t = trial()
    t.close("x", np.zeros(3), np.zeros(3))
    failure(t, [0.0, 1e-300, 0.0], np.zeros(3))
    t.close("x", [1e-8], [0.0], Tolerance(1e-6, "of one", floor=1.0))


def test_nothing_broadcasts() -> None:
    failure(trial(), 1.0, np.ones(3))
    failure(trial(), np.ones((1, 3)), np.ones(3))


def test_a_failure_names_the_worst_index_and_hides_the_value() -> None:
    told = failure(trial("hidden"), [[1.0, 2.0], [3.0, 4.0]], [[1.0, 2.0], [-0.0625, 4.0]])
    assert told.details["worst_index"] == [1, 0]
    assert "negative" in str(told)
    assert "1e-02" in str(told)
    assert "0.0625" not in str(told)
    revealed = failure(trial("hidden"), [3.0], [-0.0625], reveal=True)
    assert "0.0625" not in str(revealed)
    assert "0.0625" in str(failure(trial("public"), [3.0], [-0.0625], reveal=True))


def test_numbers_that_differ_are_never_shown_as_equal() -> None:
    told = str(
        failure(trial("public", Tolerance(1e-12, "tight")), [1.0 + 1e-9], [1.0], reveal=True)
    )
    assert "is 1.000000001, expected 1" in told
    short = str(failure(trial("public"), [3.0], [2.5], reveal=True))
    assert "is 3, expected 2.5" in short


def test_what_the_grader_does_wrong_is_its_fault() -> None:
    with pytest.raises(GraderFault, match="without a tolerance"):
        trial(tolerance=None).close("x", 1.0, 1.0)
    with pytest.raises(GraderFault, match="not finite"):
        trial().close("x", 1.0, np.nan)
    with pytest.raises(GraderFault, match="nothing"):
        trial().close("x", np.zeros(0), np.zeros(0))
    with pytest.raises(GraderFault, match="reference"):
        _ = trial().reference


def test_calls_are_checked_and_arguments_copied() -> None:
    t = trial()
    assert t.call("f", 2.0, returns=Number()) == 3.0
    with pytest.raises(CheckFailed):
        t.call("f", np.zeros(2), returns=Number())
    t.refuses("g", 1.0, error="ValueError")
    with pytest.raises(CheckFailed, match="it returned"):
        t.refuses("f", 1.0, error="ValueError")
    with pytest.raises(CheckFailed, match="another exception"):
        t.refuses("g", 1.0, error="TypeError")


def test_require_takes_true_only() -> None:
    t = trial()
    t.require(True, "holds")
    t.require(np.bool_(True), "holds")  # type: ignore[arg-type]
    for wrong in (False, 1, "yes", np.ones(1, bool)):
        with pytest.raises(CheckFailed):
            t.require(wrong, "does not hold")  # type: ignore[arg-type]


def test_fingerprints_agree_up_to_rounding_and_differ_otherwise() -> None:
    x = np.random.default_rng(1).normal(size=50)
    assert fingerprint("a", x) == fingerprint("a", x * (1 + 1e-14))
    assert fingerprint("a", x) != fingerprint("a", x * (1 + 1e-5))
    assert fingerprint("a", x) != fingerprint("b", x)
    assert fingerprint("a", x) != fingerprint("a", -x)
    assert fingerprint("a", x) != fingerprint("a", 2 * x)
    assert fingerprint("a", np.zeros(3)) == fingerprint("a", -np.zeros(3))


def test_a_check_needs_a_title_and_points() -> None:
    with pytest.raises(RangeError, match="docstring"):
        check("1.x", points=1, calls=())(lambda _t: None)
    with pytest.raises(RangeError, match="points"):
        check("1.x", points=0, calls=())
    with pytest.raises(RangeError, match="visibility"):
        check("1.x", points=1, calls=(), visibility="open")


def test_a_service_may_give_the_verdict_whatever_the_submission_makes_of_it() -> None:
    code = "def quiet(f):\n    try:\n        f(1.0)\n    except Exception:\n        return 1.0\n"
    code += "def loud(f):\n    f(1.0)\n"

    def body(t: Trial) -> None:
        """Something holds."""

    whole = check("1.x", points=1, calls=("quiet",))(body)

    def stop(_x: float) -> float:
        raise CheckFailed("called too often")

    for function in ("quiet", "loud"):
        t = Trial(whole, LocalStudent({"m": code}), seed=(1,), module="m")
        with pytest.raises(CheckFailed, match="too often"):
            t.call(function, stop, returns=Number())


def test_a_zero_is_a_plain_zero() -> None:
    revealed = str(failure(trial("public"), [-0.0, 2.0], [1.0, 2.0], reveal=True))
    assert "is 0, expected 1" in revealed
    hidden = str(failure(trial("hidden"), [1.0, 2.0], [-0.0, 2.0]))
    assert "is 1, expected zero" in hidden


def test_a_large_error_is_of_no_right_order_of_magnitude() -> None:
    assert "right sign and order of magnitude" in str(failure(trial("hidden"), [2.0], [1.5]))
    told = str(failure(trial("hidden"), [9.0], [1.5]))
    assert "of the right sign, but wrong" in told


def test_a_failure_names_the_argument_that_was_changed_and_the_class_of_arguments() -> None:
    code = "def f(a, b):\n    b['x'][0] = 7.0\n    return a\n\ndef g(a):\n    return 1.0 / a[0]\n"

    def body(t: Trial) -> None:
        """Something holds."""

    t = Trial(
        check("1.x", points=1, calls=("f",))(body), LocalStudent({"m": code}), seed=(1,), module="m"
    )
    given = np.ones(3), {"x": np.ones(2)}
    with pytest.raises(CheckFailed, match="f: changes its second argument") as caught:
        t.look("f", *given, returns=Array((3,)))
    assert caught.value.details["explained"] is True
    with pytest.raises(StudentFailure) as raised:
        t.call("g", np.zeros((0, 2)), returns=Number())
    assert raised.value.case == "for no rows"
    with pytest.raises(StudentFailure) as raised:
        t.call("absent", np.zeros((0, 2)), returns=Number())
    assert raised.value.case == ""  # of no argument's doing
    with t.situation("for one row"), pytest.raises(CheckFailed) as failed:
        t.close("y", 1.0, 2.0, TIGHT)
    assert "case" not in failed.value.details  # the block itself adds it
    with pytest.raises(CheckFailed) as failed, t.situation("for one row"):
        t.close("y", 1.0, 2.0, TIGHT)
    assert failed.value.details["case"] == "for one row"


def test_one_derivative_of_two_losses_has_two_fingerprints() -> None:
    """Where a submission's own values are expected, its answer alone tells no mistake."""
    right = np.random.default_rng(1).normal(size=5)
    halved, third = failure(trial(), right, right / 2), failure(trial(), right, right / 3)
    assert halved.fingerprint != third.fingerprint
    noise = 1e-9 * np.random.default_rng(2).normal(size=5)
    assert failure(trial(), right, right / 2 + noise).fingerprint == halved.fingerprint


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_of_what_is_not_finite_no_mistake_is_known(bad: float) -> None:
    told = failure(trial(), [1.0, bad, 2.0], [1.0, 2.0, 2.0], hint="mind the sign")
    assert isinstance(told, NotFinite)
    assert str(told) == "d_x: 1 of 3 values are not finite, the first at (1,)"
    assert told.fingerprint is None
    assert "advice" not in told.details

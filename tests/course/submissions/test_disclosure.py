"""Hidden checks say nothing that a submission could have written into its answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.grading import Number, Outcome, Status, Trial, check
from photograd_course.submissions.disclosure import for_student, magnitude
from photograd_course.submissions.report import Report
from photograd_course.submissions.report_gradescope import as_results
from photograd_course.submissions.report_html import render_page

SPY = """
import numpy as np

def weighted_sum(w, x):
    {leak}
"""

# Each hands the first input value, 0.4242, to the report by another way.
LEAKS = {
    "text of an exception": "raise ValueError(f'w is {w[0]}')",
    "name of an exception": "raise type('W' + str(int(w[0] * 1e4)), (Exception,), {})()",
    "the value itself": "return float(w[0])",
    "a shape": "return np.zeros(int(w[0] * 1e4))",
    "something that cannot be sent": "return type('W' + str(int(w[0] * 1e4)), (), {})()",
    "a dict": "return {str(w[0]): 1.0}",
    "output": "print(w[0]); raise SystemExit(int(w[0] * 1e4))",
}


def spied(bundle: Bundle, visibility: str) -> Bundle:
    @check("90.1.spied", points=3, calls=("weighted_sum",), visibility=visibility)
    def spied_upon(t: Trial) -> None:
        """The sum is right."""
        import numpy as np
        from photograd_course.grading import Tolerance

        value = np.array([0.4242, 1.0])
        s = t.call("weighted_sum", value, value, returns=Number())
        t.close("s", s, 7.7, Tolerance(1e-9, "a test"))

    return replace(bundle, checks=(spied_upon,))


@pytest.mark.parametrize("leak", LEAKS.values(), ids=list(LEAKS))
@pytest.mark.parametrize("visibility", ["hidden", "secret"])
def test_a_hidden_input_reaches_no_report(
    grade_text: Callable[..., Report], bundle: Bundle, leak: str, visibility: str
) -> None:
    report = grade_text(SPY.format(leak=leak), spied(bundle, visibility))
    assert report.checks[0].status is Status.FAILED
    for shown in (render_page(report), str(as_results(report)["tests"])):
        assert "4242" not in shown
        assert "7.7" not in shown


def test_public_checks_say_all(grade_text: Callable[..., Report], bundle: Bundle) -> None:
    report = grade_text(SPY.format(leak=LEAKS["text of an exception"]), spied(bundle, "public"))
    assert "0.4242" in render_page(report)  # the same payload does work where nothing is hidden


def outcome(**changes: object) -> Outcome:
    base = Outcome(
        "1.a",
        "t",
        "1",
        "hidden",
        Status.FAILED,
        0,
        1,
        "wrong",
        "d_w: relative error 3.7e-02, allowed 1e-06; yours at index (3,) is 4.4, expected positive",
        "forgot w",
        {"error": 0.037, "tolerance": 1e-6, "worst_index": [3], "fingerprint": "f"},
    )
    return replace(base, **changes)  # type: ignore[arg-type]


def test_a_hidden_error_keeps_its_order_of_magnitude() -> None:
    shown = for_student(outcome())
    assert shown.text == "d_w: relative error about 1e-02, allowed 1e-06"
    assert shown.hint == "forgot w"
    assert shown.details == {"error": 0.01, "tolerance": 1e-6}
    assert for_student(outcome(visibility="public")) == outcome(visibility="public")
    assert for_student(outcome(visibility="secret")).text == ""


def test_a_hidden_check_says_the_class_of_arguments_and_of_the_relation() -> None:
    seen = {"error": 0.037, "tolerance": 1e-6, "relation": "all of yours are of the wrong sign"}
    shown = for_student(outcome(details={**seen, "case": "for one row"}))
    assert shown.text == (
        "d_w: relative error about 1e-02, allowed 1e-06; all of yours are of the wrong sign "
        "(for one row)"
    )
    raised = outcome(reason="raised", text="f raised an exception (for no rows)")
    shown = for_student(replace(raised, details={"case": "for no rows"}))
    assert shown.text == "a function raised an exception (for no rows)"


def test_our_own_errors_are_not_explained_to_students() -> None:
    shown = for_student(outcome(status=Status.ERROR_OURS, text="KeyError: 'expected[3]'"))
    assert "KeyError" not in shown.text
    assert "no points are lost" in shown.text


def test_magnitudes() -> None:
    values = [0.037, 1.0, 5.0, float("inf"), float("nan"), 0.0]
    assert [magnitude(value) for value in values] == [0.01, 1.0, 1.0, 1.0, 1.0, 0.0]

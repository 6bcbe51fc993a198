"""One submission through real workers: every check judged, none missing, ours told from theirs."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.errors import SceneError
from photograd_course.grading import Number, Trial, check
from photograd_course.grading.failures import GraderFault
from photograd_course.submissions.one import Case, grade_one
from photograd_course.submissions.report import Report
from photograd_course.submissions.report_json import read_record, verdict_digest, write_record
from photograd_course.submissions.submission import Submission
from photograd_course.submissions.workers import Workers

Grade = Callable[..., Report]
SECRET = b"a secret of the tests"


def statuses(report: Report) -> dict[str, str]:
    return {outcome.id: outcome.status.value for outcome in report.checks}


def reasons(report: Report) -> set[str]:
    return {outcome.reason for outcome in report.checks}


def test_the_solution_gets_every_point_of_the_code(
    grade_text: Grade, solution: str, bundle: Bundle
) -> None:
    report = grade_text(solution)
    assert set(statuses(report)) == {each.id for each in bundle.checks}
    assert set(statuses(report).values()) == {"passed"}
    assert (report.proven, report.score, report.max_score) == (15.0, 15.0, 21.0)
    assert report.is_sound
    assert report.mode == "E"
    assert "indicative only" in " ".join(report.remarks)


def test_a_mistake_costs_its_own_task_only(grade_text: Grade, solution: str) -> None:
    wrong = solution.replace("np.sum(w * np.exp(-x))", "np.sum(w * np.exp(x))")
    assert wrong != solution
    found = statuses(grade_text(wrong))
    assert found.pop("90.1.value") == found.pop("90.1.hidden") == "failed"
    assert set(found.values()) == {"passed"}  # the reference stood in for the earlier function


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("import os\nfor name in os.environ:\n    pass\n", "broken"),
        ("import numpy as np\ndef (:\n", "unreadable"),
        ("import numpy as np\nraise RuntimeError('no')\n", "broken"),
        ("import numpy as np\n", "missing"),
        ("import numpy as np\nnp.sys.exit\n", "broken"),
    ],
)
def test_modules_that_do_not_load(grade_text: Grade, small: Bundle, text: str, reason: str) -> None:
    report = grade_text(text, small)
    assert set(statuses(report).values()) == {"failed"}
    assert reasons(report) == {reason}
    assert (report.score, report.is_sound) == (0.0, True)


def test_a_refused_import_costs_what_uses_it_and_is_said_once(
    grade_text: Grade, solution: str
) -> None:
    text = solution.replace("import numpy as np\n", "import numpy as np\nimport sys\n", 1)
    value = "np.sum(w * np.exp(-x))"
    assert value in text
    report = grade_text(text.replace(value, f"({value}, sys.path)[0]"))
    lost = {each.id: each.reason for each in report.checks if each.status.value != "passed"}
    assert lost == {"90.1.value": "forbidden", "90.1.hidden": "forbidden"}
    (said,) = [each for each in report.warnings if "imports" in each]
    assert "imports sys; functions that use it get no points" in said
    assert [each for each in report.checks if "sys" in each.text] == []


def test_a_missing_module_is_said_and_answers_still_count(bundle: Bundle, workers: Workers) -> None:
    submission = Submission({"answers.toml": b'[answers]\n"90.d1" = "b"\n'}, "there is no toy.py")
    report = grade_one(Case("Ada", submission, bundle, "0"), workers)
    assert reasons(report) == {"submission"}
    assert report.score == 2.0


def test_a_check_that_raises_is_our_error_and_no_zero(
    grade_text: Grade, solution: str, small: Bundle
) -> None:
    @check("90.1.ours", points=4, calls=("weighted_sum",))
    def divides_by_zero(t: Trial) -> None:
        """We divide by zero."""
        t.call("weighted_sum", t.rng.random(2), t.rng.random(2), returns=Number())
        raise ZeroDivisionError

    report = grade_text(solution, replace(small, checks=(*small.checks, divides_by_zero)))
    assert statuses(report)["90.1.ours"] == "error-ours"
    assert report.score is None
    assert report.proven == 6.0  # the others were judged all the same
    assert "ZeroDivisionError" in report.staff[0]
    assert report.to_json()["status"] == "error-ours"


def test_a_check_that_compares_nothing_is_our_error(
    grade_text: Grade, solution: str, bundle: Bundle
) -> None:
    @check("90.1.empty", points=4, calls=("weighted_sum",))
    def asks_nothing(t: Trial) -> None:
        """Nothing is compared."""

    assert grade_text(solution, replace(bundle, checks=(asks_nothing,))).score is None


class NoStart:
    """Workers that do not start."""

    mode = "C"

    note = ""

    def open(self, slot: int) -> Any:
        raise GraderFault(f"no worker {slot}")


def test_workers_that_do_not_start_are_our_error(bundle: Bundle, solution: str) -> None:
    submission = Submission({"toy.py": solution.encode()})
    report = grade_one(Case("Ada", submission, bundle, "0"), NoStart())
    assert set(statuses(report).values()) == {"error-ours"}
    assert report.score is None


def test_no_mode_is_our_error(bundle: Bundle, solution: str) -> None:
    submission = Submission({"toy.py": solution.encode()})
    report = grade_one(Case("Ada", submission, bundle, "0"), None, unavailable="mode C is missing")
    assert set(statuses(report).values()) == {"error-ours"}
    assert report.score is None
    assert "mode C is missing" in report.staff[0]


def test_time_for_a_whole_submission_is_bounded(
    grade_text: Grade, solution: str, bundle: Bundle
) -> None:
    limits = replace(bundle.manifest.limits, seconds=0.9)
    short = replace(bundle, manifest=replace(bundle.manifest, limits=limits))
    sleepy = solution.replace("    falling = ", "    while True: pass\n    falling = ")
    assert sleepy != solution
    report = grade_text(sleepy, short)
    slow = [outcome for outcome in report.checks if outcome.reason == "timeout"]
    assert {"90.2.differences", "90.2.cost"} <= {outcome.id for outcome in slow}
    assert report.is_sound


def test_records_are_sealed_and_give_the_report_back(
    grade_text: Grade, solution: str, small: Bundle
) -> None:
    report = grade_text(solution.replace("np.exp(-x))", "np.exp(x))"), small)
    data = write_record(report, SECRET)
    again = read_record(data, SECRET)
    assert again.to_json() == json.loads(data)["report"]
    assert verdict_digest(again) == verdict_digest(report)
    assert again.score == report.score
    forged = data.replace(b'"points":0.0', b'"points":3.0')
    assert forged != data
    for bad, secret in ((forged, SECRET), (data, b"another secret"), (data[:-9], SECRET)):
        with pytest.raises(SceneError, match="sealed record"):
            read_record(bad, secret)


def test_grading_again_repeats_the_verdict(grade_text: Grade, solution: str, small: Bundle) -> None:
    wrong = solution.replace("np.exp(-x))", "np.exp(x))")
    one, two = grade_text(wrong, small), grade_text(wrong, small)
    assert verdict_digest(one) == verdict_digest(two)
    assert verdict_digest(one) != verdict_digest(grade_text(solution, small))

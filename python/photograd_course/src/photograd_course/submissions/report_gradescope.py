"""`results.json` as Gradescope reads it, written after each check.

Hidden checks show after publication, secret ones never. A file that is there early counts what has
been proven so far; the rest stands at 0 and is overwritten by the next write. Where the grader
itself fails, the best earlier score stays; without one, no score is written at all, since
Gradescope records whatever number it finds. It then reports that the autograder failed.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..assignment.bundle import Bundle
from ..atomic_io import atomic_write
from ..grading.check import Check
from ..grading.outcome import Outcome, Status
from ..printable import markdown
from .answers import Answered
from .disclosure import STAFF_TEXT, for_student
from .report import Report
from .said_once import said_once

VISIBILITY = {"public": "visible", "hidden": "after_published", "secret": "hidden"}


class ResultsFile:
    """Keeps `results.json` up to date while a submission is graded."""

    def __init__(self, path: Path, bundle: Bundle, earlier: float | None = None) -> None:
        """Write it at once, without a score, so that a broken run is neither a gap nor a zero.

        Args:
            path: of `results.json`.
            bundle: ids and points come from it alone.
            earlier: the best earlier score of this student, if any.
        """
        self._path, self._bundle, self._earlier = path, bundle, earlier
        self._done: dict[str, Outcome] = {}
        self._write_partial()

    def on_outcome(self, outcome: Outcome) -> None:
        """Count one more check."""
        self._done[outcome.id] = outcome
        self._write_partial()

    def finish(self, report: Report) -> dict[str, Any]:
        """Write the whole result and return it."""
        results = as_results(report, self._earlier)
        self._write(results)
        return results

    def _write_partial(self) -> None:
        tests = [_waiting(check) for check in self._bundle.checks if check.id not in self._done]
        tests = [_test(for_student(outcome)) for outcome in self._done.values()] + tests
        proven = sum(outcome.points for outcome in self._done.values()) if self._done else None
        text = "Grading is still going on, or was cut off; what follows has been proven so far."
        self._write(_frame(_best(proven, self._earlier), text, tests, 0.0))

    def _write(self, results: Mapping[str, Any]) -> None:
        atomic_write(self._path, (json.dumps(results, indent=1) + "\n").encode())


def as_results(report: Report, earlier: float | None = None) -> dict[str, Any]:
    """The whole `results.json` of a report."""
    once = said_once(report.checks, report.remarks, for_student)
    tests = [_test(shown) for shown in once.checks]
    tests += [_question(question) for question in report.questions]
    lines = [markdown(remark) for remark in (*once.faults, *report.remarks)]
    score: float | None = report.proven
    if not report.is_sound:
        score = None if earlier is None else max(report.proven, earlier)
        lines.insert(0, STAFF_TEXT)
    lines.append(f"Isolation mode {report.mode}, submission {report.submission[:12]}")
    results = _frame(score, "\n\n".join(lines), tests, report.seconds)
    results["extra_data"] = {
        "needs_staff": not report.is_sound,
        "mode": report.mode,
        "submission": report.submission,
        "bundle": report.bundle,
    }
    return results


def best_earlier(metadata: Path) -> float | None:
    """The best score in `submission_metadata.json`; None where there is none."""
    try:
        data = json.loads(metadata.read_text(encoding="utf-8"))
        scores = [float(entry["score"]) for entry in data.get("previous_submissions", [])]
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return max(scores, default=None)


def _best(proven: float | None, earlier: float | None) -> float | None:
    return max((each for each in (proven, earlier) if each is not None), default=None)


def _frame(
    score: float | None, output: str, tests: Sequence[Mapping[str, Any]], seconds: float
) -> dict[str, Any]:
    """The file's top level; without a score the tests have none either, or they would be summed."""
    hidden = () if score is not None else ("score", "max_score")
    shown = [{key: test[key] for key in test if key not in hidden} for test in tests]
    return {
        **({} if score is None else {"score": score}),
        "execution_time": round(seconds),
        "output": output,
        "output_format": "md",
        "test_output_format": "md",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": [{**test, "number": str(k + 1)} for k, test in enumerate(shown)],
    }


def _test(shown: Outcome) -> dict[str, Any]:
    lines = [markdown(shown.text)] if shown.text else []
    if said := shown.details.get("exception"):
        lines.append(markdown(said))
    if shown.hint:
        lines.append(f"Hint: {markdown(shown.hint)}")
    return {
        "name": f"{shown.id} {shown.title}",
        "score": shown.points,
        "max_score": shown.max,
        "status": "passed" if shown.status is Status.PASSED else "failed",
        "output": "\n\n".join(lines),
        "visibility": VISIBILITY[shown.visibility],
    }


def _waiting(check: Check) -> dict[str, Any]:
    return {
        "name": f"{check.id} {check.title}",
        "score": 0.0,
        "max_score": check.points,
        "status": "failed",
        "output": "not graded yet",
        "visibility": VISIBILITY[check.visibility],
    }


def _question(question: Answered) -> dict[str, Any]:
    """Answers are judged for good only once; until grades are out, they show no verdict."""
    ours = question.status == Status.ERROR_OURS.value
    is_open = question.kind == "prediction"
    return {
        "name": f"{question.id} {question.kind}",
        "score": question.points,
        "max_score": question.max,
        "status": "passed" if question.status == "passed" else "failed",
        "output": markdown(STAFF_TEXT if ours else question.text),
        "visibility": "visible" if is_open else "after_published",
    }

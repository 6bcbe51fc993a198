"""A report on the grader's terminal: everything, also about hidden checks."""

from __future__ import annotations

from dataclasses import replace

from rich.console import Console
from rich.text import Text

from ..grading.outcome import Outcome
from ..printable import printable
from ..student.terminal import MARKS, OutcomePrinter
from .report import Report
from .said_once import BELOW, said_once


def print_report(report: Report, console: Console) -> None:
    """Print verdicts, answers, what was left out, and the score.

    Args:
        report: of one submission.
        console: where to; whatever the submission wrote is printed as text, never as markup.
    """
    _line(console, f"{report.student}: {report.assignment} {report.title}", "bold")
    said = f" ({report.isolation})" if report.isolation else ""
    _line(console, f"isolation mode {report.mode}{said}, submission {report.submission[:12]}")
    once = said_once(report.checks, report.remarks)
    for remark in (*once.faults, *report.remarks):
        _line(console, f"note: {remark}", "yellow")
    for name in report.ignored:
        _line(console, f"ignored: {name}")
    for note in report.staff:
        _line(console, f"staff: {note}", "magenta")
    printer = OutcomePrinter(console)
    for outcome in once.checks:
        if outcome.text == BELOW:
            _line(console, f"{MARKS[outcome.status][0]} {outcome.id:<20} {outcome.title}")
        else:
            printer.outcome(safe(outcome))
    for question in report.questions:
        said = f" ({question.text})" if question.text else ""
        points = f"{question.points:g} of {question.max:g}"
        _line(console, f"{question.id} {question.kind}: {question.status}, {points}{said}")
    _line(console, score_text(report), "bold")


def score_text(report: Report) -> str:
    """The points, or why there are none yet."""
    if report.score is None:
        proven = f"{report.proven:g} of {report.max_score:g} points are proven"
        return f"no score, since the grader failed: {proven}, the rest is for staff to look at"
    return f"{report.score:g} of {report.max_score:g} points"


def safe(outcome: Outcome) -> Outcome:
    """The outcome without anything that could steer a terminal."""
    details = dict(outcome.details)
    if "exception" in details:
        details["exception"] = printable(details["exception"])
    text, hint = printable(outcome.text), printable(outcome.hint)
    return replace(outcome, text=text, hint=hint, details=details)


def _line(console: Console, text: str, style: str = "") -> None:
    console.print(Text(printable(text), style=style), soft_wrap=True)

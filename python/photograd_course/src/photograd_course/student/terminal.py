"""Outcomes as lines in a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from ..assignment.bundle import Bundle
from ..grading.outcome import Outcome, Status

# Sign and colour: the sign alone says it, for those who do not see the colour.
MARKS = {
    Status.PASSED: ("✓", "green"),
    Status.FAILED: ("✗", "red"),
    Status.BLOCKED: ("·", "yellow"),
    Status.ERROR_OURS: ("!", "magenta"),
}


def print_outcome(outcome: Outcome, console: Console) -> None:
    """One check: its verdict, and under it what to do."""
    mark, colour = MARKS[outcome.status]
    head = Text(f"{mark} {outcome.id:<20} ", style=colour)
    head.append(outcome.title, style="default")
    console.print(head, soft_wrap=True)
    if outcome.status is Status.PASSED:
        return
    lines = [outcome.text]
    if said := outcome.details.get("exception"):
        lines.append(str(said))
    if outcome.status is Status.ERROR_OURS:
        lines.append("this is a fault of the checks, not yours; please report it")
    if outcome.hint:
        lines.append(f"hint: {outcome.hint}")
    for line in lines:
        for part in str(line).splitlines()[:6]:
            console.print(Text(f"    {part}"), soft_wrap=True)


def print_summary(outcomes: Sequence[Outcome], console: Console) -> None:
    """How many checks passed, and their points."""
    passed = [outcome for outcome in outcomes if outcome.status is Status.PASSED]
    points, top = sum(o.points for o in passed), sum(o.max for o in outcomes)
    said = f"{len(passed)} of {len(outcomes)} public checks pass: {points:g} of {top:g} points."
    console.print(said, soft_wrap=True)


def print_rest(bundle: Bundle, console: Console) -> None:
    """What there is to earn besides public checks."""
    public = sum(check.points for check in bundle.checks)
    said = []
    if (hidden := bundle.manifest.points.get("code", public) - public) > 0:
        said.append(f"Checks that run only after you have handed in hold {hidden:g} points.")
    if questions := bundle.manifest.points.get("questions", 0):
        said.append(f"Questions hold {questions:g}.")
    if said:
        console.print(" ".join(said), soft_wrap=True)

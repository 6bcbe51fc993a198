"""Outcomes as lines in a terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.text import Text

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


def print_summary(
    outcomes: Sequence[Outcome], console: Console, whole: Mapping[str, float]
) -> None:
    """How many checks passed, their points, and what else there is to earn.

    Args:
        outcomes: of public checks.
        console: where to write.
        whole: points of "code" and "questions" in the whole assignment.
    """
    passed = [outcome for outcome in outcomes if outcome.status is Status.PASSED]
    points, top = sum(o.points for o in passed), sum(o.max for o in outcomes)
    said = f"{len(passed)} of {len(outcomes)} checks pass: {points:g} of {top:g} points."
    if (hidden := whole.get("code", top) - top) > 0:
        said += f" Other checks of your code hold {hidden:g} more."
    if questions := whole.get("questions", 0):
        said += f" Questions hold {questions:g}."
    console.print(said, soft_wrap=True)

"""Outcomes as lines in a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from ..assignment.bundle import Bundle
from ..assignment.manifest import Manifest
from ..grading.outcome import Outcome, Status
from ..printable import printable
from .source_code import SAID_OF_STUB

# Sign and color: the sign alone says it, for readers who do not see the color.
MARKS = {
    Status.PASSED: ("✓", "green"),
    Status.FAILED: ("✗", "red"),
    Status.BLOCKED: ("·", "yellow"),
    Status.ERROR_OURS: ("!", "magenta"),
}
MOST_LINES, LONGEST_LINE = 20, 200  # of what is printed


def print_outcome(outcome: Outcome, console: Console, manifest: Manifest | None = None) -> None:
    """One check: its verdict, and under it what to do; `manifest`: on a student's machine."""
    mark, color = MARKS[outcome.status]
    head = Text(f"{mark} {outcome.id:<20} ", style=color)
    head.append(outcome.title, style="default")
    console.print(head, soft_wrap=True)
    if outcome.status is Status.PASSED:
        return
    lines = [outcome.text]
    if said := outcome.details.get("exception"):
        lines.append(str(said) if manifest is None else said_of(str(said), manifest))
    if outcome.status is Status.ERROR_OURS:
        lines.append("this is a fault of the checks, not yours; please report it")
    if outcome.hint:
        lines.append(f"hint: {outcome.hint}")
    for line in lines:
        for part in str(line).splitlines()[:6]:
            console.print(Text(f"    {part}"), soft_wrap=True)


def print_printed(text: str, console: Console) -> None:
    """What the submission has printed, its first lines: each behind a bar, as no verdict stands."""
    lines = text.splitlines()
    for line in lines[:MOST_LINES]:
        console.print(Text(f"    | {printable(line, LONGEST_LINE)}", style="dim"), soft_wrap=True)
    if len(lines) > MOST_LINES:
        more = f"    | ... and {len(lines) - MOST_LINES} more lines that it printed"
        console.print(Text(more, style="dim"), soft_wrap=True)


def said_of(said: str, manifest: Manifest) -> str:
    """The text of an exception; of a stub of an earlier assignment, what to do about it."""
    stub = SAID_OF_STUB.fullmatch(said)
    if stub is None or stub[1] == manifest.id:
        return said  # the handout that it names is this assignment's
    files = " or ".join(f"{name}.py" for name in manifest.brought) or "the file that has it"
    return (
        f"{stub[2]} is from assignment {stub[1]} and not written in this folder: when it is in "
        f"that of {stub[1]}, 'photograd course start {manifest.id} --update' copies your {files}"
    )


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

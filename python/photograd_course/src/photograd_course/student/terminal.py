"""Outcomes as lines in a terminal."""

from __future__ import annotations

import os
import textwrap
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
MOST_PARTS = 6  # lines of one sentence
SHORT = 60  # characters; no more are said again and again
NARROWEST = 40  # columns


class OutcomePrinter:
    """Outcomes of one run, each as lines; what an earlier check has said is not said again.

    Args:
        console: where to.
        manifest: of the assignment, on a student's machine.
    """

    def __init__(self, console: Console, manifest: Manifest | None = None) -> None:
        self._console = console
        self._manifest = manifest
        self._said: dict[tuple[str, ...], str] = {}  # lines to the first check that had them

    def outcome(self, outcome: Outcome) -> None:
        """One check: its verdict, and under it what to do."""
        mark, color = MARKS[outcome.status]
        head = f"{mark} {outcome.id:<20} "
        for number, line in enumerate(wrapped(self._console, outcome.title, head, " " * len(head))):
            text = Text(line)
            if number == 0:
                text.stylize(color, 0, len(head))
            self._console.print(text, soft_wrap=True)
        if outcome.status is not Status.PASSED:
            self._lines(outcome.id, explanation(outcome, self._manifest))

    def printed(self, id: str, text: str) -> None:
        """What the submission has printed, its first lines, each behind a bar: no verdict."""
        lines = [printable(line, LONGEST_LINE) for line in text.splitlines()]
        if len(lines) > MOST_LINES:
            lines[MOST_LINES:] = [f"... and {len(lines) - MOST_LINES} more lines that it printed"]
        self._lines(id, lines, "    | ", "dim")

    def _lines(self, id: str, lines: Sequence[str], head: str = "    ", style: str = "") -> None:
        first = self._said.setdefault((head, *lines), id)
        if first != id and sum(map(len, lines)) > SHORT:
            lines = [f"the same as for {first}"]
        for line in lines:
            for part in wrapped(self._console, line, head, head):
                self._console.print(Text(part, style=style), soft_wrap=True)


def explanation(outcome: Outcome, manifest: Manifest | None = None) -> list[str]:
    """What is said of a check that is not passed, line by line."""
    lines = [outcome.text]
    if said := outcome.details.get("exception"):
        lines.append(str(said) if manifest is None else said_of(str(said), manifest))
    if outcome.status is Status.ERROR_OURS:
        lines.append("this is a fault of the checks, not yours; please report it")
    if outcome.hint:
        lines.append(f"hint: {outcome.hint}")
    return [part for line in lines for part in str(line).splitlines()[:MOST_PARTS]]


def wrapped(console: Console, line: str, first: str, then: str) -> list[str]:
    """A line as it fits the terminal, indented; elsewhere it stays one, to be searched for."""
    if not console.is_terminal and "COLUMNS" not in os.environ:
        return [first + line]
    lines = textwrap.wrap(
        line,
        max(console.width, NARROWEST),
        initial_indent=first,
        subsequent_indent=then,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return lines or [first + line]


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

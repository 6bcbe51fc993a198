"""Outcomes on a terminal: what holds, what does not, by how much, and what to look at."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from ..grading.outcome import Outcome, Status
from .printable import printable

# A word and a mark stand beside each colour, so that none is needed to read a report.
MARKS = {
    Status.PASSED: ("\N{CHECK MARK}", "passed", "bright_blue"),
    Status.FAILED: ("\N{MULTIPLICATION X}", "failed", "dark_orange"),
    Status.BLOCKED: ("\N{WHITE CIRCLE}", "blocked", "bright_black"),
    Status.ERROR_OURS: ("!", "error of the grader", "magenta"),
}


def render_outcomes(outcomes: Sequence[Outcome], console: Console) -> None:
    """Print one block a check, under a heading for each task.

    Args:
        outcomes: in the order of the report; for students as `disclosure.for_student` leaves them.
        console: where to; text of hand-ins is printed as text, never as markup.
    """
    task = ""
    for outcome in outcomes:
        if outcome.task != task:
            task = outcome.task
            console.print(Text(f"Task {printable(task)}", style="bold"))
        for line in outcome_lines(outcome):
            console.print(line, soft_wrap=True)


def outcome_lines(outcome: Outcome) -> list[Text]:
    """The lines about one check: verdict, sentence, place, hint."""
    mark, word, style = MARKS[outcome.status]
    head = Text("  ")
    head.append(f"{mark} {word}", style=style)
    head.append(f"  {outcome.id}", style="bold")
    head.append(f"  {outcome.points:g} of {outcome.max:g}  {printable(outcome.title)}")
    lines = [head]
    lines += [_indented(sentence) for sentence in facts(outcome)]
    if outcome.hint:
        lines.append(_indented(f"hint: {outcome.hint}", style="italic"))
    return lines


def facts(outcome: Outcome) -> list[str]:
    """What is known about a check that did not plainly pass, one sentence each."""
    said = [outcome.text] if outcome.text else []
    exception, line = outcome.details.get("exception"), outcome.details.get("line")
    if exception:
        said.append(str(exception))
    if isinstance(line, (list, tuple)) and len(line) == 2:
        said.append(f"{line[0]}, line {line[1]}")
    return [printable(sentence) for sentence in said]


def render_score(score: float | None, max_score: float, console: Console) -> None:
    """The last line: points, or that staff have to look."""
    if score is None:
        console.print(Text("no score: the grader failed, staff have to look", style="magenta"))
        return
    console.print(Text(f"{score:g} of {max_score:g} points", style="bold"))


def _indented(sentence: str, style: str = "") -> Text:
    return Text(f"      {printable(sentence)}", style=style)

"""What `photograd course grade` says about a batch; its tables hold all of it."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..cli.output import note
from ..printable import printable
from .exports import Ignored
from .gradebook import Filled, Gradebook
from .grades_csv import Change, counted
from .report import Report
from .run_folder import RunFolder

MOST_LINES = 20  # of one kind on the terminal


def say_ignored(ignored: Sequence[Ignored]) -> None:
    """What is no submission, on stderr; what operating systems add stands in the table alone.

    Args:
        ignored: entries that are none, those of operating systems among them.
    """
    named = [each for each in ignored if not each.is_noise]
    for each in named[:MOST_LINES]:
        note(f"warning: {printable(each.name)} is not graded: {each.reason}", style="yellow")
    if len(named) > MOST_LINES:
        note(f"warning: {len(named) - MOST_LINES} more entries are not graded: see ignored.csv")


def say_gradebook(
    book: Gradebook, filled: Filled, max_score: float, folder: RunFolder, console: Console
) -> None:
    """Where the filled gradebook is, and whose score stands nowhere in it.

    Args:
        book: the gradebook, and its column.
        filled: what became of it.
        max_score: what the assignment is worth.
        folder: where it was written.
        console: where to.
    """
    column = printable(book.header[book.column])
    where = folder.path / "gradebook.csv"
    console.print(f'{filled.count} grades in column "{column}": {where}', soft_wrap=True)
    if book.max_score not in (None, max_score):
        note(
            f"warning: the gradebook counts {book.max_score:g} points for this column, the "
            f"assignment {max_score:g}: points were written as they are",
            style="yellow",
        )
    for student, why in filled.unmatched[:MOST_LINES]:
        note(f"warning: not in the gradebook: {printable(student)}: {printable(why)}")
    if len(filled.unmatched) > MOST_LINES:
        note(f"warning: {len(filled.unmatched) - MOST_LINES} more: see unmatched.csv")


def print_summary(
    reports: Sequence[Report],
    changed: Sequence[Change] | None,
    folder: RunFolder,
    console: Console,
    said: str,
) -> None:
    """How a batch went.

    Args:
        reports: of all submissions.
        changed: whose grade differs from the run before, if there was one.
        folder: where the tables are.
        console: where to.
        said: what has kept all of them from being graded, and was said before; "" for nothing.
    """
    earlier = folder.earlier()
    scores = [counted(report, earlier.get(report.student)) for report in reports]
    known = [score for score, _ in scores if score is not None]
    console.print(f"{len(reports)} submissions: {folder.path / 'grades.csv'}", soft_wrap=True)
    if known:
        mean = sum(known) / len(known)
        top = reports[0].max_score
        console.print(f"mean {mean:.1f} of {top:g}, best {max(known):g}, least {min(known):g}")
    _print_staff(reports, console, said)
    if changed is not None:
        _print_changes(changed, folder, console)


def _print_staff(reports: Sequence[Report], console: Console, said: str) -> None:
    """Our own failures, each once, however many submissions it hit; `said`: known before."""
    hit: dict[str, list[str]] = {}
    for report in reports:
        for each in report.staff:
            if not said or said not in each:
                hit.setdefault(each, []).append(printable(report.student))
    for each, who in list(hit.items())[:MOST_LINES]:
        names = ", ".join(who[:3]) + (f" and {len(who) - 3} more" if len(who) > 3 else "")
        console.print(Text(f"staff: {names}: {printable(each)}", style="magenta"), soft_wrap=True)
    if len(hit) > MOST_LINES:
        console.print(f"staff: {len(hit) - MOST_LINES} more notes: see grades.csv")


def _print_changes(changed: Sequence[Change], folder: RunFolder, console: Console) -> None:
    """Whose grade differs from the run before, a line each; the checks stand in changes.csv."""
    said = f"{len(changed)} grades differ from the run before"
    console.print(f"{said}: {folder.path / 'changes.csv'}" if changed else said, soft_wrap=True)
    if not changed:
        return
    table = Table()
    table.add_column("student", overflow="fold")
    for column in ("before", "after", "by"):
        table.add_column(column, no_wrap=True)
    for change in changed[:MOST_LINES]:
        numbers = ["none" if s is None else f"{s:g}" for s in (change.before, change.after)]
        cells = [change.student, *numbers, _by(change)]
        table.add_row(*(Text(printable(cell)) for cell in cells))
    console.print(table)
    if len(changed) > MOST_LINES:
        console.print(f"and {len(changed) - MOST_LINES} more")


def _by(change: Change) -> str:
    if len(change.checks) == 1:
        return change.checks[0]
    return f"{len(change.checks)} checks and questions"

"""What happens between `photograd course check` and its last line."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from pathlib import Path

from rich.console import Console

from ..assignment.bundle import Bundle
from ..assignment.manifest import Manifest
from ..build.kits import list_manifests
from ..cli.output import emit
from ..errors import IoError, message
from ..grading.check import Check
from ..grading.outcome import Outcome, Status
from ..printable import printable
from .asking import lock_predictions
from .brought_checks import Looked, look_at_brought, uses_of, with_needs
from .brought_report import print_brought
from .checking import check_here, select
from .comparing import differences, said_of_difference
from .folder import WorkFolder, find_folder
from .pictures import draw_failure, remove_picture
from .record import Record
from .terminal import OutcomePrinter, explanation, print_rest, print_summary


def run_check_command(
    bundle: Bundle, given: Path | None, task: str | None, *, pictures: bool, as_json: bool
) -> bool:
    """Lock predictions, look at what was brought along, run checks, report; True if all passed.

    Args:
        bundle: the public one.
        given: folder of the student's code, or None for here.
        task: only this task.
        pictures: draw wrong arrays.
        as_json: one JSON line at the end.
    """
    console = Console(stderr=as_json, highlight=False)
    folder = find_folder(bundle.manifest, given)
    checks = select(bundle.checks, task)
    files = folder.files()
    require_brought(bundle.manifest, files)
    lock_predictions(bundle, folder, console)
    looked = _look_at_brought(bundle, folder, files, None if task is None else checks, console)
    if looked.culprits:
        checks = with_needs(checks, uses_of(bundle, files), looked)

    printer = OutcomePrinter(console, bundle.manifest)

    def show(outcome: Outcome, printed: str) -> None:
        printer.outcome(outcome)
        if outcome.status is not Status.PASSED or task is not None:
            printer.printed(outcome.id, printed)
        _draw(outcome, folder.path, console, pictures=pictures)

    def refuse(said: str) -> None:
        console.print(f"note: {printable(said)}", soft_wrap=True, markup=False, style="yellow")

    outcomes = check_here(
        bundle, files, checks, on_outcome=show, wrong=looked.wrong, on_refused=refuse
    )
    print_summary(outcomes, console)
    if task is None:
        print_rest(bundle, console)
    all_own = all(outcome.status is Status.PASSED for outcome in outcomes)
    passed = all_own and not looked.culprits
    if passed and task is None:
        next_command = f"photograd course submit {bundle.manifest.id}"
        first = "Answer the questions, then: " if bundle.questions else "Next: "
        console.print(f"All green. {first}{next_command}", soft_wrap=True)
    elif all_own and looked.culprits:
        names = ", ".join(each.name for each in looked.culprits)
        console.print(
            f"All that is looked at here passes, but {names} is wrong: other checks may show it.",
            soft_wrap=True,
        )
    if not passed and (earlier := earlier_functions(checks)):
        console.print(
            f"Only this task was looked at; it uses {', '.join(earlier)}. If it puzzles you, run "
            f"photograd course check {bundle.manifest.id}: begin with what fails first.",
            soft_wrap=True,
        )
    if as_json:
        emit(as_result(bundle, outcomes, looked), as_json=True)
    return passed


def _look_at_brought(
    bundle: Bundle,
    folder: WorkFolder,
    files: Mapping[str, bytes],
    checks: Sequence[Check] | None,
    console: Console,
) -> Looked:
    """Say in what earlier files differ from their origins, and run their own checks."""
    number, manifests = bundle.manifest.id, list_manifests()
    found = differences(folder, manifests)
    for each in found:
        console.print(said_of_difference(each, number), soft_wrap=True, markup=False)
    looked = look_at_brought(bundle, files, checks, manifests, Record(folder.path))
    print_brought(looked, bundle.manifest, found, console)
    return looked


def _draw(outcome: Outcome, folder: Path, console: Console, *, pictures: bool) -> None:
    """The picture of a failed check instead of that of an earlier run; no verdict rests on it."""
    try:
        remove_picture(outcome, folder)
        path = draw_failure(outcome, folder) if pictures else None
    except OSError as error:
        console.print(f"    no picture: {error}", soft_wrap=True, markup=False)
        return
    if path is not None:
        console.print(f"    picture: {path.name}", soft_wrap=True)


def require_brought(manifest: Manifest, files: Container[str]) -> None:
    """Every module of an earlier assignment must be there: without it nothing can be imported.

    Args:
        manifest: of the assignment.
        files: names of those that are there.

    Raises:
        IoError: one is missing.
    """
    for name in manifest.brought:
        if f"{name}.py" not in files:
            number = " or ".join(manifest.prerequisites)
            expected = f"your file of assignment {number} beside {manifest.module}.py"
            raise IoError(message("check", f"{name}.py", expected, "none", "put it there"))


def earlier_functions(checks: Sequence[Check]) -> list[str]:
    """What these checks need of earlier tasks that none of them looks at.

    Args:
        checks: those of one task.
    """
    called = {function for check in checks for function in check.calls}
    needed = dict.fromkeys(function for check in checks for function in check.needs)
    return [each for each in needed if each not in called]


def as_result(bundle: Bundle, outcomes: list[Outcome], looked: Looked) -> dict[str, object]:
    """The JSON form, equal to that of `grade` in what both have.

    Args:
        bundle: of the assignment.
        outcomes: of its checks.
        looked: what is known of earlier modules.
    """
    return {
        "assignment": bundle.manifest.id,
        "mode": "E",
        "indicative": True,
        "score": sum(outcome.points for outcome in outcomes),
        "max_score": sum(outcome.max for outcome in outcomes),
        "brought": [
            {"function": each.name, "check": each.outcome.id, "text": each.outcome.text}
            for each in looked.culprits
        ],
        "checks": [
            {
                "id": o.id,
                "status": o.status.value,
                "points": o.points,
                "max": o.max,
                "text": o.text,
                "hint": o.hint,
                "lines": [] if o.status is Status.PASSED else explanation(o, bundle.manifest),
            }
            for o in outcomes
        ],
    }

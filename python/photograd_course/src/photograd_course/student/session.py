"""What happens between `photograd course check` and its last line."""

from __future__ import annotations

import sys
from collections.abc import Collection, Container, Mapping, MutableMapping, Sequence
from pathlib import Path
from typing import Any

import tomlkit
import typer
from rich.console import Console
from tomlkit.exceptions import TOMLKitError

from ..assignment.bundle import Bundle
from ..assignment.manifest import Manifest
from ..assignment.questions import LETTERS, Question
from ..atomic_io import atomic_write
from ..cli.output import emit
from ..errors import IoError, SceneError, message
from ..grading.check import Check
from ..grading.outcome import Outcome, Status
from ..printable import printable
from .checking import check_here, select
from .folder import LOCK_NAME, WorkFolder, find_folder
from .pictures import draw_failure, remove_picture
from .predictions import prediction_letters, write_lock
from .terminal import print_outcome, print_printed, print_rest, print_summary


def run_check_command(
    bundle: Bundle, given: Path | None, task: str | None, *, pictures: bool, as_json: bool
) -> bool:
    """Lock predictions, run checks, report; True if all passed.

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

    def show(outcome: Outcome, printed: str) -> None:
        print_outcome(outcome, console, bundle.manifest)
        if outcome.status is not Status.PASSED or task is not None:
            print_printed(printed, console)
        remove_picture(outcome, folder.path)
        if pictures and (path := draw_failure(outcome, folder.path)) is not None:
            console.print(f"    picture: {path.name}", soft_wrap=True)

    def refuse(said: str) -> None:
        console.print(f"note: {printable(said)}", soft_wrap=True, markup=False, style="yellow")

    outcomes = check_here(bundle, files, checks, on_outcome=show, on_refused=refuse)
    print_summary(outcomes, console)
    if task is None:
        print_rest(bundle, console)
    passed = all(outcome.status is Status.PASSED for outcome in outcomes)
    if passed and task is None:
        next_command = f"photograd course submit {bundle.manifest.id}"
        first = "Answer the questions, then: " if bundle.questions else "Next: "
        console.print(f"All green. {first}{next_command}", soft_wrap=True)
    own = {function for each in bundle.manifest.tasks for function in each.functions}
    if not passed and (earlier := earlier_functions(checks, own)):
        console.print(
            f"Only this task was looked at; it uses {', '.join(earlier)}. If it puzzles you, run "
            f"photograd course check {bundle.manifest.id}: begin with what fails first.",
            soft_wrap=True,
        )
    if as_json:
        emit(as_result(bundle, outcomes), as_json=True)
    return passed


def require_brought(manifest: Manifest, files: Container[str]) -> None:
    """Every module of an earlier assignment must be there: without it nothing can be imported.

    Raises:
        IoError: one is missing.
    """
    for name in manifest.brought:
        if f"{name}.py" not in files:
            number = " or ".join(manifest.prerequisites)
            expected = f"your file of assignment {number} beside {manifest.module}.py"
            raise IoError(message("check", f"{name}.py", expected, "none", "put it there"))


def earlier_functions(checks: Sequence[Check], own: Collection[str] | None = None) -> list[str]:
    """What these checks need of earlier tasks that none of them looks at.

    Args:
        checks: those of one task.
        own: the functions of this assignment; what a check calls besides was brought along from
            an earlier one. By default nothing was.
    """
    called = dict.fromkeys(function for check in checks for function in check.calls)
    brought = [function for function in called if own is not None and function not in own]
    needed = dict.fromkeys(function for check in checks for function in check.needs)
    return [each for each in needed if each not in called] + brought


def as_result(bundle: Bundle, outcomes: list[Outcome]) -> dict[str, object]:
    """The JSON form, equal to that of `grade` in what both have."""
    return {
        "assignment": bundle.manifest.id,
        "mode": "E",
        "indicative": True,
        "score": sum(outcome.points for outcome in outcomes),
        "max_score": sum(outcome.max for outcome in outcomes),
        "checks": [
            {"id": o.id, "status": o.status.value, "points": o.points, "max": o.max, "text": o.text}
            for o in outcomes
        ],
    }


def lock_predictions(bundle: Bundle, folder: WorkFolder, console: Console) -> None:
    """Lock the predictions in answers.toml, asking for those that lack where someone can answer.

    Raises:
        SceneError: predictions are missing, and nobody is there to ask.
    """
    if (folder.path / LOCK_NAME).exists():
        return
    _, answers = folder.answers()
    made, lacking = prediction_letters(bundle.questions, answers)
    if not made and not lacking:
        return
    number = bundle.manifest.id
    if lacking and not sys.stdin.isatty():
        names = ", ".join(question.id for question in lacking)
        remedy = (
            f"write a letter for each into answers.toml, or run 'photograd course predict {number}'"
        )
        expected = "predictions before the first check"
        raise SceneError(message("check", "answers.toml", expected, f"none for {names}", remedy))
    if lacking:
        made = {**made, **ask(lacking, folder, console)}
    write_lock(folder.path, number, made)
    console.print(f"Predictions locked in {LOCK_NAME}.", soft_wrap=True)


def ask(questions: list[Question], folder: WorkFolder, console: Console) -> dict[str, str]:
    """Ask for predictions on the terminal and write them into answers.toml."""
    console.print(
        "Before the first check: what do you expect? Each earns its points right or wrong.",
        soft_wrap=True,
    )
    made = {}
    for question in questions:
        console.print(f"\n{question.id}  {question.text}", soft_wrap=True, markup=False)
        letters = LETTERS[: len(question.options)]
        for letter, option in zip(letters, question.options, strict=True):
            console.print(f"  {letter}) {option}", soft_wrap=True, markup=False)
        answer = ""
        while len(answer) != 1 or answer not in letters:
            answer = _prompt(f"Your prediction ({'/'.join(letters)})", console)
        made[question.id] = answer
        write_answers(folder.path / "answers.toml", {question.id: answer})  # kept if interrupted
    return made


def _prompt(text: str, console: Console) -> str:
    """One answer; where the input ends instead, say that nothing is lost."""
    try:
        return str(typer.prompt(text)).strip().lower()
    except typer.Abort:
        said = "\nAnswers so far are saved in answers.toml; run this again for those that are open."
        console.print(said, soft_wrap=True)
        raise


def write_answers(path: Path, made: Mapping[str, str]) -> None:
    """Fill in answers of a TOML file, leaving everything else as it is, comments included.

    Args:
        path: of the file; made where there is none.
        made: answers by id; each replaces the one that is there, however its key is written.

    Raises:
        IoError: the file is no TOML, or its `answers` are no table.
    """
    try:
        document = tomlkit.parse(path.read_bytes().decode("utf-8") if path.exists() else "")
        answers = document.setdefault("answers", tomlkit.table())
        if not isinstance(answers, MutableMapping):
            raise _unwritable(path, "a table [answers]", type(answers).__name__)
        for name, answer in made.items():
            _put(answers, name, answer)
    except (TOMLKitError, ValueError) as error:
        raise _unwritable(path, "TOML", str(error)) from error
    atomic_write(path, tomlkit.dumps(document).encode())


def _put(answers: MutableMapping[str, Any], name: str, answer: str) -> None:
    task, _, rest = name.partition(".")
    inner = answers.get(task)  # of keys without quotes, such as 01.p1
    dotted = inner if isinstance(inner, MutableMapping) and rest in inner else None
    if dotted is not None:
        dotted[rest] = answer
    if name in answers or dotted is None:
        answers[name] = answer


def _unwritable(path: Path, expected: str, got: str) -> IoError:
    return IoError(message("predict", path.name, expected, got, "mend the file by hand"))

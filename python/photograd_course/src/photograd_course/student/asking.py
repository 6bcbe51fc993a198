"""Ask for predictions before the first check, and write them where they are kept."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, MutableMapping, Sequence
from pathlib import Path
from typing import Any

import tomlkit
import typer
from rich.console import Console
from tomlkit.exceptions import TOMLKitError

from ..assignment.bundle import Bundle
from ..assignment.questions import LETTERS, Question
from ..atomic_io import atomic_write
from ..errors import IoError, SceneError, message
from .folder import LOCK_NAME, WorkFolder
from .kept import keep_copy
from .predictions import prediction_letters, write_lock


def lock_predictions(bundle: Bundle, folder: WorkFolder, console: Console) -> None:
    """Lock the predictions in answers.toml, asking for those that lack where someone can answer.

    Args:
        bundle: of the assignment.
        folder: the student's.
        console: to ask and to print.

    Raises:
        SceneError: predictions are missing, and nobody is there to ask.
    """
    if (folder.path / LOCK_NAME).exists():
        return
    _, answers = folder.answers()
    made, lacking = prediction_letters(bundle.questions, answers)
    if not made and not lacking:
        return
    if lacking and (_in_notebook() or not sys.stdin.isatty()):
        raise nobody_to_ask("check", lacking, bundle.manifest.id)
    if lacking:
        made = {**made, **ask(lacking, folder, console)}
    write_lock(folder.path, bundle.manifest.id, made)
    console.print(f"Predictions locked in {LOCK_NAME}.", soft_wrap=True)


def ask_where_one_can(
    lacking: list[Question], folder: WorkFolder, console: Console
) -> dict[str, str]:
    """`ask`; where nobody can answer, show all that is open and say how to answer it otherwise.

    Args:
        lacking: the questions.
        folder: the student's.
        console: to ask and to print.

    Raises:
        SceneError: the input has ended, or this runs in a notebook.
    """
    still = lacking
    if not _in_notebook():
        try:
            return ask(lacking, folder, console)
        except typer.Abort:
            if sys.stdin.isatty():  # somebody has interrupted it
                raise
        still = prediction_letters(lacking, folder.answers()[1])[1]
    for question in still:
        print_question(question, console)
    raise nobody_to_ask("predict", still, folder.manifest.id)


def _in_notebook() -> bool:
    """Whether a notebook has started this: it gives a terminal to which nothing can be typed."""
    return any(name in os.environ for name in ("JPY_PARENT_PID", "JPY_SESSION_NAME"))


def nobody_to_ask(command: str, lacking: Sequence[Question], number: str) -> SceneError:
    """The error for predictions that are missing where nobody can be asked.

    Args:
        command: that needs them.
        lacking: the questions.
        number: of the assignment.
    """
    names = ", ".join(question.id for question in lacking)
    remedy = (
        "write a letter for each into answers.toml, save it, and run this again; or run "
        f"'photograd course predict {number}' in a terminal"
    )
    expected = "predictions before the first check"
    return SceneError(message(command, "answers.toml", expected, f"none for {names}", remedy))


def ask(questions: list[Question], folder: WorkFolder, console: Console) -> dict[str, str]:
    """Ask for predictions on the terminal and write them into answers.toml.

    Args:
        questions: those without an answer.
        folder: the student's.
        console: to ask and to print.
    """
    console.print(
        "Before the first check: what do you expect? Each earns its points right or wrong.",
        soft_wrap=True,
    )
    answers = folder.path / "answers.toml"
    written = [question.id for question in questions if folder.answers()[1].get(question.id)]
    if written:  # but no letter: what stands there is about to be replaced
        kept = keep_copy(answers)
        said = f"What you wrote for {', '.join(written)} is no letter; it is kept in {kept.name}."
        console.print(said, soft_wrap=True)
    made = {}
    for question in questions:
        print_question(question, console)
        letters = LETTERS[: len(question.options)]
        answer = ""
        while len(answer) != 1 or answer not in letters:
            answer = _prompt(f"Your prediction ({'/'.join(letters)})", console)
        made[question.id] = answer
        write_answers(answers, {question.id: answer})  # kept if interrupted
    return made


def print_question(question: Question, console: Console) -> None:
    """A prediction and its options.

    Args:
        question: what is asked.
        console: to print to.
    """
    console.print(f"\n{question.id}  {question.text}", soft_wrap=True, markup=False)
    for letter, option in zip(LETTERS, question.options, strict=False):
        console.print(f"  {letter}) {option}", soft_wrap=True, markup=False)


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

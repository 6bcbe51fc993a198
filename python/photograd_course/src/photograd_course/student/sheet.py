"""The questions of an assignment as one student gets them, and what is wrong with the answers."""

from __future__ import annotations

import json
import math

from ..assignment.bundle import Bundle
from ..assignment.drawing import draw
from ..assignment.questions import LETTERS, Question
from ..atomic_io import atomic_write
from ..errors import SceneError
from .folder import LOCK_NAME, WorkFolder
from .predictions import locked_answers
from .record import read_table

SHOWN_NAME = "questions.shown.json"  # which draw was last looked at
REDRAWN = (
    "Some numbers are drawn from your name and your code, and change when the code does (not with "
    "its comments): finish the code first."
)


def question_sheet(bundle: Bundle, work: WorkFolder) -> list[str]:
    """Lines: each question with its numbers, options, points and the answer so far.

    Without a name, those whose numbers it draws are not shown: others would come in their place.
    """
    student, answers = work.answers()
    source = work.source()
    named = [question.id for question in bundle.questions if question.draw and not student]
    lines = [] if student else ["Write your name into answers.toml first: it draws the numbers."]
    if named:
        lines.append(f"Not shown until then: {', '.join(named)}.")
    if any(question.draw for question in bundle.questions):
        lines.append(REDRAWN)
    locked = _locked(bundle, work)
    for question in bundle.questions:
        if question.id in named:
            continue
        drawn = draw(question, student, source)
        worth = f"{question.points:g} point{'s' if question.points != 1 else ''}"
        lines += ["", f"{question.id}  ({question.kind}, {worth})", drawn.text]
        lines += [
            f"  {letter}) {option}"
            for letter, option in zip(LETTERS, question.options, strict=False)
        ]
        if question.id in locked:
            lines.append(f"  locked: {locked[question.id]}")
            continue
        answer = str(answers.get(question.id, "")).strip()
        wrong = fault(question, answer)
        lines.append(f"  your answer: {answer or '(open)'}" + (f"  <- {wrong}" if wrong else ""))
    return lines


def remember_shown(bundle: Bundle, work: WorkFolder) -> None:
    """Note which numbers the student has now seen: none without a name."""
    if not work.answers()[0]:
        return
    path = work.path / SHOWN_NAME
    atomic_write(path, (json.dumps(_draws(bundle, work), indent=1) + "\n").encode())


def notes_before_submission(bundle: Bundle, work: WorkFolder) -> list[str]:
    """What the student should know before submitting; one sentence each."""
    student, answers = work.answers()
    notes = []
    if bundle.questions and not student:
        notes.append("answers.toml: student is empty; write your name")
    locked = _locked(bundle, work)
    if (work.path / LOCK_NAME).exists() and not locked:
        remedy = "put back the file that 'check' wrote, or ask your instructor"
        notes.append(f"{LOCK_NAME}: damaged or of another assignment, so earns nothing; {remedy}")
    opened = []
    for question in bundle.questions:
        answer = str(answers.get(question.id, "")).strip()
        if question.id in locked:
            if answer and answer.lower() != locked[question.id]:
                kept = locked[question.id]
                notes.append(f"{question.id}: locked as {kept}; put {kept} back, or it earns none")
        elif not answer:
            opened.append(question.id)
        elif wrong := fault(question, answer):
            notes.append(f"{question.id}: {wrong}")
    if opened:
        notes.append(f"still without an answer: {', '.join(opened)}")
    if changed := _changed(bundle, work):
        command = f"photograd course questions {bundle.manifest.id}"
        notes.append(f"the numbers of {', '.join(changed)} have changed since; look with {command}")
    return notes


def fault(question: Question, answer: str) -> str:
    """What is wrong with the form of an answer; "" for a good one, and for none."""
    if not answer:
        return ""
    if question.options:
        letters = LETTERS[: len(question.options)]
        return "" if answer.lower() in list(letters) else f"write one letter, a to {letters[-1]}"
    try:
        good = math.isfinite(float(answer))
    except ValueError:
        good = False
    return "" if good else "write a number such as 0.1250: no fraction, no unit"


def _locked(bundle: Bundle, work: WorkFolder) -> dict[str, str]:
    path = work.path / LOCK_NAME
    try:
        return locked_answers(path.read_bytes(), bundle.manifest.id) if path.exists() else {}
    except (OSError, SceneError):
        return {}


def _draws(bundle: Bundle, work: WorkFolder) -> dict[str, str]:
    student, source = work.answers()[0], work.source()
    return {
        question.id: repr(sorted(draw(question, student, source).values.items()))
        for question in bundle.questions
        if question.draw
    }


def _changed(bundle: Bundle, work: WorkFolder) -> list[str]:
    """Generated questions whose numbers are not those last shown."""
    seen = read_table(work.path / SHOWN_NAME)
    return [name for name, values in _draws(bundle, work).items() if seen.get(name) != values]

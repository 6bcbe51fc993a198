"""Points for the answers in `answers.toml`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from ..assignment.bundle import Bundle
from ..assignment.drawing import draw
from ..assignment.questions import LETTERS, Question, flat_answers
from ..errors import IoError, SceneError
from ..printable import printable
from ..student.folder import LOCK_NAME
from ..student.predictions import locked_answers
from ..toml_limits import parse_toml
from .submission import OTHER_BYTES, Submission

MISSING = object()


@dataclass(frozen=True)
class Answered:
    """What became of one question.

    Attributes:
        id, kind: of the question.
        status: "passed", "failed" or "error-ours".
        points, max: 0 unless passed.
        text: one sentence; never the right answer.
        answer: what was answered, as text; empty where nothing was.
    """

    id: str
    kind: str
    status: str
    points: float
    max: float
    text: str = ""
    answer: str = ""

    def to_json(self) -> dict[str, Any]:
        """As plain JSON types."""
        return asdict(self)


def score_answers(bundle: Bundle, submission: Submission) -> tuple[list[Answered], str, list[str]]:
    """Every question of the assignment, none missing.

    A locked prediction cannot be changed any more, so it is answered at once: right or wrong, why,
    and where the handout says so. The other questions are answered where the bundle is closed.

    Args:
        bundle: with keys.
        submission: of a student.

    Returns:
        The results, the student's name as `answers.toml` has it, and warnings.

    Raises:
        Exception: nobody foresaw what the files hold, or this code has a mistake.
    """
    student, given, warnings = read_answers(submission.files.get("answers.toml"))
    locked: dict[str, str] = {}
    lock = submission.files.get(LOCK_NAME)
    if lock is not None:
        try:
            locked = locked_answers(lock, bundle.manifest.id)
        except SceneError as error:
            warnings.append(str(error))
    source = submission.files.get(f"{bundle.manifest.module}.py", b"").decode("utf-8")
    results = []
    for question in bundle.questions:
        answer = given.get(question.id, MISSING)
        if question.kind == "prediction":
            results.append(_prediction(question, answer, locked))
        elif answer is MISSING or answer == "":
            results.append(_result(question, "failed", "not answered"))
        elif question.options:
            results.append(_choice(question, answer))
        else:
            results.append(_number(bundle, question, answer, (student, source)))
    if bundle.closed:
        results = [
            each if each.kind == "prediction" else replace(each, text=_said(each.text, question))
            for each, question in zip(results, bundle.questions, strict=True)
        ]
    return results, student, warnings


def all_answered(bundle: Bundle, status: str, text: str) -> list[Answered]:
    """Every question with the same verdict, "failed" or "error-ours"."""
    return [_result(question, status, text) for question in bundle.questions]


def plain_answers(bundle: Bundle) -> Submission:
    """The solution with the answer 1 to each question, which any sound reader can judge."""
    lines = ["[answers]", *(f'"{question.id}" = "1"' for question in bundle.questions)]
    module = f"{bundle.manifest.module}.py"
    return Submission({module: bundle.solution.encode(), "answers.toml": "\n".join(lines).encode()})


def read_answers(data: bytes | None) -> tuple[str, dict[str, Any], list[str]]:
    """Name, answers by id, and warnings; whatever the file holds."""
    if data is None:
        return "", {}, []
    try:
        table = parse_toml("grade", "answers.toml", data.decode("utf-8"), OTHER_BYTES)
    except (IoError, UnicodeDecodeError) as error:
        return "", {}, [f"nothing is answered: {printable(error, 160)}"]
    answers = table.get("answers", {})
    if not isinstance(answers, dict):
        return "", {}, ["answers.toml: [answers] is no table, so nothing is answered"]
    name = table.get("student", "")
    return printable(name, 120) if isinstance(name, str) else "", flat_answers(answers), []


def _prediction(question: Question, answer: Any, locked: Mapping[str, str]) -> Answered:
    letter = _letter(question, locked.get(question.id))
    if letter is None:
        return _result(question, "failed", "not predicted before the first check")
    if answer is not MISSING and answer != "" and _letter(question, answer) != letter:
        said = f"answers.toml differs from the locked prediction ({letter})"
        return _result(question, "failed", said, answer)
    return _result(question, "passed", _answer_to(question, letter), letter)


def _answer_to(question: Question, letter: str) -> str:
    """What is said of a prediction: whether it was right, and why. It has its points anyway."""
    if not isinstance(question.answer, str) or question.answer not in [*LETTERS]:
        return "predicted and locked"
    right = letter == question.answer
    option = question.options[LETTERS.index(question.answer)]
    found = "right" if right else f"it turned out otherwise: {question.answer}) {option}"
    return _said(f"predicted and locked; {found}", question)


def _said(text: str, question: Question) -> str:
    """A sentence, and after it why the answer is right and where the handout says so."""
    where = f"see {question.where}" if question.where else ""
    because = " ".join(question.because.split()).removesuffix(".")
    return ". ".join(part for part in (text, because, where) if part)


def _choice(question: Question, answer: Any) -> Answered:
    letter = _letter(question, answer)
    if letter is None:
        last = LETTERS[len(question.options) - 1]
        return _result(question, "failed", f"expected a letter from a to {last}", answer)
    if (
        not isinstance(question.answer, str)
        or question.answer not in LETTERS
        or not question.answer
    ):
        return _result(question, "error-ours", f"{question.id}: the bundle holds no key", answer)
    right = letter == question.answer
    return _result(question, *(("passed", "") if right else ("failed", "not right")), letter)


def _letter(question: Question, answer: Any) -> str | None:
    if not isinstance(answer, str):
        return None
    letter = answer.strip().lower()
    is_one = len(letter) == 1 and letter in LETTERS[: len(question.options)]
    return letter if is_one else None


def _number(
    bundle: Bundle, question: Question, answer: Any, drawn_for: tuple[str, str]
) -> Answered:
    value = _finite(answer)
    if value is None:
        return _result(question, "failed", "expected a finite number", answer)
    drawn = draw(question, *drawn_for).values  # made of the submission, so not within the `try`
    try:
        key = _key(bundle, question, drawn)
    except Exception as error:  # our own answers.py; whatever it does is not the student's fault
        said = f"{question.id}: {type(error).__name__}: {error}"
        return _result(question, "error-ours", said, answer)
    # Written so that nothing undefined passes.
    if abs(value - key) <= question.tolerance * abs(key):
        return _result(question, "passed", "", answer)
    allowed = f"not within {question.tolerance:.0e} of the right value, relatively"
    return _result(question, "failed", allowed, answer)


def _key(bundle: Bundle, question: Question, drawn: Mapping[str, float]) -> float:
    if isinstance(question.answer, str):
        if bundle.keys is None or bundle.reference is None:
            raise SceneError(f"{question.id}: the bundle has no keys")
        key = float(getattr(bundle.keys, question.answer)(bundle.reference, **drawn))
    else:
        key = float(question.answer)
    if not math.isfinite(key):
        raise SceneError(f"{question.id}: the key is {key}")
    return key


def _finite(answer: Any) -> float | None:
    if isinstance(answer, bool) or not isinstance(answer, (int, float, str)):
        return None
    try:
        value = float(str(answer)[:60])
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _result(question: Question, status: str, text: str, answer: Any = "") -> Answered:
    points = question.points if status == "passed" else 0.0
    shown = printable(answer, 80) if isinstance(answer, (str, int, float)) else "(no value)"
    return Answered(question.id, question.kind, status, points, question.points, text, shown)

"""`questions.toml`: predictions, diagnoses, concepts, and questions made from the submission.

Kinds: a *prediction* is locked before the first check and earns its points by being made; a
*diagnosis* or *concept* question has a right answer; a *generated* one draws its numbers from the
submission itself, and its right answer is computed by a function of `answers.py`. An answer is
a letter ("b") where there are options, else a number. Keys (`answer`, `because`, `where`) never
leave the grader but in reports.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import SceneError, message
from .toml import read_toml

KINDS = ("prediction", "diagnosis", "concept", "generated")
LETTERS = "abcdefgh"
MOST_DOTS = 4  # in the id of an answer


@dataclass(frozen=True)
class Question:
    """One question.

    Attributes:
        id, kind, points, text: such as "01.p1", "prediction", 2, and what is asked. In a
            generated question the text holds {names} of `draw` and perhaps {quote}.
        options: for a choice; answered by letter.
        draw: for a generated question, the values each name may take.
        quote: name of a function of the submission whose last line is quoted.
        tolerance: relative, for numbers.
        answer: the key: a letter, a number, or the name of a function in `answers.py`; "" in kits.
        because, where: said of a prediction with the grade, of others after the due date: why the
            answer is right, and where the handout says so, such as "section 2, Eq. (7)".
    """

    id: str
    kind: str
    points: float
    text: str
    options: tuple[str, ...] = ()
    draw: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    quote: str = ""
    tolerance: float = 1e-3
    answer: str | float = ""
    because: str = ""
    where: str = ""


def read_questions(folder: Path) -> tuple[Question, ...]:
    """The questions of `folder/questions.toml`, none if there is no such file.

    Raises:
        SceneError: a key is unknown or a value impossible.
    """
    path = folder / "questions.toml"
    if not path.exists():
        return ()
    questions = []
    for kind, entries in read_toml(path).items():
        if kind not in KINDS:
            raise _bad(kind, f"tables named {KINDS}", "another name")
        questions += [_question(kind, entry) for entry in entries]
    ids = [question.id for question in questions]
    if twice := {each for each in ids if ids.count(each) > 1}:
        raise _bad("id", "an id of its own each", f"{sorted(twice)} more than once")
    return tuple(questions)


def flat_answers(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """The answers in the table [answers], by id.

    An id has a dot, so TOML has it quoted (`"01.p1" = "b"`) or as a table within (`01.p1 = "b"`).
    """
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, dict) and prefix.count(".") < MOST_DOTS:
            flat.update(flat_answers(value, f"{prefix}{key}."))
        else:
            flat[prefix + key] = value
    return flat


def _question(kind: str, entry: dict[str, Any]) -> Question:
    name = str(entry.get("id", "?"))
    known = set(Question.__dataclass_fields__) - {"kind"}
    if unknown := set(entry) - known:
        raise _bad(name, f"keys {sorted(known)}", f"{sorted(unknown)}")
    if missing := {"id", "points", "text"} - set(entry):
        raise _bad(name, "id, points and text", f"no {sorted(missing)}")
    fields = {
        **entry,
        "options": tuple(entry.get("options", ())),
        "draw": {key: tuple(values) for key, values in entry.get("draw", {}).items()},
        "points": float(entry["points"]),
    }
    question = Question(kind=kind, **fields)
    if len(question.options) > len(LETTERS):
        raise _bad(name, f"at most {len(LETTERS)} options", str(len(question.options)))
    if kind == "prediction" and not question.options:
        raise _bad(name, "options: predictions are choices", "none")
    if question.options and question.answer not in ("", *LETTERS[: len(question.options)]):
        raise _bad(name, "a letter as answer", repr(question.answer))
    return question


def _bad(where: str, expected: str, got: str) -> SceneError:
    return SceneError(message("read_questions", where, expected, got))

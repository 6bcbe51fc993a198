"""The questions of an assignment as one student gets them."""

from __future__ import annotations

from ..assignment.bundle import Bundle
from ..assignment.drawing import draw
from ..assignment.questions import LETTERS
from .folder import WorkFolder


def question_sheet(bundle: Bundle, work: WorkFolder) -> list[str]:
    """Lines: each question with its numbers, options, points and the answer so far."""
    student, answers = work.answers()
    source = work.source()
    lines = [] if student else ["(Write your name into answers.toml first: it draws the numbers.)"]
    for question in bundle.questions:
        drawn = draw(question, student, source)
        lines += ["", f"{question.id}  ({question.kind}, {question.points:g} points)", drawn.text]
        lines += [
            f"  {letter}) {option}"
            for letter, option in zip(LETTERS, question.options, strict=False)
        ]
        answer = str(answers.get(question.id, "")).strip()
        lines.append(f"  your answer: {answer or '(open)'}")
    return lines


def open_questions(bundle: Bundle, work: WorkFolder) -> list[str]:
    """Ids of questions without an answer."""
    _, answers = work.answers()
    return [q.id for q in bundle.questions if not str(answers.get(q.id, "")).strip()]

"""Questions made from the submission: its author and its code decide the numbers.

The numbers change with the code, but not with comments or layout, so answers are worked out once
the code is final. Nothing of a submission is executed here, or parsed as more than words.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .questions import Question
from .tokens import code_words


@dataclass(frozen=True)
class Drawn:
    """A question as one student gets it: its text, and the numbers drawn for it."""

    text: str
    values: Mapping[str, float]


def draw(question: Question, student: str, source: str) -> Drawn:
    """The question for this student and this code.

    Args:
        question: of any kind; only generated ones have something to draw.
        student: the name or number in the submission.
        source: text of the graded module.
    """
    words = "\n".join((question.id, " ".join(student.split()), *code_words(source)))
    digest = hashlib.sha256(words.encode("utf-8", errors="replace")).digest()
    rng = np.random.default_rng(list(digest))
    values = {name: float(rng.choice(list(given))) for name, given in question.draw.items()}
    text = question.text
    for name, value in values.items():
        text = text.replace("{" + name + "}", f"{value:g}")
    if question.quote:
        text = text.replace("{quote}", last_line(source, question.quote))
    return Drawn(text, values)


def last_line(source: str, function: str) -> str:
    """The last line of code of a function, for quoting; "..." where it is not found."""
    found, inside, indent = "...", False, 0
    for line in source.splitlines():
        bare = line.strip()
        depth = len(line) - len(line.lstrip())
        if bare.startswith(f"def {function}("):
            inside, indent = True, depth
        elif inside and bare and not bare.startswith(("#", ")")):
            if depth <= indent:
                break
            found = bare
    return found[:120]

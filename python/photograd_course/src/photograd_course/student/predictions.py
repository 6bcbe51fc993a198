"""Predictions are made before the first check, and locked.

A lock earns the points of a prediction whatever it says: being surprised is worth as much as being
right, guessing afterwards is worth nothing.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from ..assignment.questions import LETTERS, Question
from ..atomic_io import atomic_write
from ..errors import SceneError, message
from .folder import LOCK_NAME


def prediction_letters(
    questions: Sequence[Question], answers: Mapping[str, Any]
) -> tuple[dict[str, str], list[Question]]:
    """The valid predictions by id, and the questions that still lack one."""
    made, lacking = {}, []
    for question in questions:
        if question.kind != "prediction":
            continue
        letter = str(answers.get(question.id, "")).strip().lower()
        if len(letter) == 1 and letter in LETTERS[: len(question.options)]:
            made[question.id] = letter
        else:
            lacking.append(question)
    return made, lacking


def digest(assignment: str, made: Mapping[str, str]) -> str:
    """The checksum in a lock."""
    text = json.dumps({"assignment": assignment, "answers": dict(sorted(made.items()))})
    return hashlib.sha256(text.encode()).hexdigest()


def write_lock(folder: Path, assignment: str, made: Mapping[str, str]) -> None:
    """Lock the predictions; a lock that is there stays."""
    path = folder / LOCK_NAME
    if path.exists():
        return
    now = datetime.now(timezone.utc).isoformat(timespec="seconds")
    lock = {
        "assignment": assignment,
        "answers": dict(sorted(made.items())),
        "locked_at": now,
        "sha256": digest(assignment, made),
    }
    atomic_write(path, (json.dumps(lock, indent=2) + "\n").encode())


def locked_answers(data: bytes, assignment: str) -> dict[str, str]:
    """The predictions in a lock file.

    Raises:
        SceneError: it is damaged, or of another assignment.
    """
    try:
        lock = json.loads(data)
        made = {str(key): str(value) for key, value in lock["answers"].items()}
        good = lock["assignment"] == assignment and lock["sha256"] == digest(assignment, made)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        good, made = False, {}
    if not good:
        text = f"the untouched lock of assignment {assignment}"
        raise SceneError(message("predictions", LOCK_NAME, text, "another"))
    return made

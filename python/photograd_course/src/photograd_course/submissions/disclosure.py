"""What a student may read about a check: all of a public one, less of a hidden one.

A wrong answer to a hidden check can be made of its input: an exception's name, the value at the
worst index, a shape, even the size of an error. From hidden checks nothing is said that a
submission could have written, numbers but for an order of magnitude included. What is said besides
is one of a few sentences: how all values relate to the right ones (`grading.relations`, without
numbers), and the class of the arguments. From secret checks nothing is said at all.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

from ..grading.outcome import Outcome, Status

_NUMBER = re.compile(r"[-+]?\d[\d_]*(?:\.\d*)?(?:e[-+]?\d+)?|\b(?:nan|inf)\b", re.IGNORECASE)
_KEPT = ("tolerance", "expected_sign", "expected_scale")

# Reasons whose sentence is made before a check's input exists, or quotes nothing of the submission.
_HARMLESS = {"", "not implemented", "missing", "blocked", "submission", "forbidden", "unreadable"}
_HARMLESS |= {"rule"}  # of the text alone
_SENTENCES = {
    "raised": "a function raised an exception",
    "output": "a function returned something that cannot be compared",
    "timeout": "no answer within the time allowed",
    "died": "the process ended (a crash, an exit, or out of memory)",
    "broken": "the file does not import",
    # Seen at run time, in the worker: its words could be the submission's.
    "computed": "a derivative is computed (by differences, complex steps, a fit, dual numbers): "
    "write it",
}
STAFF_TEXT = "the grader itself failed here; staff have been told, and no points are lost by it"


def for_student(outcome: Outcome) -> Outcome:
    """The outcome as its student may read it."""
    if outcome.status is Status.ERROR_OURS:
        return replace(outcome, text=STAFF_TEXT, hint="", details={}, arrays=None)
    if outcome.visibility == "public":
        return outcome
    if outcome.visibility == "secret":
        return replace(outcome, reason="", text="", hint="", details={}, arrays=None)
    details = {key: value for key, value in outcome.details.items() if key in _KEPT}
    if isinstance(error := outcome.details.get("error"), float):
        details["error"] = magnitude(error)
    return replace(outcome, text=_hidden_text(outcome, details), details=details, arrays=None)


def magnitude(value: float) -> float:
    """The power of ten below a positive number; 1 for all that is larger, or no number."""
    if not math.isfinite(value) or value >= 1.0:
        return 1.0
    return 0.0 if value <= 0 else float(10.0 ** math.floor(math.log10(value)))


def _hidden_text(outcome: Outcome, details: dict[str, Any]) -> str:
    """The sentence; the classes of arguments are the grader's words, and few."""
    text, case = _without_class(outcome, details), outcome.details.get("case")
    return f"{text} ({case})" if case and case not in text else text


def _without_class(outcome: Outcome, details: dict[str, Any]) -> str:
    if outcome.reason in ("wrong", "cost"):
        return _wrong(outcome, details)
    if outcome.reason in _HARMLESS:
        return outcome.text
    return _SENTENCES.get(outcome.reason, "no valid answer came")


def _wrong(outcome: Outcome, details: dict[str, Any]) -> str:
    if "error" in details and "tolerance" in details:
        what = outcome.text.split(": relative error")[0]
        size = "1 or more" if details["error"] >= 1 else f"about {details['error']:.0e}"
        relation = outcome.details.get("relation")  # one of few sentences without a number
        seen = f"; {relation}" if relation else ""
        return f"{what}: relative error {size}, allowed {details['tolerance']:.0e}{seen}"
    kept = outcome.text.split(", got ")[0].split("; yours")[0]
    return _NUMBER.sub("\N{HORIZONTAL ELLIPSIS}", kept)

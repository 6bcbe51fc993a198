"""Sentences about a wrong answer, which never hold a hidden value."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..worker.codec import encode
from .failures import NotFinite

PLACES = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")


def worst_entry(got: Any, right: Any, worst: tuple[Any, ...], error: float, *, reveal: bool) -> str:
    """What is to be said of the entry that is furthest off.

    Args:
        got, right: the answer and what was expected.
        worst: the index.
        error: of the whole answer.
        reveal: say what was expected; else its sign and order of magnitude.
    """
    at = f" at index {tuple(int(i) for i in worst)}" if right.ndim else ""
    mine, theirs = float(got[worst]) + 0.0, float(right[worst]) + 0.0  # no minus zero
    if reveal:
        told = _told_apart(mine, theirs)
        return f"yours{at} is {told[0]}, expected {told[1]}"
    expected = _sign_and_size(theirs)
    if expected == _sign_and_size(mine):
        alike = "sign and order of magnitude" if error < 1 else "sign"
        return f"yours{at} is {mine:.6g}, of the right {alike}, but wrong"
    return f"yours{at} is {mine:.6g}, expected {expected}"


def not_finite(what: str, answer: Any, right: Any) -> NotFinite:
    """The failure of an answer that is not finite where a finite one was expected."""
    bad = ~np.isfinite(answer)
    text = f"{what}: expected a finite number, got {answer}"
    if right.ndim:
        first = tuple(int(i) for i in np.argwhere(bad)[0])
        text = f"{what}: {bad.sum()} of {bad.size} values are not finite, the first at {first}"
    return NotFinite(text, arrays=(answer, right) if right.ndim else None)


def changed_argument(before: Any, after: Any) -> str:
    """Which of the arguments is not as it was, in a word."""
    if isinstance(after, list) and len(after) == len(before):
        for place, mine, theirs in zip(PLACES, before, after, strict=False):
            if encode("args", 0, [mine]) != encode("args", 0, [theirs]):
                return place
    return "given"


def power_of_ten(value: float) -> str:
    """The order of magnitude, such as "1e-02"."""
    if not value or not np.isfinite(value):
        return "0"
    return f"1e{int(np.floor(np.log10(abs(value)))):+03d}"


def _told_apart(a: float, b: float) -> tuple[str, str]:
    """Two numbers with six digits, or with as many more as show that they differ."""
    for digits in range(6, 18):
        texts = f"{a:.{digits}g}", f"{b:.{digits}g}"
        if texts[0] != texts[1]:
            break
    return texts


def _sign_and_size(value: float) -> str:
    """As much as may be said of a hidden value."""
    sign = {1.0: "positive", -1.0: "negative"}.get(float(np.sign(value)), "zero")
    return f"something {sign}, of the order {power_of_ten(value)}" if value else sign

"""Known mistakes, recognized by the wrong answer they give.

When an assignment is built, every mutant runs against every check; the fingerprint of its wrong
answer is kept beside the sentence that names the mistake. Neither the mutant nor the right answer
can be read from the table.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .failures import CheckFailed

# Wrong answers that agree to so many digits have the same cause.
FINGERPRINT_DIGITS = 8


def fingerprint(what: str, answer: ArrayLike, error: float = 0.0) -> str:
    """A short hash of a wrong answer, equal for answers that agree to eight digits.

    Args:
        what: the quantity.
        answer: its value.
        error: of the answer, of which a twentieth counts. It tells apart what was expected, where
            that is made of other values of the same submission, as finite differences are: the
            same derivative is twice too large for one loss, and three times for another.
    """
    values = np.asarray(answer, np.float64)
    finite = np.abs(values[np.isfinite(values)])
    top = float(finite.max()) if finite.size else 0.0
    step = top * 10.0**-FINGERPRINT_DIGITS
    rounded = (np.rint(values / step) if step > 0 else values) + 0.0  # no minus zero
    size = f"{top:.{FINGERPRINT_DIGITS - 2}e}"
    # The classes of errors begin at no number that is likely, such as 1/8.
    off = math.floor(20 * math.log(error) + 0.37) if 0 < error < math.inf else error
    data = f"{what}|{values.shape}|{size}|{off}|".encode() + rounded.astype("<f8").tobytes()
    return hashlib.sha256(data).hexdigest()[:24]


def hint_key(salt: str, check: str, fingerprint: str) -> str:
    """The key under which a known mistake is kept."""
    return hashlib.sha256(f"{salt}|{check}|{fingerprint}".encode()).hexdigest()[:24]


def find_hint(hints: Mapping[str, str], salt: str, check: str, failure: CheckFailed) -> str:
    """The sentence that fits this wrong answer, or an empty string."""
    if failure.fingerprint is None:
        return ""
    return hints.get(hint_key(salt, check, failure.fingerprint), "")

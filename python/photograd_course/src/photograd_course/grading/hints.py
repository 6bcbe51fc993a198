"""Known mistakes, recognized by the wrong answer they give.

When an assignment is built, every mutant runs against every check; the fingerprint of its wrong
answer is kept beside the sentence that names the mistake. Neither the mutant nor the right answer
can be read from the table.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

from .failures import CheckFailed


def hint_key(salt: str, check: str, fingerprint: str) -> str:
    """The key under which a known mistake is kept."""
    return hashlib.sha256(f"{salt}|{check}|{fingerprint}".encode()).hexdigest()[:24]


def find_hint(hints: Mapping[str, str], salt: str, check: str, failure: CheckFailed) -> str:
    """The sentence that fits this wrong answer, or an empty string."""
    if failure.fingerprint is None:
        return ""
    return hints.get(hint_key(salt, check, failure.fingerprint), "")

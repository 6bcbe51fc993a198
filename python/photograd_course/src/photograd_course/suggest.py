"""Near misses: what somebody may have meant by a name that does not exist."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name most like ``name``, ignoring case, or None if none is close.

    >>> nearest("dense_gird", ["dense_grid", "texture"])
    'dense_grid'
    """
    by_lower = {candidate.lower(): candidate for candidate in sorted(known)}
    close = difflib.get_close_matches(name.lower(), by_lower, n=1, cutoff=0.6)
    return by_lower[close[0]] if close else None


def choose_from(name: str, known: Iterable[str]) -> str:
    """A remedy for an error message: the nearest name if there is one, else all of them.

    >>> choose_from("dense_gird", ["dense_grid", "texture"])
    "did you mean 'dense_grid'?"
    >>> choose_from("zebra", ["dense_grid", "texture"])
    'choose from dense_grid, texture'
    """
    names = sorted(known)
    best = nearest(name, names)
    if best is not None:
        return f"did you mean '{best}'?"
    return "choose from " + ", ".join(names) if names else "none is available"

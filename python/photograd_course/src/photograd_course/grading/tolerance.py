"""How far an answer may be off, and why that far."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tolerance:
    """A bound on the norm-relative error ||got - expected|| / ||expected||.

    Attributes:
        relative: the bound.
        evidence: what was measured: the spread of correct solutions, the nearest wrong one.
        floor: the norm of ``expected`` counts as at least this, for answers that may be zero.
    """

    relative: float
    evidence: str
    floor: float = 0.0

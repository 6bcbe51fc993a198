"""The trusted side: what a check may say, how submissions are called, and what comes of it.

An assignment's `checks/` needs only what this module exports.
"""

from __future__ import annotations

from .battery import Subject
from .check import Check, check, checks_for, hidden_check
from .cost import agree
from .failures import CheckFailed, GraderFault, StudentFailure
from .outcome import Outcome, Status
from .specs import Array, Integer, Items, Number, Record, Text, Truth, asks
from .tolerance import Tolerance
from .trial import Trial

__all__ = [
    "Array",
    "Check",
    "CheckFailed",
    "GraderFault",
    "Integer",
    "Items",
    "Number",
    "Outcome",
    "Record",
    "Status",
    "StudentFailure",
    "Subject",
    "Text",
    "Tolerance",
    "Trial",
    "Truth",
    "agree",
    "asks",
    "check",
    "checks_for",
    "hidden_check",
]

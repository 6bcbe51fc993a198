"""Three ways in which a check ends without passing, kept apart because they cost differently."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ..errors import Error


@dataclass
class CheckFailed(Exception):
    """The answer came and is wrong.

    Attributes:
        text: one sentence for the student; never contains a hidden value.
        details: for the report: error, tolerance, worst index, expected sign and scale, how the
            answer relates to the right one ("relation"), the class of the arguments ("case"). The
            runner takes out "advice" (of the comparison: what is often wrong) and "explained" (the
            text leaves nothing open, so that advice could only lead away).
        fingerprint: of the wrong answer, for the table of known mistakes.
        arrays: (got, expected) where a picture of them helps.
    """

    text: str
    details: dict[str, Any] = field(default_factory=dict)
    fingerprint: str | None = None
    arrays: tuple[Any, Any] | None = None

    def __str__(self) -> str:
        return self.text


class WrongForm(CheckFailed):
    """The answer is of another kind, shape or dtype: its values, and hints, come later."""


class NotFinite(CheckFailed):
    """Values are NaN or infinite: hints are about values that are wrong, NumPy's warning is not."""


class TooExpensive(CheckFailed):
    """The answer is right, at a price that no written adjoint has."""


@dataclass
class StudentFailure(Exception):
    """No answer came, through the submission's own doing.

    Attributes:
        reason: "not implemented", "raised", "missing", "timeout", "died", "protocol", "forbidden",
            "unreadable", "broken" (it does not import), "output", "rule" (a derivative is not
            written, as its text shows) or "computed" (the same, as its runs show).
        text: one sentence for the student.
        private: what may hold input of a check (an exception's text); shown for public checks only.
        line: (file, line) in the submission.
        case: the class of the arguments, such as "for no rows"; empty for everyday ones.
    """

    reason: str
    text: str
    private: str = ""
    line: tuple[str, int] | None = None
    case: str = ""

    def __str__(self) -> str:
        return self.text


class GraderFault(Error):
    """Our own mistake or a broken machine. Never costs a student points."""


class MachineTooBusy(GraderFault):
    """A submission's worker got so little processor time that nothing can be said about it."""

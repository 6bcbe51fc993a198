"""What became of one check."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from enum import Enum
from typing import Any


class Status(str, Enum):
    """Passed, failed, blocked by an earlier failure, or our own fault."""

    PASSED = "passed"
    FAILED = "failed"
    BLOCKED = "blocked"
    ERROR_OURS = "error-ours"


@dataclass(frozen=True)
class Outcome:
    """One line of a report.

    Attributes:
        id, title, task, visibility: of the check, from the manifest.
        status, points, max: the verdict; `points` is 0 unless passed.
        reason: "" or a short class: "not implemented", "wrong", "timeout", "blocked" and so on.
        text: one sentence for the student.
        hint: what is probably wrong; empty where nothing is known.
        details: error, tolerance, worst index, expected sign and scale; margins for the doctor.
        seconds: wall-clock time.
        arrays: (got, expected) of a failed public check, for a picture; never in a report.
    """

    id: str
    title: str
    task: str
    visibility: str
    status: Status
    points: float
    max: float
    reason: str = ""
    text: str = ""
    hint: str = ""
    details: dict[str, Any] = field(default_factory=dict)
    seconds: float = 0.0
    arrays: tuple[Any, Any] | None = field(default=None, compare=False, repr=False)

    def to_json(self) -> dict[str, Any]:
        """As plain JSON types."""
        plain = asdict(replace(self, arrays=None))
        del plain["arrays"]
        return {**plain, "status": self.status.value}

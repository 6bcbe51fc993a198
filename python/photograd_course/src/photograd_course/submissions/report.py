"""The report on one submission: verdicts, points, and all it takes to come to them again."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..cli.version import version_of
from ..grading.outcome import Outcome, Status
from .answers import Answered

INDICATIVE = "graded without isolation: indicative only"


@dataclass(frozen=True)
class Report:
    """What became of one submission.

    Attributes:
        student: as the export or table names them.
        declared: the name in `answers.toml`, by which questions were drawn.
        assignment, title: of the assignment.
        submission, bundle: SHA-256 of both.
        mode, isolation: of isolation, and what staff should know about it here; verdicts of mode
            "E" are indicative only.
        checks, questions: every one of the bundle, none missing.
        problem, warnings, ignored: about the submission's files.
        staff: what staff must look at; empty where nothing is wrong on our side.
        versions: of what took part.
        seconds: wall-clock time.
    """

    student: str
    declared: str
    assignment: str
    title: str
    submission: str
    bundle: str
    mode: str
    checks: tuple[Outcome, ...]
    questions: tuple[Answered, ...]
    isolation: str = ""
    problem: str = ""
    warnings: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    staff: tuple[str, ...] = ()
    versions: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0

    @property
    def is_sound(self) -> bool:
        """Whether nothing went wrong on our side, so that the score may count."""
        return not self.staff

    @property
    def proven(self) -> float:
        """Points of what has been proven."""
        return float(sum(c.points for c in self.checks) + sum(q.points for q in self.questions))

    @property
    def score(self) -> float | None:
        """The points; None where the grader failed, for then nobody knows them yet."""
        return self.proven if self.is_sound else None

    @property
    def max_score(self) -> float:
        """What a perfect submission gets."""
        return float(sum(c.max for c in self.checks) + sum(q.max for q in self.questions))

    @property
    def points(self) -> dict[str, float]:
        """Points of each check and question, by id."""
        checks = {check.id: check.points for check in self.checks}
        return {**checks, **{question.id: question.points for question in self.questions}}

    @property
    def remarks(self) -> tuple[str, ...]:
        """What stands above the verdicts."""
        first = (INDICATIVE,) if self.mode == "E" else ()
        return (*first, *((self.problem,) if self.problem else ()), *self.warnings)

    def to_json(self) -> dict[str, Any]:
        """As plain JSON types."""
        return {
            "student": self.student,
            "declared": self.declared,
            "assignment": self.assignment,
            "title": self.title,
            "score": self.score,
            "max_score": self.max_score,
            "proven": self.proven,
            "status": "ok" if self.is_sound else Status.ERROR_OURS.value,
            "mode": self.mode,
            "isolation": self.isolation,
            "indicative": self.mode == "E",
            "submission": self.submission,
            "bundle": self.bundle,
            "checks": [outcome.to_json() for outcome in self.checks],
            "questions": [answered.to_json() for answered in self.questions],
            "problem": self.problem,
            "warnings": list(self.warnings),
            "ignored": list(self.ignored),
            "staff": list(self.staff),
            "versions": dict(self.versions),
            "seconds": self.seconds,
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Report:
        """The report that `to_json` wrote.

        Raises:
            KeyError, TypeError, ValueError: it did not.
        """
        return cls(
            checks=tuple(_outcome(entry) for entry in data["checks"]),
            questions=tuple(Answered(**entry) for entry in data["questions"]),
            student=str(data["student"]),
            declared=str(data["declared"]),
            assignment=str(data["assignment"]),
            title=str(data["title"]),
            submission=str(data["submission"]),
            bundle=str(data["bundle"]),
            mode=str(data["mode"]),
            isolation=str(data["isolation"]),
            problem=str(data["problem"]),
            warnings=tuple(data["warnings"]),
            ignored=tuple(data["ignored"]),
            staff=tuple(data["staff"]),
            versions=dict(data["versions"]),
            seconds=float(data["seconds"]),
        )


def staff_notes(checks: Sequence[Outcome], questions: Sequence[Answered]) -> tuple[str, ...]:
    """One line for each of our own failures, whichever checks and questions it hit."""
    ours = Status.ERROR_OURS.value
    failed = [(each.id, each.text) for each in checks if each.status.value == ours]
    failed += [(each.id, each.text) for each in questions if each.status == ours]
    hit: dict[str, list[str]] = {}
    for name, text in failed:
        hit.setdefault(text, []).append(name)
    return tuple(f"{_counted(names)}: {text}" for text, names in hit.items())


def _counted(names: Sequence[str]) -> str:
    more = len(names) - 1
    return names[0] if not more else f"{names[0]} and {more} more"


def versions() -> dict[str, str]:
    """Of what a verdict may depend on."""
    return {
        "photograd-course": version_of("photograd-course") or "unknown",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": f"{platform.system()} {platform.machine()}",
    }


def _outcome(entry: dict[str, Any]) -> Outcome:
    return Outcome(**{**entry, "status": Status(entry["status"])})

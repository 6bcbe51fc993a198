"""`grades.csv` for the gradebook and `changes.csv` for a second grading."""

from __future__ import annotations

import csv
import hashlib
import io
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..grading.outcome import Status
from ..printable import csv_cell, file_name
from .exports import Ignored
from .report import Report
from .said_once import said_once
from .source import Source


@dataclass(frozen=True)
class Change:
    """How one student's grade differs from an earlier run.

    Attributes:
        student: whose.
        before, after: scores; None where there is none.
        checks: "id: before -> after" for each check and question whose points differ.
    """

    student: str
    before: float | None
    after: float | None
    checks: tuple[str, ...]


def grades_table(
    reports: Sequence[Report], earlier: Mapping[str, Report], sources: Sequence[Source] = ()
) -> bytes:
    """One row a student, by name; nothing in it depends on when or in what order it was graded.

    A score is empty, not zero, where the grader failed and no earlier points can stand in.

    Args:
        reports: of this run.
        earlier: of the run before, by student.
        sources: the submissions, where names, ids and late marks of an export are known.
    """
    known = {source.student: source for source in sources}
    alike = Counter((source.name, source.id) for source in sources)
    head = ["student", "id", "email", "late", "assignment", "score", "max_score", "status"]
    head += ["mode", "page", "submission"]
    ids = list(reports[0].points) if reports else []
    rows: list[list[Any]] = [[*head, *ids, "notes"]]
    declared = Counter(report.declared for report in reports if report.declared)
    for report in sorted(reports, key=lambda each: each.student):
        score, status = counted(report, earlier.get(report.student))
        points = report.points
        source = known.get(report.student)
        rows.append(
            [
                *_who(report, source, alike),
                report.assignment,
                "" if score is None else score,
                report.max_score,
                status,
                report.mode,
                f"{page_name(report.student)}.html",
                report.submission[:16],
                *(points.get(each, "") for each in ids),
                "; ".join(_notes(report, declared)),
            ]
        )
    return csv_table(rows)


def _who(report: Report, source: Source | None, alike: Mapping[tuple[str, str], int]) -> list[str]:
    if source is None:
        return [report.student, "", "", ""]
    name = source.name if alike[source.name, source.id] == 1 else report.student
    return [name, source.id, source.email, "yes" if source.is_late else ""]


def _notes(report: Report, declared: Mapping[str, int]) -> list[str]:
    faults = said_once(report.checks, report.remarks).faults if report.is_sound else ()
    notes = [*faults, *report.remarks, *(f"staff: {note}" for note in report.staff)]
    if declared.get(report.declared, 0) > 1:  # whose questions, and so whose answers, are these?
        notes.append(f"staff: answers.toml names {report.declared}, as another submission does")
    return notes


def counted(report: Report, earlier: Report | None) -> tuple[float | None, str]:
    """The score that counts, and why: our own failure lowers no grade, and saves none.

    Where we failed, a check or question keeps the points that the same submission had for it
    before; all others count as they are now. Another submission's points stand for nothing.

    Args:
        report: of this run.
        earlier: of the run before, on the same student.
    """
    if report.is_sound:
        return report.score, "submission refused" if report.problem else "ok"
    if earlier is None or earlier.score is None or earlier.submission != report.submission:
        return None, "error-ours"
    ours = Status.ERROR_OURS.value
    failed = [(check.id, check.max) for check in report.checks if check.status.value == ours]
    failed += [(each.id, each.max) for each in report.questions if each.status == ours]
    kept = sum(min(earlier.points.get(name, 0.0), most) for name, most in failed)
    return report.proven + kept, "error-ours, earlier points kept"


def changes(reports: Sequence[Report], earlier: Mapping[str, Report]) -> list[Change]:
    """Who changes, and by which check; also who is new or gone.

    Args:
        reports: of this run.
        earlier: of the run before, by student.
    """
    found = []
    now = {report.student: report for report in reports}
    for student in sorted({*now, *earlier}):
        new, old = now.get(student), earlier.get(student)
        lines = _differing(old, new)
        after = None if new is None else counted(new, old)[0]
        before = None if old is None else old.score
        if lines or before != after:
            found.append(Change(student, before, after, tuple(lines)))
    return found


def changes_table(found: Sequence[Change]) -> bytes:
    """The differences that were `found`, as a table."""
    rows: list[list[Any]] = [["student", "before", "after", "checks"]]
    for change in found:
        scores = ["" if s is None else s for s in (change.before, change.after)]
        rows.append([change.student, *scores, "; ".join(change.checks)])
    return csv_table(rows)


def ignored_table(ignored: Sequence[Ignored]) -> bytes:
    """The `ignored` entries, which are no submissions, and why."""
    rows: list[list[Any]] = [["entry", "reason"]]
    return csv_table([*rows, *([each.name, each.reason] for each in ignored)])


def page_name(student: str) -> str:
    """Unique for each student on any file system, and readable."""
    digest = hashlib.sha256(student.encode("utf-8", errors="replace")).hexdigest()
    return f"{file_name(student)}-{digest[:10]}"


def _differing(old: Report | None, new: Report | None) -> list[str]:
    if old is None or new is None:
        return ["new" if old is None else "gone"]
    before, after = _verdicts(old), _verdicts(new)
    return [
        f"{each}: {before.get(each, 'none')} -> {after.get(each, 'none')}"
        for each in dict.fromkeys([*before, *after])
        if before.get(each) != after.get(each)
    ]


def _verdicts(report: Report) -> dict[str, str]:
    checks = {c.id: f"{c.status.value} {c.points:g}" for c in report.checks}
    return {**checks, **{q.id: f"{q.status} {q.points:g}" for q in report.questions}}


def csv_table(rows: Sequence[Sequence[Any]]) -> bytes:
    """A table of these `rows` as bytes, in which no cell is a formula."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n", quoting=csv.QUOTE_MINIMAL)
    writer.writerows([csv_cell(cell) for cell in row] for row in rows)
    return text.getvalue().encode("utf-8", errors="replace")

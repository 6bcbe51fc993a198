"""Judge one submission: every check of the bundle in a worker of its own, every question.

Where judging itself breaks, a control decides whose doing it is: the same step is repeated with
what is known to be good, the solution and plain answers. If that goes well, the submission has
brought it about and fails; if not, the fault is ours.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..assignment.bundle import Bundle
from ..errors import IoError
from ..grading.check import Check
from ..grading.failures import GraderFault, StudentFailure
from ..grading.outcome import Outcome, Status
from ..grading.remote import RemoteStudent
from ..grading.runner import adjoint_functions, run_checks
from ..grading.trial import Student
from ..printable import printable
from .answers import Answered, all_answered, plain_answers, score_answers
from .earlier import setting_with_earlier
from .report import Report, staff_notes, versions
from .submission import Submission
from .workers import Budget, Clocked, Workers

LONGEST = 240.0  # seconds for a whole submission; grading services allow a few minutes
Answers = tuple[list[Answered], str, list[str]]
OnOutcome = Callable[[Outcome], None]


@dataclass(frozen=True)
class Case:
    """What is to be judged.

    Attributes:
        student: whose it is.
        submission: as taken in.
        bundle, bundle_digest: the assignment, with hidden checks.
    """

    student: str
    submission: Submission
    bundle: Bundle
    bundle_digest: str


def grade_one(
    case: Case,
    workers: Workers | None,
    *,
    slot: int = 0,
    unavailable: str = "",
    on_outcome: OnOutcome | None = None,
) -> Report:
    """The report on one submission; never raises for what the submission or the bundle's checks do.

    Args:
        case: what is to be judged.
        workers: where to run it; None where no isolation mode is good enough.
        slot: number of the worker, among those that run at the same time.
        unavailable: why there are no workers; for staff.
        on_outcome: called after each check.
    """
    started = time.monotonic()
    refused: dict[str, None] = {}
    checks = _judge(case, workers, slot, unavailable, on_outcome, refused)
    answered, declared, warnings = _answers(case)
    warnings = [*map(printable, refused), *warnings]
    return _report(case, workers, checks, (answered, declared, warnings), started)


def grade_guarded(case: Case, workers: Workers | None, grade: Callable[[], Report]) -> Report:
    """The report that ``grade`` makes; where it raises, one that says so to staff.

    A mistake of ours in one submission, wherever it hides, must not cost the others their grades.

    Args:
        case: whose report it is, for the second kind; its `submission` may be empty.
        workers: where it was to run.
        grade: takes the submission in, judges it, perhaps keeps the report.

    Raises:
        IoError: results cannot be written, so nothing that is judged from here on could be kept.
    """
    try:
        return grade()
    except IoError:
        raise
    except Exception as error:
        fault = f"{type(error).__name__}: {printable(error)}"
    checks = _all(case, Status.ERROR_OURS, "error-ours", fault, None)
    answered = all_answered(case.bundle, Status.ERROR_OURS.value, fault)
    return _report(case, workers, checks, (answered, "", []), time.monotonic())


def _answers(case: Case) -> Answers:
    try:
        return score_answers(case.bundle, case.submission)
    except (OSError, MemoryError) as error:
        ours: Exception = error
    except Exception as error:
        ours = error
        with contextlib.suppress(Exception):
            score_answers(case.bundle, plain_answers(case.bundle))
            said = f"the answers cannot be judged: {type(error).__name__}"
            return all_answered(case.bundle, Status.FAILED.value, said), "", [said]
    fault = f"{type(ours).__name__}: {ours}"
    return all_answered(case.bundle, Status.ERROR_OURS.value, fault), "", []


def _report(
    case: Case, workers: Workers | None, checks: Sequence[Outcome], answers: Answers, started: float
) -> Report:
    answered, declared, warnings = answers
    manifest = case.bundle.manifest
    return Report(
        student=case.student,
        declared=declared,
        assignment=manifest.id,
        title=manifest.title,
        submission=case.submission.digest,
        bundle=case.bundle_digest,
        mode=workers.mode if workers is not None else "none",
        isolation=workers.note if workers is not None else "",
        checks=tuple(checks),
        questions=tuple(answered),
        problem=case.submission.problem,
        warnings=(*case.submission.warnings, *warnings, *_otherwise(checks)),
        ignored=case.submission.ignored,
        staff=staff_notes(checks, answered),
        versions=versions(),
        seconds=time.monotonic() - started,
    )


def _otherwise(checks: Sequence[Outcome]) -> list[str]:
    """What behaves otherwise while its derivative is watched: no verdict, but worth a look."""
    said = (str(check.details.get("otherwise", "")) for check in checks)
    return [f"{each}: what it computes was not seen" for each in dict.fromkeys(said) if each]


def time_allowed(bundle: Bundle) -> float:
    """Seconds for all checks of one submission: what each may take, capped."""
    return min(LONGEST, bundle.manifest.limits.seconds * max(1, len(bundle.checks)))


def _judge(
    case: Case,
    workers: Workers | None,
    slot: int,
    unavailable: str,
    on_outcome: OnOutcome | None,
    refused: dict[str, None],
) -> list[Outcome]:
    if workers is None:
        return _all(case, Status.ERROR_OURS, "error-ours", unavailable, on_outcome)
    if case.submission.problem:
        return _all(case, Status.FAILED, "submission", case.submission.problem, on_outcome)
    try:
        return _run(case, workers, slot, on_outcome, refused)
    except IoError:
        raise  # from writing results: nothing that is judged from here on could be kept
    except Exception as error:  # ours, whatever it is; the next submission still gets its turn
        said = f"{type(error).__name__}: {error}"
        return _all(case, Status.ERROR_OURS, "error-ours", said, on_outcome)


def _run(
    case: Case, workers: Workers, slot: int, on_outcome: OnOutcome | None, refused: dict[str, None]
) -> list[Outcome]:
    """The outcomes; `refused` gets a sentence for each import that is not allowed."""
    bundle = case.bundle
    adjoints = adjoint_functions(bundle.checks)
    hand = replace(bundle.hand(case.submission.files), adjoints=adjoints)
    budget = Budget(time_allowed(bundle))

    def open_student(substitutes: Mapping[str, Callable[..., Any]]) -> Student:
        if budget.left <= 0:
            said = f"the {time_allowed(bundle):g} seconds for this submission were used up before"
            raise StudentFailure("timeout", said)
        connection = Clocked(workers.open(slot), budget)
        student = RemoteStudent(connection, replace(hand, substitutes=dict(substitutes)))
        refused.update(dict.fromkeys(student.refused))
        return student

    def open_control() -> Student:
        solution = bundle.hand(bundle.solution_files(bundle.solution))
        return RemoteStudent(workers.open(slot), solution)

    found = run_checks(
        bundle.checks,
        setting_with_earlier(bundle, case.submission.files),
        open_student,
        open_control=open_control if bundle.solution else None,
        on_outcome=on_outcome,
    )
    # Ids and points come from the bundle, whatever has happened meanwhile.
    expected = [(check.id, check.points) for check in bundle.checks]
    if [(outcome.id, outcome.max) for outcome in found] != expected:
        raise GraderFault("the outcomes are not those of the bundle's checks")
    return found


def _all(
    case: Case, status: Status, reason: str, text: str, on_outcome: OnOutcome | None
) -> list[Outcome]:
    outcomes = [_outcome(check, status, reason, text) for check in case.bundle.checks]
    for outcome in outcomes:
        if on_outcome is not None:
            on_outcome(outcome)
    return outcomes


def _outcome(check: Check, status: Status, reason: str, text: str) -> Outcome:
    return Outcome(
        id=check.id,
        title=check.title,
        task=check.task,
        visibility=check.visibility,
        status=status,
        points=0.0,
        max=check.points,
        reason=reason,
        text=text,
    )

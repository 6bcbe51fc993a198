"""Run the checks of an assignment on one hand-in, in the order of their dependencies."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from .check import Check
from .failures import CheckFailed, GraderFault, StudentFailure
from .hints import find_hint
from .outcome import Outcome, Status
from .trial import Student, Trial

Open = Callable[[Mapping[str, Callable[..., Any]]], Student]


@dataclass(frozen=True)
class Setting:
    """What belongs to an assignment rather than to a hand-in.

    Attributes:
        module: name of the graded module.
        seed: numbers that, with a check's id, give its random stream.
        reference: the solution's module, or None on a student's machine.
        hints, salt: the table of known mistakes.
    """

    module: str
    seed: tuple[int, ...]
    reference: Any = None
    hints: Mapping[str, str] = field(default_factory=dict)
    salt: str = ""


@dataclass
class _Verdict:
    status: Status
    reason: str = ""
    text: str = ""
    hint: str = ""
    details: dict[str, Any] = field(default_factory=dict)
    arrays: tuple[Any, Any] | None = None


def run_checks(
    checks: Sequence[Check],
    setting_of: Callable[[Check], Setting],
    open_student: Open,
    *,
    on_outcome: Callable[[Outcome], None] | None = None,
) -> list[Outcome]:
    """The outcome of every check, none missing, in the given order.

    Each check gets a student of its own, so nothing survives from one into the next. A check fails
    unless its body returns; whatever goes wrong on our side is "error-ours".

    Args:
        checks: sorted so that tasks come after those they need.
        setting_of: what the assignment adds to a check, such as `Bundle.setting`.
        open_student: starts the hand-in; gets the functions to be replaced by the reference's.
        on_outcome: called after each check.
    """
    failed: dict[str, str] = {}  # function of the hand-in to the check in which it failed
    outcomes = []
    for check in checks:
        started = time.monotonic()
        verdict = _judge(check, setting_of(check), open_student, failed)
        if verdict.status is not Status.PASSED:
            for function in check.calls:
                failed.setdefault(function, check.id)
        passed = verdict.status is Status.PASSED
        outcome = Outcome(
            id=check.id,
            title=check.title,
            task=check.task,
            visibility=check.visibility,
            status=verdict.status,
            points=check.points if passed else 0.0,
            max=check.points,
            reason=verdict.reason,
            text=verdict.text,
            hint=verdict.hint,
            details=verdict.details,
            seconds=time.monotonic() - started,
            arrays=verdict.arrays if check.visibility == "public" else None,
        )
        outcomes.append(outcome)
        if on_outcome is not None:
            on_outcome(outcome)
    return outcomes


def _judge(
    check: Check, setting: Setting, open_student: Open, failed: Mapping[str, str]
) -> _Verdict:
    culprits = [name for name in check.needs if name in failed]
    verdict = _run(check, setting, open_student, {})
    if verdict.status is not Status.FAILED or not culprits:
        return verdict
    if setting.reference is None:
        if verdict.reason == "not implemented":
            return verdict
        parents = ", ".join(sorted({failed[name] for name in culprits}))
        return _Verdict(Status.BLOCKED, "blocked", f"blocked by {parents}: mend that first")
    # Once more with the reference's earlier functions; the better verdict counts.
    substitutes = {
        f"{setting.module}.{name}": getattr(setting.reference, name) for name in culprits
    }
    second = _run(check, setting, open_student, substitutes)
    if second.status is Status.PASSED:
        second.text = f"with the reference's {', '.join(culprits)}"
        return second
    return verdict


def _run(
    check: Check,
    setting: Setting,
    open_student: Open,
    substitutes: Mapping[str, Callable[..., Any]],
) -> _Verdict:
    student: Student | None = None
    trial: Trial | None = None
    try:
        student = open_student(substitutes)
        seed = (*setting.seed, *check.id.encode())
        trial = Trial(check, student, seed=seed, module=setting.module, reference=setting.reference)
        check.body(trial)
        if not trial.margins and not trial.asked:
            raise GraderFault(f"{check.id}: passed without comparing anything")
        verdict = _Verdict(Status.PASSED)
    except CheckFailed as failure:
        hint = find_hint(setting.hints, setting.salt, check.id, failure)
        advice = str(failure.details.pop("advice", ""))
        verdict = _Verdict(Status.FAILED, "wrong", failure.text, hint or advice or check.hint)
        verdict.details.update(failure.details)
        verdict.arrays = failure.arrays
        if failure.fingerprint is not None:
            verdict.details["fingerprint"] = failure.fingerprint
    except StudentFailure as failure:
        verdict = _Verdict(Status.FAILED, failure.reason, failure.text)
        if failure.line is not None:
            verdict.details["line"] = list(failure.line)
        if failure.private and check.visibility == "public":
            verdict.details["exception"] = failure.private
    except Exception as error:
        verdict = _Verdict(Status.ERROR_OURS, "error-ours", f"{type(error).__name__}: {error}")
    finally:
        if student is not None:
            student.close()
    if trial is not None and trial.margins:
        verdict.details["margin"] = max(trial.margins)
    return verdict

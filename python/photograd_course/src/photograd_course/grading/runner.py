"""Run the checks of an assignment on one submission, in the order of their dependencies."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from .adjoint_watch import Remembering, find_breach
from .battery import run_battery
from .check import Check
from .failures import (
    CheckFailed,
    GraderFault,
    MachineTooBusy,
    NotFinite,
    StudentFailure,
    TooExpensive,
    WrongForm,
)
from .hints import find_hint
from .outcome import Outcome, Status
from .trial import Breach, Student, Trial

# Verdicts that a wrong value of an earlier function can bring about.
OF_VALUES = ("wrong", "raised", "output", "not implemented")
Open = Callable[[Mapping[str, Callable[..., Any]]], Student]
OpenControl = Callable[[], Student]


@dataclass(frozen=True)
class Setting:
    """What belongs to an assignment rather than to a submission.

    Attributes:
        module: name of the graded module.
        seed: numbers that, with a check's id, give its random stream.
        reference: the solution's module, or None on a student's machine.
        hints, salt: the table of known mistakes.
        earlier: functions of earlier assignments that a check uses, as "module.name" by which a
            module of the submission knows them, to those of the solutions.
    """

    module: str
    seed: tuple[int, ...]
    reference: Any = None
    hints: Mapping[str, str] = field(default_factory=dict)
    salt: str = ""
    earlier: Mapping[str, Callable[..., Any]] = field(default_factory=dict)


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
    open_control: OpenControl | None = None,
    on_outcome: Callable[[Outcome], None] | None = None,
    wrong: Mapping[str, str] | None = None,
) -> list[Outcome]:
    """The outcome of every check, none missing, in the given order.

    Each check gets a student of its own, so nothing survives from one into the next. A check fails
    unless its body returns; whatever goes wrong on our side is "error-ours".

    A body that ends with an exception of another kind has met values that nobody foresaw, or has
    a mistake. The control tells: where the check passes for the solution, the values were to
    blame, and the check has failed. Without a control the mistake counts as ours.

    Args:
        checks: sorted so that tasks come after those they need.
        setting_of: what the assignment adds to a check, such as `Bundle.setting`.
        open_student: starts the submission; gets the functions to be replaced by the reference's.
        open_control: starts the solution in the same way; None where it is not at hand.
        on_outcome: called after each check; where the price of an adjoint proves too high later,
            the outcomes that are returned have the last word.
        wrong: functions that are known to be wrong beforehand, to the check that says so.
    """
    failed = dict(wrong or {})  # function of the submission to the check in which it failed
    judge = _Judge(open_student, open_control)
    outcomes = []
    for check in checks:
        started = time.monotonic()
        verdict = judge.verdict(check, setting_of(check), failed)
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
    return _without_price(checks, _without_broken(checks, outcomes, judge.broken))


@dataclass(frozen=True)
class _Judge:
    """Runs one check after another; see `run_checks` for its fields."""

    open_student: Open
    open_control: OpenControl | None
    broken: dict[str, Breach] = field(default_factory=dict)  # by function, seen at run time

    def verdict(self, check: Check, setting: Setting, failed: Mapping[str, str]) -> _Verdict:
        culprits = [name for name in check.needs if name in failed]
        check = replace(check, hint=_general_advice(check, failed))
        verdict = self._blamed(check, setting, {})
        may_be_earlier = setting.earlier and verdict.reason in OF_VALUES
        if verdict.status is not Status.FAILED or not (culprits or may_be_earlier):
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
        if culprits:
            second = self._blamed(check, setting, substitutes)
            if second.status is Status.PASSED:
                second.text = f"with the reference's {', '.join(culprits)}"
                return second
        if may_be_earlier:
            last = self._blamed(check, setting, {**setting.earlier, **substitutes})
            if last.status is Status.PASSED:
                brought = sorted({name.rpartition(".")[2] for name in setting.earlier})
                whose = "yours" if len(brought) == 1 else "one of yours"
                last.text = (
                    f"with the reference's {', '.join([*culprits, *brought])}: {whose}, brought "
                    "from an earlier assignment, is wrong"
                )
                return last
        return verdict

    def _blamed(
        self, check: Check, setting: Setting, substitutes: Mapping[str, Callable[..., Any]]
    ) -> _Verdict:
        """The verdict; where the body broke, after asking whose doing that was."""
        try:
            return _run(check, setting, lambda: self.open_student(substitutes), self.broken)
        except _BodyBroke as broke:
            if self.open_control is None or not self._control_passes(check, setting):
                return _ours(broke.error)
            # Its text is for staff: `for_student` shows it for public checks only.
            said = {"exception": f"{type(broke.error).__name__}: {broke.error}"}
            text = "the values that came back, or were asked for, cannot be judged"
            return _Verdict(Status.FAILED, "output", text, details=said)

    def _control_passes(self, check: Check, setting: Setting) -> bool:
        assert self.open_control is not None
        try:
            return _run(check, setting, self.open_control, {}).status is Status.PASSED
        except _BodyBroke:
            return False


class _BodyBroke(Exception):
    """The body of a check ended with an exception that is no verdict."""

    def __init__(self, error: Exception) -> None:
        super().__init__(str(error))
        self.error = error


def _general_advice(check: Check, failed: Mapping[str, str]) -> str:
    """What to read where nothing better is known: a check that has failed before, or the hint.

    Only of the same functions: what a check needs besides is not to blame where this is said.
    """
    about = [failed[name] for name in check.calls if name in failed]
    return f"{about[0]} fails as well: begin there" if about else check.hint


def _run(
    check: Check, setting: Setting, open_one: OpenControl, broken: dict[str, Breach]
) -> _Verdict:
    """What comes of one run; derivatives that turn out to be computed are added to ``broken``.

    Raises:
        _BodyBroke: nothing; it has to be found out whose doing that was.
    """
    student: Student | None = None
    trial: Trial | None = None
    remembered: Remembering | None = None
    try:
        student = open_one()
        _require_written(check, student.breaches)
        _require_written(check, broken, "computed")
        if check.adjoints:
            student = remembered = Remembering(student, check.adjoints)
        seed = (*setting.seed, *check.id.encode())
        trial = Trial(check, student, seed=seed, module=setting.module, reference=setting.reference)
        check.body(trial)
        for subject in check.battery:
            run_battery(trial, subject)
        if not trial.margins and not trial.asked:
            raise GraderFault(f"{check.id}: passed without comparing anything")
        breach, otherwise = (None, "") if remembered is None else find_breach(remembered)
        if breach is not None:
            broken.update(dict.fromkeys(check.adjoints, breach))
            _require_written(check, broken, "computed")
        verdict = _Verdict(Status.PASSED, details={"otherwise": otherwise} if otherwise else {})
    except CheckFailed as failure:
        verdict = _wrong(check, setting, failure)
    except StudentFailure as failure:
        verdict = _Verdict(Status.FAILED, failure.reason, _with(failure.text, failure.case))
        if failure.case:
            verdict.details["case"] = failure.case
        if failure.line is not None:
            verdict.details["line"] = list(failure.line)
        if failure.private and check.visibility == "public":
            verdict.details["exception"] = failure.private
    except Exception as error:
        machine = (OSError, MemoryError, MachineTooBusy)
        if trial is not None and not isinstance(error, machine):
            raise _BodyBroke(error) from error
        verdict = _ours(error)  # a worker that does not start, or a machine in trouble
    finally:
        if student is not None:
            student.close()
    if trial is not None and trial.margins:
        verdict.details["margin"] = max(trial.margins)
    return verdict


def _wrong(check: Check, setting: Setting, failure: CheckFailed) -> _Verdict:
    """The verdict on a wrong answer, with the hint that was seen to fit, or advice."""
    advice = str(failure.details.pop("advice", ""))
    explained = failure.details.pop("explained", False)
    if explained or isinstance(failure, NotFinite):
        advice = ""
    elif not isinstance(failure, WrongForm):  # of which its own advice alone speaks
        advice = advice or check.hint
    hint = find_hint(setting.hints, setting.salt, check.id, failure) or advice
    case = str(failure.details.get("case", ""))
    reason = "cost" if isinstance(failure, TooExpensive) else "wrong"
    verdict = _Verdict(Status.FAILED, reason, _with(failure.text, case), hint)
    verdict.details.update({k: v for k, v in failure.details.items() if v != ""})
    verdict.arrays = failure.arrays
    if failure.fingerprint is not None:
        verdict.details["fingerprint"] = failure.fingerprint
    return verdict


def _with(text: str, case: str) -> str:
    return f"{text} ({case})" if case and case not in text else text


def _require_written(check: Check, breaches: Mapping[str, Breach], reason: str = "rule") -> None:
    """Raise StudentFailure where a derivative that the check is about is not written."""
    for function in check.adjoints:
        if function in breaches:
            said, line = breaches[function]
            raise StudentFailure(reason, said, line=line)


def _without_broken(
    checks: Sequence[Check], outcomes: Sequence[Outcome], broken: Mapping[str, Breach]
) -> list[Outcome]:
    """The outcomes; what passed before a derivative was seen to be computed has failed as well."""
    found = []
    for check, outcome in zip(checks, outcomes, strict=True):
        said = [broken[name] for name in check.adjoints if name in broken]
        if said and outcome.status is Status.PASSED:
            text, line = said[0]
            details = {**outcome.details, "line": list(line)}
            lost = replace(outcome, status=Status.FAILED, points=0.0, reason="computed", text=text)
            found.append(replace(lost, details=details))
        else:
            found.append(outcome)
    return found


def _without_price(checks: Sequence[Check], outcomes: Sequence[Outcome]) -> list[Outcome]:
    """The outcomes; those about an adjoint whose price is too high have failed, whatever they were.

    Right values prove nothing about a derivative that was found by brute force.
    """
    unpaid = [
        check
        for check, outcome in zip(checks, outcomes, strict=True)
        if check.is_price and outcome.reason in ("cost", "timeout")
    ]
    found = []
    for check, outcome in zip(checks, outcomes, strict=True):
        about = [p.id for p in unpaid if p.task == check.task and {*p.calls} & {*check.calls}]
        if about and outcome.status is Status.PASSED:
            text = f"counts only with {about[0]}, which found the derivative too expensive"
            lost = replace(outcome, status=Status.FAILED, points=0.0, reason="rule", text=text)
            found.append(lost)
        else:
            found.append(outcome)
    return found


def adjoint_functions(checks: Sequence[Check]) -> list[str]:
    """All functions in which the checks want a derivative to be written."""
    return list(dict.fromkeys(name for check in checks for name in check.adjoints))


def _ours(error: Exception) -> _Verdict:
    return _Verdict(Status.ERROR_OURS, "error-ours", f"{type(error).__name__}: {error}")

"""A fault of a whole submission, said once above the verdicts and not under each check again."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from ..grading.outcome import Outcome, Status

# Reasons that come from the submission's files, or from us, before a check has asked anything.
_WHOLE = {"forbidden", "unreadable", "broken", "submission", "error-ours"}
BELOW = "see the note above"


@dataclass(frozen=True)
class SaidOnce:
    """Faults that several checks share, and the checks without them.

    What is our own fault is no fault of the submission: `staff` notes of a report say it.
    """

    faults: tuple[str, ...]
    checks: tuple[Outcome, ...]


def said_once(
    checks: Sequence[Outcome],
    known: Sequence[str] = (),
    shown: Callable[[Outcome], Outcome] = lambda outcome: outcome,
) -> SaidOnce:
    """Take out what several checks would say alike.

    Args:
        checks: of one report.
        known: what stands above the verdicts already.
        shown: what of an outcome its reader may see; of a fault that public checks share with
            hidden ones, the public words are said.
    """
    groups: dict[tuple[str, ...], list[Outcome]] = {}
    for outcome in checks:
        if outcome.status is not Status.PASSED and outcome.reason in _WHOLE and outcome.text:
            groups.setdefault(_key(outcome), []).append(outcome)
    shared = {key: group for key, group in groups.items() if len(group) > 1}
    faults = [
        _said(group, len(checks), shown)
        for group in shared.values()
        if group[0].status is not Status.ERROR_OURS
    ]
    left = tuple(
        replace(shown(each), text=BELOW, hint="", details={})
        if each.status is not Status.PASSED and _key(each) in shared
        else shown(each)
        for each in checks
    )
    said = tuple(f"{text} ({count})" for text, count in faults if text not in known)
    return SaidOnce(said, left)


def _key(outcome: Outcome) -> tuple[str, ...]:
    exception = str(outcome.details.get("exception", ""))
    return (outcome.status.value, outcome.reason, outcome.text, exception)


def _said(
    group: Sequence[Outcome], total: int, shown: Callable[[Outcome], Outcome]
) -> tuple[str, str]:
    told = shown(next((each for each in group if each.visibility == "public"), group[0]))
    exception = str(told.details.get("exception", ""))
    text = f"{told.text}: {exception}" if exception else told.text
    return text, f"all {total} checks" if len(group) == total else f"{len(group)} checks"

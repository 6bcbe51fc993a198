"""A check: what it asks and what it is worth."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from ..errors import RangeError, message
from .tolerance import Tolerance
from .trial import Trial

VISIBILITIES = ("public", "hidden", "secret")
Body = Callable[[Trial], None]


@dataclass(frozen=True)
class Check:
    """One declarative check; its body asks the hand-in and compares.

    Attributes:
        id: unique in the assignment, such as "01.2.rate".
        task: the task of the manifest that it belongs to, such as "01.2".
        points: what it is worth.
        visibility: "public" (students have it), "hidden" (shown after the hand-in is due) or
            "secret" (only its title is ever shown).
        calls: functions of the hand-in that it is about, such as ("gd_1d",).
        needs: functions of earlier tasks that those use; where one of them has failed, the check is
            blocked, or run once more with the reference in their place.
        tolerance: for ``Trial.close``.
        hint: said on failure when no known mistake fits better.
        seconds: wall-clock limit of one call.
        sole: why the check stays although no mutant dies by it alone; empty where one does.
        body: the function; its docstring's first line is the title.
    """

    id: str
    task: str
    points: float
    body: Body
    calls: tuple[str, ...]
    visibility: str = "public"
    needs: tuple[str, ...] = ()
    tolerance: Tolerance | None = None
    hint: str = ""
    seconds: float = 10.0
    sole: str = ""

    @property
    def title(self) -> str:
        """One sentence: what must hold."""
        return (self.body.__doc__ or self.id).strip().splitlines()[0]


def check(
    id: str,
    *,
    task: str,
    points: float,
    calls: Iterable[str],
    visibility: str = "public",
    needs: Iterable[str] = (),
    tolerance: Tolerance | None = None,
    hint: str = "",
    seconds: float = 10.0,
    sole: str = "",
) -> Callable[[Body], Check]:
    """Make a check of the function below.

    Raises:
        RangeError: a field is out of range.
    """
    if visibility not in VISIBILITIES:
        raise RangeError(message("check", f"visibility of {id}", VISIBILITIES, repr(visibility)))
    if not points > 0:
        raise RangeError(message("check", f"points of {id}", "more than 0", points))

    def make(body: Body) -> Check:
        if not (body.__doc__ or "").strip():
            raise RangeError(message("check", id, "a docstring: the title students read", "none"))
        return Check(
            id=id,
            task=task,
            points=points,
            body=body,
            calls=tuple(calls),
            visibility=visibility,
            needs=tuple(needs),
            tolerance=tolerance,
            hint=hint,
            seconds=seconds,
            sole=sole,
        )

    return make

"""A check: what it asks and what it is worth."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..errors import RangeError, message
from .battery import Subject
from .tolerance import Tolerance
from .trial import Trial

VISIBILITIES = ("public", "hidden", "secret")
NAMES_OF_ADJOINTS = ("_adjoint", "_backward", "_gradient", "_grad", "_cotangent")
Body = Callable[[Trial], None]


@dataclass(frozen=True)
class Check:
    """One declarative check; its body asks the submission and compares.

    Attributes:
        id: unique in the assignment, such as "01.2.rate": its task, and a name.
        points: what it is worth.
        visibility: "public" (students have it), "hidden" (shown after the submission is due) or
            "secret" (only its title is ever shown).
        calls: functions of the submission that it is about, such as ("gd_1d",).
        needs: functions of earlier tasks that those use; where one of them has failed, the check is
            blocked, or run once more with the reference in their place.
        tolerance: for ``Trial.close``.
        hint: said on failure when no known mistake fits better.
        seconds: wall-clock limit of one call.
        sole: why the check stays although no mutant dies by it alone; empty where one does.
        adjoints: those of `calls` in which a derivative has to be written, not computed by complex
            steps, dual numbers or differencing; by default those whose names say so, and where
            the body asks for the cost all.
        battery: functions that are asked for classes of mistakes after the body; hidden checks
            only, for the expected values are the reference's.
        body: the function; its docstring's first line is the title.
    """

    id: str
    points: float
    body: Body
    calls: tuple[str, ...]
    visibility: str = "public"
    needs: tuple[str, ...] = ()
    tolerance: Tolerance | None = None
    hint: str = ""
    seconds: float = 10.0
    sole: str = ""
    adjoints: tuple[str, ...] = ()
    battery: tuple[Subject, ...] = ()

    @property
    def task(self) -> str:
        """The task of the manifest that it belongs to, such as "01.2"."""
        return self.id.rpartition(".")[0]

    @property
    def title(self) -> str:
        """One sentence: what must hold."""
        return (self.body.__doc__ or self.id).strip().splitlines()[0]

    @property
    def is_price(self) -> bool:
        """Whether it asks what an adjoint costs: then the points of its task depend on it."""
        return _asks_price(self.body)


def check(
    id: str,
    *,
    points: float,
    calls: Iterable[str],
    visibility: str = "public",
    needs: Iterable[str] = (),
    tolerance: Tolerance | None = None,
    hint: str = "",
    seconds: float = 10.0,
    sole: str = "",
    adjoints: Iterable[str] | None = None,
    battery: Iterable[Subject] = (),
) -> Callable[[Body], Check]:
    """Make a check of the function below; the arguments are attributes of `Check`.

    Args:
        id: task and name, such as "05.1.outside".
        points: of the check, above 0.
        calls: functions of the student that it calls.
        visibility: "public", or "hidden" from kits.
        needs: functions of earlier tasks that those call.
        tolerance: of `Trial.close`, unless a comparison has its own.
        hint: what to read where it fails.
        seconds: of the worker's processor time.
        sole: why it is kept although no mutant needs it.
        adjoints: functions that have to be written as adjoints; by default, by their names.
        battery: subjects of the generated battery, of a hidden check.

    Raises:
        RangeError: a field is out of range.
    """
    if visibility not in VISIBILITIES:
        raise RangeError(message("check", f"visibility of {id}", VISIBILITIES, repr(visibility)))
    if not points > 0:
        raise RangeError(message("check", f"points of {id}", "more than 0", points))

    called, subjects = tuple(calls), tuple(battery)
    if subjects and visibility == "public":
        raise RangeError(message("check", f"battery of {id}", "a hidden check", visibility))

    def make(body: Body) -> Check:
        if not (body.__doc__ or "").strip():
            raise RangeError(message("check", id, "a docstring: the title students read", "none"))
        return Check(
            id=id,
            points=points,
            body=body,
            calls=called,
            visibility=visibility,
            needs=tuple(needs),
            tolerance=tolerance,
            hint=hint,
            seconds=seconds,
            sole=sole,
            adjoints=_adjoints(called, body) if adjoints is None else tuple(adjoints),
            battery=subjects,
        )

    return make


def hidden_check(id: str, **arguments: Any) -> Callable[[Body], Check]:
    """`check` with the visibility "hidden".

    Args:
        id: task and name.
        arguments: the others of `check`.
    """
    return check(id, visibility="hidden", **arguments)


def checks_for(**shared: Any) -> Callable[..., Callable[[Body], Check]]:
    """`check` for a file whose checks have some arguments in common; each can have another.

    Args:
        shared: arguments of `check`, such as ``calls``, ``needs`` and ``tolerance``.
    """
    return partial(check, **shared)


def _adjoints(calls: tuple[str, ...], body: Body) -> tuple[str, ...]:
    if _asks_price(body):
        return calls
    return tuple(name for name in calls if name.endswith(NAMES_OF_ADJOINTS))


def _asks_price(body: Body) -> bool:
    code = getattr(body, "__code__", None)
    return code is not None and "require_cheap" in code.co_names

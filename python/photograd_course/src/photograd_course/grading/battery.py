"""Classes of mistakes, asked of any function of arrays; `check(battery=...)` names the functions.

A list of known mistakes leaves through all others. These ask for properties, at sizes, layouts and
values that no example shows; the expected values are the reference's, and some need none.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..worker.layouts import LAYOUTS
from .cost import agree
from .failures import GraderFault
from .situations import rows_said
from .specs import Spec
from .tolerance import Tolerance
from .trial import Trial

SIZES = (1, 2, 7)
LARGE = 1000
COTANGENT_SCALES = (1e-6, 1e6)  # an adjoint is linear in what arrives


@dataclass(frozen=True)
class Subject:
    """A function of the submission, how to make arguments for it, and what its text promises.

    Attributes:
        function: its name; of the graded module, or "module.name" for another.
        make: arguments for n rows (pixels, samples, parameters, steps, whatever the function is
            about), from the random numbers of a trial.
        returns: what comes back for n rows.
        right: the right answer, from the reference's module and the arguments; by default what
            the reference's function of this name returns.
        sizes: numbers of rows, 0 where the text of the function allows none.
        large: rows of one more case, far beyond all others: whatever holds for few rows alone is
            found. Fewer where the slowest right answer would take more than a tenth of a second.
        rows: positions of the arguments (arrays, or dicts of them) with a row for each row of the
            answer, where each row of the answer depends on its own row alone.
        special: by position of an argument, the values of which the text speaks, such as NaN.
        scales: by position of an argument, factors by which all of its values may be multiplied.
            Cotangents, arguments named `g` or `d_...`, have `COTANGENT_SCALES` by themselves.
        tolerance: of comparisons; by default the check's.
        common: what all right answers have in common where they differ in other ways, made of the
            trial, the arguments and an answer; by default the answer itself.
        has_right: False where right answers have nothing in common, such as samples: what is asked
            then is that the function agrees with itself, and that other arguments give others.
    """

    function: str
    make: Callable[[Trial, int], Sequence[Any]]
    returns: Callable[[int], Spec]
    right: Callable[..., Any] | None = None
    sizes: Sequence[int] = SIZES
    large: int = LARGE
    rows: Sequence[int] = ()
    special: Mapping[int, Sequence[float]] = field(default_factory=dict)
    scales: Mapping[int, Sequence[float]] = field(default_factory=dict)
    tolerance: Tolerance | None = None
    common: Callable[[Trial, Sequence[Any], Any], Any] | None = None
    has_right: bool = True

    def answer(self, trial: Trial, args: Sequence[Any]) -> Any:
        """The right answer, or what all right answers have in common."""
        if self.right is not None:
            return self.right(trial.reference, *args)
        return self.compared(trial, args, getattr(trial.reference, self.function)(*args))

    def compared(self, trial: Trial, args: Sequence[Any], answer: Any) -> Any:
        """The part of an answer that is compared.

        Args:
            trial: of the check.
            args: with which the function was called.
            answer: to them, of the submission or the reference.
        """
        return answer if self.common is None else self.common(trial, args, answer)

    def factors(self, trial: Trial) -> Mapping[int, Sequence[float]]:
        """`scales`, and those of cotangents.

        Args:
            trial: of the check, whose reference names the arguments.
        """
        function = getattr(trial.reference, self.function, None)
        if function is None:
            return self.scales
        found = {
            position: COTANGENT_SCALES
            for position, name in enumerate(inspect.signature(function).parameters)
            if name == "g" or name.startswith("d_")
        }
        return {**found, **self.scales}


def run_battery(trial: Trial, subject: Subject) -> None:
    """Every class that the subject's text promises.

    Raises:
        CheckFailed, StudentFailure: the submission makes a mistake of a class.
        GraderFault: the subject's arguments prove nothing.
    """
    require_sizes(trial, subject)
    left_unchanged(trial, subject)
    require_repeatable(trial, subject)
    if subject.rows:
        rows_independent(trial, subject)
    bad_values(trial, subject)
    scaled_values(trial, subject)


def require_sizes(trial: Trial, subject: Subject) -> None:
    """The values are right for each number of rows: one, many and, where 0 is named, none.

    The number of iterations is a size too: ``make`` may take it for one.
    """
    for n in (*subject.sizes, subject.large):
        args = subject.make(trial, n)
        with trial.situation(rows_said(n)):
            got = trial.call(subject.function, *args, returns=subject.returns(n))
            if subject.has_right:
                _require_right(trial, subject, args, got, f"{subject.function} at size {n}")
            elif subject.rows and n == subject.large:
                _rows_alone(trial, subject, args, _parts(got), n)


def left_unchanged(trial: Trial, subject: Subject, n: int = 5) -> None:
    """Arguments stay as they are; read-only, with gaps or run backwards they give equal values.

    The worker looks at the arguments: the submission's word is not asked.
    """
    args = subject.make(trial, n)
    right = subject.answer(trial, args) if subject.has_right else None
    for layout in LAYOUTS:  # the plain one first
        got = trial.look(subject.function, *args, returns=subject.returns(n), layout=layout)
        got = subject.compared(trial, args, got)
        right = got if right is None else right
        _require_equal(trial, subject, got, right, f"{subject.function} of {layout} arrays")


def require_repeatable(trial: Trial, subject: Subject, n: int = 5) -> None:
    """Equal arguments give equal values; others of the same shapes, right after, their own."""
    args, others = subject.make(trial, n), subject.make(trial, n)
    first = trial.call(subject.function, *args, returns=subject.returns(n))
    second = trial.call(subject.function, *others, returns=subject.returns(n))
    what = f"{subject.function}, called with other values of the same shapes"
    if subject.has_right:
        _require_right(trial, subject, others, second, what)
    else:
        trial.require(not _same(second, first), f"{what}: the same answer again")
    again = trial.call(subject.function, *args, returns=subject.returns(n))
    _require_equal(trial, subject, again, first, f"{subject.function}, called again")


def rows_independent(trial: Trial, subject: Subject, n: int = 6) -> None:
    """Each row of the answer depends on the same row of the arguments alone.

    Every argument in ``subject.rows`` gets values of its own in every row, so that a function which
    reads one row for all is found.
    """
    args = list(subject.make(trial, n))
    for k in subject.rows:
        if not isinstance(args[k], dict) and len(np.unique(args[k], axis=0)) < 2:
            raise GraderFault(f"{trial.check.id}: all rows of argument {k} are equal")
    whole = _parts(trial.call(subject.function, *args, returns=subject.returns(n)))
    _rows_alone(trial, subject, args, whole, n)


def _rows_alone(
    trial: Trial, subject: Subject, args: Sequence[Any], whole: Sequence[Any], n: int
) -> None:
    """Three rows of an answer are those that the function gives for these rows by themselves."""
    for row in (0, n // 2, n - 1):
        alone = list(args)
        for k in subject.rows:
            alone[k] = _one_row(args[k], row)
        parts = _parts(trial.call(subject.function, *alone, returns=subject.returns(1)))
        what = f"{subject.function}: row {row} alone against the same row among {n}"
        _require_equal(trial, subject, parts, [part[[row]] for part in whole], what)


def bad_values(trial: Trial, subject: Subject, n: int = 4) -> None:
    """What the text says of NaN, infinity and the like in the first element of an argument."""
    for position, values in subject.special.items():
        for value in values:
            args = list(subject.make(trial, n))
            args[position] = np.array(args[position], np.float64)
            args[position].flat[0] = value
            got = trial.call(subject.function, *args, returns=subject.returns(n))
            got = subject.compared(trial, args, got)
            said = f"{subject.function} where an argument holds {value}: not what the text asks for"
            trial.require(_same(got, subject.answer(trial, args)), said)


def scaled_values(trial: Trial, subject: Subject, n: int = 5) -> None:
    """The values are right where an argument is far larger or smaller, as the text allows it.

    Args:
        trial: of the check.
        subject: the function, with its `scales`.
        n: rows.
    """
    for position, factors in subject.factors(trial).items():
        for factor in factors:
            args = list(subject.make(trial, n))
            args[position] = _times(args[position], factor)
            got = trial.call(subject.function, *args, returns=subject.returns(n))
            what = f"{subject.function} of {'large' if factor > 1 else 'small'} values"
            _require_right(trial, subject, args, got, what)


def _times(value: Any, factor: float) -> Any:
    if isinstance(value, dict):
        return {name: _times(each, factor) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_times(each, factor) for each in value]
    return value * factor


def _one_row(value: Any, row: int) -> Any:
    if isinstance(value, dict):
        return {name: array[[row]] for name, array in value.items()}
    return value[[row]]


def _parts(answer: Any) -> list[Any]:
    return list(answer) if isinstance(answer, (list, tuple)) else [answer]


def _require_right(
    trial: Trial, subject: Subject, args: Sequence[Any], got: Any, what: str
) -> None:
    mine, theirs = subject.compared(trial, args, got), subject.answer(trial, args)
    _require_equal(trial, subject, mine, theirs, what)


def _require_equal(trial: Trial, subject: Subject, got: Any, right: Any, what: str) -> None:
    """Equal within the tolerance; what is empty or not finite, of one kind."""
    if isinstance(right, dict) and isinstance(got, dict):
        trial.require(set(got) == set(right), f"{what}: other names")
        for name in right:
            _require_equal(trial, subject, got[name], right[name], f"{what}, {name}")
        return
    if isinstance(right, (list, tuple)) and isinstance(got, (list, tuple)):
        trial.require(len(got) == len(right), f"{what}: another number of values")
        for k, (mine, theirs) in enumerate(zip(got, right, strict=True)):
            part = f"{what}, item {k}" if len(right) > 1 else what
            _require_equal(trial, subject, mine, theirs, part)
        return
    is_number = isinstance(right, (float, np.ndarray, np.floating))
    if is_number and np.size(right) and np.isfinite(right).all():
        trial.close(what, got, right, subject.tolerance)
    else:
        trial.require(_same(got, right), f"{what}: another answer")


def _same(got: Any, right: Any) -> bool:
    """Whether two answers agree; NaN agrees with NaN, an infinity with itself."""
    if isinstance(right, dict):
        return isinstance(got, dict) and all(_same(got.get(k), v) for k, v in right.items())
    if isinstance(right, (list, tuple)):
        return len(got) == len(right) and all(map(_same, got, right))
    if not isinstance(right, (int, float, np.ndarray, np.number)):
        return bool(got == right)
    a, b = np.asarray(got, np.float64), np.asarray(right, np.float64)
    if a.shape != b.shape:
        return False
    special = ~np.isfinite(b)
    if not np.array_equal(a[special], b[special], equal_nan=True):
        return False
    return agree(a[~special], b[~special])

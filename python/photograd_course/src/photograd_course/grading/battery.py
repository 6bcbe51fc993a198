"""Classes of mistakes, asked of any function of arrays: a check runs those that its text promises.

A list of known mistakes leaves through all others. These ask for properties, at sizes, layouts and
values that no example shows; the expected values are the reference's, and some need none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..worker.layouts import LAYOUTS
from .cost import agree
from .failures import GraderFault
from .specs import Spec
from .trial import Trial

SIZES = (1, 2, 7, 64)


@dataclass(frozen=True)
class Subject:
    """A function of the submission, and how to make arguments for it.

    Attributes:
        function: its name.
        make: arguments for n rows (pixels, samples, parameters, whatever the function is about).
        returns: what comes back for n rows.
    """

    function: str
    make: Callable[[int], Sequence[Any]]
    returns: Callable[[int], Spec]

    def right(self, trial: Trial, args: Sequence[Any]) -> Any:
        """The reference's answer."""
        return getattr(trial.reference, self.function)(*args)


def require_sizes(trial: Trial, subject: Subject, sizes: Sequence[int] = SIZES) -> None:
    """The values are right for each number of rows: one and, where 0 is named, none included.

    The number of iterations is a size too: ``make`` may take it for one.
    """
    for n in sizes:
        args = subject.make(n)
        got = trial.call(subject.function, *args, returns=subject.returns(n))
        _require_equal(trial, got, subject.right(trial, args), f"{subject.function} at size {n}")


def require_inputs_unchanged(trial: Trial, subject: Subject, n: int = 5) -> None:
    """The function leaves its arguments as they are; the worker looks, not the submission."""
    args = subject.make(n)
    trial.look(subject.function, *args, returns=subject.returns(n))


def require_layouts(trial: Trial, subject: Subject, n: int = 5) -> None:
    """Read-only arrays, views with gaps and views that run backwards give the same values."""
    args = subject.make(n)
    plain = trial.look(subject.function, *args, returns=subject.returns(n))
    for layout in LAYOUTS:
        got = trial.look(subject.function, *args, returns=subject.returns(n), layout=layout)
        _require_equal(trial, got, plain, f"{subject.function} of {layout} arrays")


def require_repeatable(trial: Trial, subject: Subject, n: int = 5) -> None:
    """Equal arguments give equal values, after a call with other arguments as well."""
    args = subject.make(n)
    first = trial.call(subject.function, *args, returns=subject.returns(n))
    trial.call(subject.function, *subject.make(n + 1), returns=subject.returns(n + 1))
    again = trial.call(subject.function, *args, returns=subject.returns(n))
    _require_equal(trial, again, first, f"{subject.function}, called again")


def require_rows_apart(
    trial: Trial, subject: Subject, rows: Sequence[int], n: int = 6, axis: int = 0
) -> None:
    """Each row of the answer depends on the same row of the arguments alone.

    Every argument in ``rows`` gets values of its own in every row, so that a function which reads
    one row for all is found out.

    Args:
        trial: of the check.
        subject: its answer is an array, or a list of arrays, with a row for each row.
        rows: positions of the arguments that have rows.
        n: number of rows.
        axis: of the rows, in arguments and answers.
    """
    args = list(subject.make(n))
    for k in rows:
        if len(np.unique(args[k], axis=axis)) < 2 and np.size(args[k]) > 1:
            raise GraderFault(f"{trial.check.id}: all rows of argument {k} are equal")
    whole = _parts(trial.call(subject.function, *args, returns=subject.returns(n)))
    for row in (0, n // 2, n - 1):
        alone = list(args)
        for k in rows:
            alone[k] = np.take(args[k], [row], axis=axis)
        parts = _parts(trial.call(subject.function, *alone, returns=subject.returns(1)))
        expected = [np.take(part, [row], axis=axis) for part in whole]
        what = f"{subject.function}: row {row} alone against the same row among {n}"
        _require_equal(trial, parts, expected, what)


def require_special(
    trial: Trial,
    subject: Subject,
    position: int,
    expected: Callable[[float], Any] | None = None,
    values: Sequence[float] = (np.nan, np.inf, -np.inf),
    n: int = 4,
) -> None:
    """What the text says of NaN and infinity in one argument holds.

    Args:
        trial: of the check.
        subject: ``returns`` must allow what is expected, such as ``Array(..., finite=False)``.
        position: of the argument whose first element becomes special.
        expected: the right answer for a special value; by default the reference's.
        values: those that the text speaks of.
        n: number of rows.
    """
    for value in values:
        args = list(subject.make(n))
        args[position] = np.array(args[position], np.float64)
        args[position].flat[0] = value
        got = trial.call(subject.function, *args, returns=subject.returns(n))
        right = subject.right(trial, args) if expected is None else expected(value)
        what = f"{subject.function} where an argument holds {value}"
        trial.require(_same(got, right), f"{what}: not what the text asks for")


def _parts(answer: Any) -> list[Any]:
    return list(answer) if isinstance(answer, (list, tuple)) else [answer]


def _require_equal(trial: Trial, got: Any, right: Any, what: str) -> None:
    """Equal within the check's tolerance; what is empty or not finite, of one kind."""
    if isinstance(right, (list, tuple)) and isinstance(got, (list, tuple)):
        trial.require(len(got) == len(right), f"{what}: another number of values")
        for k, (mine, theirs) in enumerate(zip(got, right, strict=True)):
            _require_equal(trial, mine, theirs, f"{what}, item {k}" if len(right) > 1 else what)
        return
    is_numeric = isinstance(right, (int, float, np.ndarray, np.number))
    if is_numeric and np.size(right) and np.isfinite(right).all():
        trial.close(what, got, right)
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

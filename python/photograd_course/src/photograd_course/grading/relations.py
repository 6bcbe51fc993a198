"""How a wrong answer relates to the right one, seen in the numbers alone.

A relation is stated only where it holds for all entries, so that it is true whatever the mistake
is. It names no cause: a list of known mistakes (`grading.hints`) does that.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from .orders import another_order, slices_name
from .ratios import name_of, remark_on

Array = np.ndarray[Any, np.dtype[np.float64]]
Indices = np.ndarray[Any, np.dtype[np.intp]]
# An answer is looked at as closely as its check does, within these bounds.
FINEST, COARSEST = 1e-13, 1e-6
TELLING = 3  # so many values that differ make a relation more than a coincidence,
ENOUGH = 2  # and so many a factor that has a name
ROUGHEST = 1e-2  # tolerance with which a plain factor is told apart from others
PLAIN = (*(f for n in (1, 2, 4) for f in (n, 1 / n, n * np.pi, 1 / (n * np.pi))), 3, 1 / 3)
MOST_SLICES = 4  # that are named one by one


@dataclass(frozen=True)
class Relation:
    """One statement about all entries.

    Attributes:
        text: for public checks.
        kind: the same without a number that depends on the answer: for hidden checks.
        explains: it leaves nothing open, so that general advice could only lead away.
    """

    text: str
    kind: str
    explains: bool = True


@dataclass(frozen=True)
class _Pair:
    """An answer, what was expected, and how alike two arrays must be to count as equal."""

    got: Array
    right: Array
    tolerance: float
    lengths: Collection[int]

    def same(self, a: Array, b: Array) -> bool:
        """Whether two arrays agree, the small entries too."""
        if not (np.isfinite(a).all() and np.isfinite(b).all()):
            return False
        slack = self.tolerance * float(np.abs(b).max(initial=0.0))
        return bool((np.abs(a - b) <= COARSEST * np.abs(b) + slack).all())

    @property
    def various(self) -> int:
        """How many different magnitudes are expected, 0 apart."""
        sizes = np.abs(self.right[self.right != 0])
        return int(np.unique(np.round(sizes / sizes.max(initial=1e-300), 6)).size)


def find_relation(
    got: Array, right: Array, tolerance: float, lengths: Collection[int] = ()
) -> Relation | None:
    """What holds between a wrong answer and the right one, or None.

    Args:
        got, right: of equal shape; where anything is not finite nothing is said.
        tolerance: of the check; looser ones than 1e-6 are not used.
        lengths: of axes of the arguments, and products of them, to name a factor by.
    """
    if got.shape != right.shape or not right.size or not right.any():
        return None
    if not (np.isfinite(got).all() and np.isfinite(right).all()):
        return None
    pair = _Pair(got, right, float(np.clip(tolerance, FINEST, COARSEST)), lengths)
    if not got.any():
        return Relation(_of(pair, "0"), _of(pair, "0"), explains=False)
    found = _ratio(pair)
    if found is None and right.ndim:
        where, there = _part(pair)
        found = _order(pair) or _values(pair) or there or _zeros_and_signs(pair) or where
    if found is None and right.size >= TELLING and np.ptp(got) == 0.0:
        text = "all of yours are equal, the expected ones are not"
        found = Relation(text, text, explains=False)
    return found or _rough_ratio(pair, tolerance)


def _of(pair: _Pair, said: str) -> str:
    return f"all of yours are {said}" if pair.right.ndim else f"yours is {said}"


def _ratio(pair: _Pair) -> Relation | None:
    """One constant factor, of numbers as well."""
    got, right = pair.got, pair.right
    size = float(np.abs(right).max())
    factor = float(np.vdot(right / size, got / size) / np.vdot(right / size, right / size))
    if factor == 0.0 or not np.isfinite(factor) or not pair.same(got, factor * right):
        return None
    named = name_of(factor)
    plain = "." not in named and "e" not in named
    if pair.various < TELLING and not plain:
        return None  # any two numbers have a ratio
    times = f"{named} times what is expected{remark_on(factor, pair.lengths)}"
    kind = "wrong by one constant factor" + (", which is negative" if factor < 0 else "")
    if named == "-1":
        kind = "of the wrong sign"
    return Relation(_of(pair, times), _of(pair, kind), explains=plain and pair.various >= ENOUGH)


def _rough_ratio(pair: _Pair, tolerance: float) -> Relation | None:
    """A plain factor, as far as a check tells that allows more than rounding."""
    if not COARSEST < tolerance <= ROUGHEST:
        return None
    got, right = pair.got, pair.right
    for size, sign in product(PLAIN, (1, -1)):
        factor = sign * size
        error = float(np.linalg.norm(got - factor * right))
        if factor != 1 and error <= tolerance * size * float(np.linalg.norm(right)):
            named = f"{name_of(factor)} times what is expected"
            near = f"{named}, as far as this check can tell{remark_on(factor, ())}"
            kind = "wrong by one constant factor" if sign > 0 else "of the wrong sign"
            return Relation(_of(pair, near), _of(pair, kind), explains=pair.various >= ENOUGH)
    return None


def _order(pair: _Pair) -> Relation | None:
    found = another_order(pair.got, pair.right, pair.same)
    return None if found is None else Relation(*found)


def _values(pair: _Pair) -> Relation | None:
    """One function of each entry."""
    got, right = pair.got, pair.right
    if pair.various < TELLING:
        return None
    shift = float(np.mean(got - right))
    if (
        shift
        and pair.same(got - right, np.full_like(right, shift))
        and pair.same(got, right + shift)
    ):
        more = f"{abs(shift):.6g} {'more' if shift > 0 else 'less'}"
        return Relation(
            f"all of yours are {more} than what is expected",
            "all of yours are wrong by adding one constant",
        )
    functions: dict[str, Callable[[Array], Array]] = {
        "absolute values": np.abs,
        "squares": np.square,
        "square roots": np.sqrt,
        "reciprocals": np.reciprocal,
        "exponentials": np.exp,
        "logarithms": np.log,
        "values clamped at 0": lambda x: np.maximum(x, 0.0),
        "values clamped to 0 and 1": lambda x: np.clip(x, 0.0, 1.0),
        "complements, 1 minus the value,": lambda x: 1.0 - x,
    }
    with np.errstate(all="ignore"):
        for name, function in functions.items():
            if pair.same(got, function(right)):
                text = f"all of yours are the {name} of what is expected"
                return Relation(text, text)
            if pair.same(function(got), right):
                text = f"what is expected are the {name} of yours"
                return Relation(text, text)
    return None


def _zeros_and_signs(pair: _Pair) -> Relation | None:
    """Right but for entries that are 0, should be 0, or have another sign."""
    got, right = pair.got, pair.right
    size, off = right.size, ~np.isclose(got, right, COARSEST, pair.tolerance * np.abs(right).max())
    wrong = int(off.sum())
    if not wrong or np.count_nonzero(right[~off]) < TELLING:
        return None
    at = f"at {wrong} of {size} entries"
    for holds, text in (
        (not got[off].any(), "yours are 0 {at}, where they should not be, and right elsewhere"),
        (not right[off].any(), "yours are not 0 {at}, where they should be, and right elsewhere"),
        (
            pair.same(got[off], -right[off]),
            "yours have the wrong sign {at}, and are right elsewhere",
        ),
    ):
        if holds:
            return Relation(text.format(at=at), text.format(at="at some entries"), explains=False)
    return None


def _part(pair: _Pair) -> tuple[Relation | None, Relation | None]:
    """Right but for a few slices along one axis: which; and what holds there, where it is seen."""
    got, right = pair.got, pair.right
    off = ~np.isclose(got, right, COARSEST, pair.tolerance * float(np.abs(right).max()))
    best: tuple[float, int, Indices] | None = None
    for axis in reversed(range(right.ndim)):
        wrong = off.any(axis=tuple(k for k in range(right.ndim) if k != axis))
        share = float(wrong.mean())
        if 0.0 < share <= 0.5 and wrong.sum() <= MOST_SLICES and (best is None or share < best[0]):
            best = share, axis, np.flatnonzero(wrong)
    if best is None:
        return None, None
    _, axis, indices = best
    where = f"only {place(indices, axis, right.shape)} of yours {_is(len(indices))} wrong"
    kind = f"only some {slices_name(axis, right.ndim)} of yours are wrong"
    plain, inside = Relation(where, kind, explains=False), _inside(pair, axis, indices)
    if inside is None:
        return plain, None
    both = f"{where}: {inside.text}", f"{kind}: {inside.kind}"
    return plain, Relation(*both, inside.explains)


def _inside(pair: _Pair, axis: int, indices: Indices) -> Relation | None:
    """What holds for the wrong slices."""
    part = replace(
        pair, got=np.take(pair.got, indices, axis), right=np.take(pair.right, indices, axis)
    )
    if not part.right.any() or part.right.size < TELLING:
        return None
    if not part.got.any():
        return Relation("all of it is 0", "all of it is 0", explains=False)
    return _ratio(part) or _values(part)


def place(indices: Indices, axis: int, shape: tuple[int, ...]) -> str:
    """Slices by name, such as "column 1", or "the last along axis 0"."""
    numbers = [str(int(i)) for i in indices]
    last = [shape[axis] - 1] == [int(i) for i in indices]
    listed = " and ".join(filter(None, [", ".join(numbers[:-1]), numbers[-1]]))
    if len(shape) == 1:
        return "the last entry" if last else f"{_many('entry', numbers)} {listed}"
    if len(shape) == 2:
        name = ("row", "column")[axis]
        return f"the last {name}" if last else f"{_many(name, numbers)} {listed}"
    return f"index {listed} of axis {axis}"


def _many(name: str, numbers: list[str]) -> str:
    plural = name[:-1] + "ies" if name.endswith("y") else name + "s"
    return name if len(numbers) == 1 else plural


def _is(count: int) -> str:
    return "is" if count == 1 else "are"

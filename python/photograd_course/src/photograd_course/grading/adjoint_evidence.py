"""Evidence that a derivative is a quotient of shifted evaluations, from runs under watch.

The weights of every quotient (forward, central, extrapolated, of a fitted polynomial, of a contour
integral) sum to zero. With each shifted copy of a number put back to that number, a quotient is
nothing, or 0/0, while a derivative that is written hardly changes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .shifted_copies import Copies, Seen

VANISHED = 1e-3  # of its size before
SHARE = 0.2  # of the numbers in a column of the answer that must change
FAR_SHARE = 0.6  # the same, where copies far from their bases have been put back
TINY, FELT = 3e-4, 0.1  # shifts this small, relative, do not change a right number by so much
FARTHEST = 0.9  # relative: of a multiple that a contour round a number may reach
FITTED = 0.5  # the same, of places for a fit
WIDEST = 16  # an answer with more columns is looked at as a whole
Array = np.ndarray[Any, np.dtype[Any]]


@dataclass(frozen=True)
class Stage:
    """Copies to put back together, and what they prove.

    Attributes:
        copies: to put back.
        offsets: for each run what is added to the base of each copy, and to the base.
        share: of the numbers in a column that must change in all runs.
        felt: relative change of a number that counts; 1 - VANISHED where it has to vanish.
    """

    copies: Copies
    offsets: tuple[Array, ...]
    share: float
    felt: float

    def only(self, chosen: Array) -> Stage:
        """The stage with those copies that are ``chosen``."""
        copies = Copies(self.copies.member[chosen], self.copies.base[chosen])
        return replace(self, copies=copies, offsets=tuple(each[chosen] for each in self.offsets))


@dataclass(frozen=True)
class Change:
    """A column of the answer of which too much has changed.

    Attributes:
        part: of the answer: the positions and keys that lead to an array, then a column.
        share: of its numbers, those that have changed.
    """

    part: tuple[Any, ...]
    share: float


@dataclass(frozen=True)
class Kinds:
    """The copies of a run by kind, near their bases and far.

    Attributes:
        additive, relative, other: x + h, x (1 + h), and what else lies close to an input.
        inputs: the numbers that the arguments hold.
    """

    additive: Copies
    relative: Copies
    other: Copies
    inputs: Array


def stages(values: Array, kinds: Kinds) -> Iterator[Stage]:
    """What to try, from the surest kind of copies on.

    Args:
        values: all numbers of the run.
        kinds: its copies.
    """
    additive = kinds.additive.close(values)
    close = additive.joined(kinds.relative.close(values)).joined(kinds.other.close(values))
    for copies in (additive, close):
        if len(copies.member):
            yield _plain(copies, SHARE, 1 - VANISHED)
    tiny = close.within(TINY, values).of(kinds.inputs, values)
    if len(tiny.member):
        yield _plain(tiny, SHARE, FELT)
    # A number far from its multiple is another one: 1j x, of complex numbers that turn.
    multiples = kinds.relative.within(FARTHEST, values).many(values)
    many = kinds.additive.many(values).joined(multiples)
    turned = many.only(np.isin(many.base, many.base[values[many.member].imag != 0]))
    if len(turned.member):
        yield _plain(close.joined(turned), FAR_SHARE, 1 - VANISHED)
    fitted = many.within(FITTED, values).many(values)
    if len(fitted.member):
        copies = fitted.joined(close)
        yield replace(_plain(copies, FAR_SHARE, 1 - VANISHED), offsets=_offsets(copies, values))


def _plain(copies: Copies, share: float, felt: float) -> Stage:
    return Stage(copies, (np.zeros(len(copies.member)),), share, felt)


def _offsets(copies: Copies, values: Array) -> tuple[Array, ...]:
    """None, and those of the copies that are smallest, in the middle and largest by absolute value.

    A quotient vanishes wherever all copies meet. A sum over places (pixels, samples of a ray) does
    so only where all of them are far from what counts.
    """
    size = np.abs(values[copies.member])
    order = np.lexsort((size, copies.base))
    base = copies.base[order]
    firsts = np.searchsorted(base, base, side="left")
    lasts = np.searchsorted(base, base, side="right") - 1
    found = [np.zeros(len(order))]
    for chosen in (firsts, (firsts + lasts) // 2, lasts):
        offset = np.empty(len(order))
        offset[order] = (values[copies.member[order[chosen]]] - values[base]).real
        found.append(offset)
    return tuple(found)


def puts_back(run: Seen, copies: Copies, offset: Array) -> dict[str, Array]:
    """What the worker puts where, so that copies get what their bases are in that run.

    Args:
        run: in which they were seen.
        copies: of which each has its base in front of it.
        offset: for each what is added; to its base as well.
    """
    kept, first = np.unique(copies.base, return_index=True)
    n = len(kept)
    slots = np.arange(n)
    shifts = offset[first]
    moved = shifts != 0
    index = np.concatenate([kept, kept[moved], copies.member])
    slot = np.concatenate([slots, slots[moved], np.searchsorted(kept, copies.base)])
    added = np.concatenate([np.zeros(n), shifts[moved], offset])
    is_put = np.arange(len(index)) >= n
    order = np.lexsort((is_put, index))
    index, slot, is_put, added = index[order], slot[order], is_put[order], added[order]
    record = run.record_of(index)
    kinds, counts = np.unique(record, return_counts=True)
    return {
        "places": run.places[kinds].astype(np.int32),
        "turns": run.turns[kinds].astype(np.int32),
        "sizes": run.sizes[kinds].astype(np.int32),
        "counts": counts.astype(np.int32),
        "positions": index - run.starts[record],
        "slots": slot,
        "is_put": is_put,
        "added": added,
    }


def changes(before: Any, after: Any, stage: Stage) -> list[Change]:
    """The columns of which, from ``before`` to ``after``, too much has changed for ``stage``."""
    theirs = dict(_columns(after, ()))
    found = []
    for part, column in _columns(before, ()):
        if part in theirs and theirs[part].shape == column.shape:
            share = _changed(column, theirs[part], stage.felt)
            if share >= stage.share:
                found.append(Change(part, share))
    return found


def _changed(before: Array, after: Array, felt: float) -> float:
    """The share of what was not zero that has changed, or vanished."""
    size = np.abs(before)
    counted = size > 1e-9 * float(size.max(initial=0.0))
    if not counted.any():
        return 0.0
    with np.errstate(invalid="ignore", over="ignore"):
        if felt < 0.5:
            kept = np.abs(after - before) <= felt * size
        else:
            kept = np.abs(after) > (1 - felt) * size
    return float((~kept)[counted].mean())


def _columns(value: Any, part: tuple[Any, ...]) -> Iterator[tuple[tuple[Any, ...], Array]]:
    """Arrays and numbers of floats in an answer, cut into columns where these are few."""
    if isinstance(value, float):
        yield part, np.array([value])
    elif isinstance(value, Mapping):
        for key in value:
            yield from _columns(value[key], (*part, key))
    elif isinstance(value, (list, tuple)):
        for k, each in enumerate(value):
            yield from _columns(each, (*part, k))
    elif isinstance(value, np.ndarray) and value.dtype.kind == "f" and value.size:
        if value.ndim > 1 and value.shape[-1] <= WIDEST:
            for k in range(value.shape[-1]):
                yield (*part, f"column {k}"), value[..., k].ravel()
        else:
            yield part, value.ravel()

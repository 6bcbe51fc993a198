"""Shifted copies of numbers, found in what probes saw of three equal runs.

Two runs have inputs that differ a little, each by a factor of its own. A number that changes in
both exactly as an earlier one is that plus a constant: x + h, whatever h came from; x + 1j h, too.
One that is nearly as large and changes in the same proportion in both runs is a function of it
alone that lies close by: x (1 + h), or x plus a step that grows with x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]
SMALL = 1e-2  # the largest shift, relative to the number, that a right derivative does not feel
SAME = 1e-13  # relative: no more than rounding
EXACT = 1e-9  # relative: of changes that are the same; rounding leaves 1e-10
NEAR = 5e-3  # relative: of changes that are nearly the same
NEIGHBORS = 16  # inputs that are looked at, of those nearest to a number
MANY = 4  # copies of one number, from which a polynomial can be fitted, or an integral taken
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Seen:
    """What a run's probes saw, record by record.

    Attributes:
        places, turns, sizes: of each record: the probe, how often it had seen numbers before, and
            how many numbers these are.
        values: all records' numbers, complex.
    """

    places: Array
    turns: Array
    sizes: Array
    values: Array

    @classmethod
    def of(cls, frame: Mapping[str, Any]) -> Seen:
        """From a ``frame`` of the worker; raises ValueError where it is none."""
        places, sizes = (np.asarray(frame[name], np.int64) for name in ("places", "sizes"))
        values = np.asarray(frame["re"], float) + 1j * np.asarray(frame["im"], float)
        if places.shape != sizes.shape or places.ndim != 1 or values.shape != (sizes.sum(),):
            raise ValueError("a trace whose parts do not fit together")
        return cls(places, _turns(places), sizes, values)

    @property
    def starts(self) -> Array:
        """Where each record begins."""
        return np.cumsum(self.sizes) - self.sizes

    def record_of(self, index: Array) -> Array:
        """The records in which the numbers at ``index`` are."""
        return np.searchsorted(np.cumsum(self.sizes), index, side="right")

    def at(self, other: Seen) -> Array:
        """The values of the records of ``other``, a run; NaN where this run has none like it."""
        if np.array_equal(self.places, other.places) and np.array_equal(self.sizes, other.sizes):
            return self.values
        heads = zip(self.places, self.turns, self.sizes, self.starts, strict=True)
        known = {(p, t, n): start for p, t, n, start in heads}
        found = np.full(other.values.shape, np.nan, complex)
        heads = zip(other.places, other.turns, other.sizes, other.starts, strict=True)
        for p, t, n, start in heads:
            mine = known.get((p, t, n))
            if mine is not None:
                found[start : start + n] = self.values[mine : mine + n]
        return found


def _turns(places: Array) -> Array:
    order = np.argsort(places, kind="stable")
    ordered = places[order]
    firsts = np.searchsorted(ordered, ordered)
    turns = np.empty(len(places), np.int64)
    turns[order] = np.arange(len(places)) - firsts
    return turns


@dataclass(frozen=True)
class Copies:
    """Numbers that are shifted copies of earlier ones.

    Attributes:
        member: indices into the values, increasing.
        base: for each the index of the number that it is a copy of.
    """

    member: Array
    base: Array

    def within(self, bound: float, values: Array) -> Copies:
        """Those whose distance to their base, in ``values``, is at most ``bound`` of it."""
        x, y = values[self.member], values[self.base]
        return self.only(np.abs(x - y) <= bound * np.abs(y))

    def close(self, values: Array) -> Copies:
        """Those that lie close to their base in ``values``."""
        return self.within(SMALL, values)

    def many(self, values: Array) -> Copies:
        """Those of which ``values`` hold many different copies of one number, as for a fit."""
        offset = values[self.member] - values[self.base]
        order = np.lexsort((offset.imag, offset.real, self.base))
        base, sorted_offset = self.base[order], offset[order]
        size = np.abs(values[base])
        is_new = np.ones(len(base), bool)
        is_new[1:] = (np.diff(base) > 0) | (np.abs(np.diff(sorted_offset)) > EXACT * size[1:])
        bases, counts = np.unique(base[is_new], return_counts=True)
        return self.only(np.isin(self.base, bases[counts >= MANY]))

    def of(self, inputs: Array, values: Array) -> Copies:
        """Those whose base, in ``values``, is one of ``inputs``: what the arguments hold."""
        return self.only(np.isin(values[self.base], inputs))

    def joined(self, other: Copies) -> Copies:
        """These and ``other``; of what is in both, what these say. Their bases are not put back."""
        more = ~np.isin(other.member, self.member) & ~np.isin(other.member, self.base)
        member = np.concatenate([self.member, other.member[more]])
        base = np.concatenate([self.base, other.base[more]])
        order = np.argsort(member)
        return Copies(member[order], base[order])

    def only(self, chosen: Array) -> Copies:
        """Those that are ``chosen``."""
        return Copies(self.member[chosen], self.base[chosen])


NONE = Copies(np.zeros(0, np.int64), np.zeros(0, np.int64))


@dataclass(frozen=True)
class _Moving:
    """Numbers that depend on what was moved: their indices, values and both changes."""

    index: Array
    value: Array
    first: Array
    second: Array

    def real(self) -> _Moving:
        """Those that change in their real part alone; the changes as real numbers."""
        # A constant imaginary part, or none; or a step so small that it is beyond the 64 bits.
        most = np.maximum(np.abs(self.first.imag), np.abs(self.second.imag))
        chosen = most <= 4 * EPS * np.abs(self.value)
        return _Moving(
            self.index[chosen],
            self.value[chosen],
            self.first.real[chosen],
            self.second.real[chosen],
        )


def shifted(run: Seen, moved: tuple[Seen, Seen]) -> Copies:
    """Numbers that change in both runs by just as much as an earlier one: x + h.

    Args:
        run: its inputs as they are.
        moved: two runs whose inputs differ a little.
    """
    m = _moving(run, moved).real()
    return _copies(m, _groups((m.first, m.second), 8 * EPS * np.abs(m.value)))


def scaled(run: Seen, moved: tuple[Seen, Seen]) -> Copies:
    """Numbers that change in the same proportion as an earlier one: x (1 + h).

    Args:
        run, moved: as for `shifted`.
    """
    m = _moving(run, moved)
    first, second = m.first / m.value, m.second / m.value
    label = _groups((first.real, second.real), np.full(len(m.index), 8 * EPS))
    turned = np.maximum(np.abs(first.imag), np.abs(second.imag)) > EXACT * np.abs(first) + 8 * EPS
    alone = label.max(initial=0) + 1 + np.arange(len(label))
    return _copies(m, np.where(turned, alone, label))


def nearby(run: Seen, moved: tuple[Seen, Seen], inputs: Array) -> Copies:
    """Numbers that lie close to one of the arguments' and change by nearly as much.

    Args:
        run, moved: as for `shifted`.
        inputs: the numbers that the arguments hold.
    """
    m = _moving(run, moved).real()
    given = np.flatnonzero(np.isin(m.value, inputs))
    given = given[np.unique(m.value[given], return_index=True)[1]]  # the first of each, sorted
    base = np.full(len(m.index), -1, np.int64)
    if len(given):
        place = np.searchsorted(m.value.real[given], m.value.real)
        best = np.full(len(m.index), NEAR)
        for k in range(-NEIGHBORS, NEIGHBORS):
            y = given[np.clip(place + k, 0, len(given) - 1)]
            apart = np.abs(m.value - m.value[y]) / np.abs(m.value[y])
            for change in (m.first, m.second):
                apart = np.maximum(apart, np.abs(change / change[y] - 1))
            better = (apart < best) & (y < np.arange(len(y)))
            best[better], base[better] = apart[better], y[better]
    found = np.where(base < 0, np.arange(len(base)), base)
    return _others(m, found)


def _moving(run: Seen, moved: tuple[Seen, Seen]) -> _Moving:
    v = run.values
    first, second = (each.at(run) - v for each in moved)
    noise = 1e4 * EPS * np.abs(v)
    index = np.flatnonzero((np.abs(first) > noise) & (np.abs(second) > noise) & (v != 0))
    return _Moving(index, v[index], first[index], second[index])


def _groups(keys: tuple[Array, ...], noise: Array) -> Array:
    """A number for each, the same where all keys follow one another closely.

    Args:
        keys: to compare.
        noise: absolute, what the keys may differ by besides a relative `EXACT`.
    """
    label = np.zeros(len(noise), np.int64)
    for key in keys:
        order = np.lexsort((key, label))
        allowed = EXACT * np.abs(key[order]) + noise[order]
        apart = np.diff(key[order]) > np.maximum(allowed[1:], allowed[:-1])
        apart |= np.diff(label[order]) > 0
        label = np.empty_like(label)
        label[order] = np.cumsum(np.concatenate([[False], apart])[: len(order)])
    return label


def _copies(m: _Moving, label: Array) -> Copies:
    """Each with the earliest of its group, where its value is another."""
    earliest = np.full(int(label.max(initial=0)) + 1, len(m.index), np.int64)
    np.minimum.at(earliest, label, np.arange(len(label)))
    return _others(m, earliest[label])


def _others(m: _Moving, base: Array) -> Copies:
    x, y = m.value, m.value[base]
    # Rounding makes no copy; an imaginary part does, however small.
    is_other = (np.abs(x.real - y.real) > SAME * np.abs(y)) | (x.imag != y.imag)
    return Copies(m.index[is_other], m.index[base[is_other]])

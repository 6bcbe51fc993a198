"""Replays recorded calls of the core with damaged arguments, in a process that may die of it.

    python -m support.core_replay SEED LAST [FIRST]

Before a call it prints which one, so that the last line says where a crash came from; after a call
that ends in neither a result nor a typed error it prints a line that begins with `BAD`.
"""

from __future__ import annotations

import re
import sys
import warnings
from collections import defaultdict
from typing import Any

import numpy as np
from photograd_course.errors import Error

from support.core_record import Call, copied, member_name, members, recorded
from support.core_workload import PARTS
from support.memory_limit import limit_memory

MEMORY = 6 << 30
AMOUNTS = {"count", "spp", "steps", "channels"}
"""Work that a caller asks for: larger numbers take longer, and that is all."""
NUMBERS = (0.0, -1.0, 0.5, 1e20, -1e20, 1e38, 1e-40, 1e300, -1e-7, 3e9, np.nan, np.inf, -np.inf)
WHOLE = (0, 1, -1, 2, 3, 7, 100, -(2**31), 2**31 - 1, 2**32 - 1, 2**63 - 1, 2**64 - 1, 10**30)
SMALL = (0, 1, 2, 3, -1, 2**64)
UNFIT = re.compile("incompatible (function|constructor) arguments")
DTYPES = (np.float32, np.float64, np.int32, np.uint8, np.int64, np.bool_, np.complex64, object)


def damaged_array(array: np.ndarray[Any, Any], g: np.random.Generator) -> Any:
    """Other numbers, or the same ones in an array that is not what was asked for."""
    kind = g.integers(10)
    if kind < 5 and array.size and array.dtype.kind in "fiu":
        return with_other_numbers(array.copy(), g)
    if kind == 5:
        return array[: int(g.integers(0, 2)) if array.ndim else None].copy()
    if kind == 6:
        return [array[..., None], array.ravel(), array[None]][int(g.integers(3))]
    if kind == 7:
        return array.astype(DTYPES[int(g.integers(len(DTYPES)))])
    if kind == 8:
        locked = array.copy()
        locked.flags.writeable = False
        return locked
    return strange_memory(array, g)


def with_other_numbers(array: Any, g: np.random.Generator) -> Any:
    """One number, a few or all of them replaced."""
    flat = array.reshape(-1)
    size = flat.size if g.random() < 0.2 else int(g.integers(1, min(flat.size, 4) + 1))
    at = g.permutation(flat.size)[:size]
    with np.errstate(all="ignore"):
        if array.dtype.kind == "f":
            flat[at] = np.array(NUMBERS[int(g.integers(len(NUMBERS)))]).astype(array.dtype)
        else:
            least, most = np.iinfo(array.dtype).min, np.iinfo(array.dtype).max
            values = [least, most, most // 2, 0, 1, min(1000, most), max(-1, least)]
            flat[at] = values[int(g.integers(len(values)))]
    return array


def strange_memory(array: Any, g: np.random.Generator) -> Any:
    """The same numbers, but strided, in the other order of bytes, or not aligned."""
    kind = g.integers(3)
    if kind == 0:
        return np.repeat(array, 2, axis=-1)[..., ::2] if array.ndim else array
    if kind == 1:
        return array.astype(array.dtype.newbyteorder())
    if array.dtype == object:
        return array
    raw = np.zeros(array.nbytes + 1, np.uint8)
    shifted = raw[1:].view(array.dtype).reshape(array.shape)
    shifted[...] = array
    return shifted


class Damage:
    """Draws damage from a seed; objects are swapped for others of their type that were made."""

    def __init__(self, calls: list[Call]) -> None:
        self.pool: dict[type, list[Any]] = defaultdict(list)
        for call in calls:
            self.keep(call.result)

    def keep(self, made: Any) -> None:
        """Remember an object of the core as an argument for others."""
        if type(made).__module__ == "photograd._core":
            self.pool[type(made)].append(made)

    def value(self, value: Any, name: str, g: np.random.Generator) -> Any:
        """Something else in its place."""
        if isinstance(value, np.ndarray):
            return None if g.random() < 0.02 else damaged_array(value, g)
        if isinstance(value, bool) or value is None:
            return [True, False, None, np.zeros(3)][int(g.integers(4))]
        if isinstance(value, int):
            some = SMALL if name in AMOUNTS else WHOLE
            return some[int(g.integers(len(some)))]
        if isinstance(value, float):
            return float(NUMBERS[int(g.integers(len(NUMBERS)))])
        if isinstance(value, str):
            return ["", "\0", "lambert", "x" * 300, value + "+alpha"][int(g.integers(5))]
        if isinstance(value, list | tuple) and value:
            return self.row(value, name, g)
        others = self.pool[type(value)]
        return others[int(g.integers(len(others)))] if others else None

    def row(self, value: Any, name: str, g: np.random.Generator) -> Any:
        """An entry damaged, mostly; or one lost, doubled, or all of them gone."""
        entries = list(value)
        at = int(g.integers(len(entries)))
        kind = g.integers(8)
        if kind == 0:
            entries.clear()
        elif kind == 1:
            del entries[at]
        elif kind == 2:
            entries.insert(at, entries[at])
        else:
            entries[at] = self.value(entries[at], name, g)
        return type(value)(entries)

    def call(self, call: Call, g: np.random.Generator) -> tuple[list[Any], str]:
        """Arguments, one or two of them damaged, and what they are now."""
        arguments = copied(call.arguments)
        if not arguments:
            return arguments, ""
        told = []
        for _ in range(int(g.integers(1, 3))):
            at = int(g.integers(len(arguments)))
            name = call.names[at] if at < len(call.names) else str(at)
            arguments[at] = self.value(arguments[at], name, g)
            told.append(f"{name}={short(arguments[at])}")
        return arguments, ", ".join(told)


def short(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape} {str(value).splitlines()[0][:60]}"
    return " ".join(repr(value).split())[:200]


def fault(failure: Exception) -> str | None:
    """What is wrong with an error; None if it is a typed one, or says that types do not match.

    The latter is pybind11's own: the core is private, and its faces look at types before.
    """
    text = str(failure)
    if isinstance(failure, Error):
        return None if ": expected " in text and ", got " in text else "another form"
    unfit = isinstance(failure, TypeError) and UNFIT.search(text)
    return None if unfit else "not a typed error"


def say(line: str) -> None:
    """Print it, and at once: the next call may be the last."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def replay(seed: int, last: int, first: int = 0) -> None:
    """Make damaged calls number `first` to `last`, and say so."""
    warnings.simplefilter("ignore")
    with recorded() as calls:
        for part in PARTS:
            part()
    known = {call.name for call in calls}
    if missing := sorted({member_name(owner, name) for owner, name, _ in members()} - known):
        say(f"BAD functions that the workload does not call: {missing}")
    limit_memory(MEMORY)
    damage = Damage(calls)
    for number in range(first, last):
        g = np.random.default_rng([seed, number])
        call = calls[int(g.integers(len(calls)))]
        arguments, told = damage.call(call, g)
        say(f"{number} {call.name}: {told}")
        try:
            result = call.function(*arguments)
        except Exception as failure:
            if wrong := fault(failure):
                line = " ".join(f"{type(failure).__name__}: {failure}".split())
                say(f"BAD {wrong}: {line[:300]}")
        else:
            damage.keep(result)
    say(f"made {last} calls")


if __name__ == "__main__":
    replay(*map(int, sys.argv[1:]))

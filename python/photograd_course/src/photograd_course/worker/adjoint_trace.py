"""What the probes see while a function runs, and values that are put back.

Recorded are numbers and arrays of them, in order. A later run of equal calls can put other values
in the place of some: into the array itself where that can be written to, so that all names of it
see them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .adjoint_probes import Place
from .adjoint_types import dual, overloads, payload

MOST_NUMBERS = 150_000
SIMPLE = frozenset(
    (bool, int, str, bytes, list, tuple, dict, set, frozenset, type(None), range, slice)
)
Array = np.ndarray[Any, np.dtype[Any]]
Puts = dict[tuple[int, int], tuple[int, Array, Array, Array, Array]]


class TooMuchToKeep(BaseException):
    """The probes of a run see more numbers than are kept; no `except Exception` takes this."""


class Trace:
    """The probe: a function of a place and a value that returns the value."""

    def __init__(self, places: Sequence[Place], puts: Mapping[str, Array] | None = None) -> None:
        """Record, or put values back.

        Args:
            places: of the probes.
            puts: None, or "places", "turns", "sizes" and "counts" (of records), and for all
                records one after another "positions" in a record, "slots", "is_put" (the number
                there is put back to what the slot holds, else the slot holds it from there on) and
                what is "added".
        """
        self._all = places
        self._turns: dict[int, int] = {}
        self._places: list[int] = []
        self._kept: list[Array] = []
        self._numbers = 0
        self._puts = None if puts is None else _by_turn(puts)
        self._held = np.full(0 if puts is None else int(puts["slots"].max(initial=-1)) + 1, np.nan)
        self._types: dict[int, str] = {}

    def __call__(self, place: int, value: Any) -> Any:
        """The ``value``, after a look at it for the probe at ``place``."""
        kind = type(value)
        if kind in SIMPLE:
            return value
        if isinstance(value, (float, complex, np.inexact)):
            return self._number(place, value)
        if isinstance(value, np.ndarray):
            if value.dtype.kind in "fc":
                return self._array(place, value, value)
            if value.dtype.kind == "O":
                return self._objects(place, value)
        elif overloads(value):
            self._note(place, value)
        return value

    def _number(self, place: int, value: Any) -> Any:
        put = self._look(place, np.array([value]))
        if put is None:
            return value
        number = put[1][0].real
        return float(number) if type(value) in (float, complex) else np.float64(number)

    def _array(self, place: int, value: Array, numbers: Array) -> Array:
        put = self._look(place, numbers)
        if put is not None:
            value = value if value.flags.writeable else value.copy()
            value.flat[put[0]] = put[1]
        elif overloads(value):
            self._note(place, value)
        return value

    def _objects(self, place: int, value: Array) -> Array:
        for each in value.flat:
            if overloads(each):
                self._note(place, each)
                return value
        try:
            return self._array(place, value, value.astype(np.complex128))
        except (TypeError, ValueError):
            return value  # it holds no numbers

    def _note(self, place: int, value: Any) -> None:
        is_made = self._all[place][2]
        if is_made and place not in self._types and (said := dual(value)):
            self._types[place] = said
        self._look(place, payload(value) if place in self._types else np.zeros(0))

    def _look(self, place: int, numbers: Array) -> tuple[Array, Array] | None:
        """Record the numbers, or say which to put where."""
        turn = self._turns.get(place, 0)
        self._turns[place] = turn + 1
        if self._puts is not None:
            return self._slotted(place, turn, numbers)
        self._numbers += numbers.size
        if self._numbers > MOST_NUMBERS:
            raise TooMuchToKeep
        self._places.append(place)
        self._kept.append(np.array(numbers, copy=True).ravel())
        return None

    def _slotted(self, place: int, turn: int, numbers: Array) -> tuple[Array, Array] | None:
        assert self._puts is not None
        found = self._puts.get((place, turn))
        if found is None or found[0] != numbers.size:
            return None
        _, positions, slots, is_put, added = found
        held = ~is_put
        self._held[slots[held]] = numbers.flat[positions[held]].real
        known = is_put & ~np.isnan(self._held[slots])
        values = self._held[slots[known]] + added[known]
        return (positions[known], values) if known.any() else None

    def to_frame(self) -> dict[str, Any]:
        """What was recorded, with the places of the probes.

        Returns:
            "places", "sizes", "re" and "im" of the records; "types" that carry derivatives, each
            with its first place; "lines" and "file_of" of all probes, and the "files" by name.
        """
        files = list(dict.fromkeys(file for file, _, _ in self._all))
        flat = np.concatenate([np.zeros(0), *self._kept])
        re = np.asarray(flat.real, np.float64)
        # What a longer type holds beyond 64 bits is another part of the number, too.
        im = flat.imag if flat.dtype.kind == "c" else flat - re
        return {
            "places": np.array(self._places, np.int32),
            "sizes": np.array([each.size for each in self._kept], np.int32),
            "re": re,
            "im": np.asarray(im, np.float64),
            "lines": np.array([line for _, line, _ in self._all], np.int32),
            "file_of": np.array([files.index(file) for file, _, _ in self._all], np.int32),
            "files": files,
            "types": [[place, said] for place, said in self._types.items()],
        }


def _by_turn(puts: Mapping[str, Array]) -> Puts:
    ends = np.cumsum(puts["counts"])
    begins = ends - puts["counts"]
    heads = zip(puts["places"], puts["turns"], puts["sizes"], begins, ends, strict=True)
    return {
        (int(place), int(turn)): (
            int(size),
            puts["positions"][begin:end],
            puts["slots"][begin:end],
            puts["is_put"][begin:end],
            puts["added"][begin:end],
        )
        for place, turn, size, begin, end in heads
    }

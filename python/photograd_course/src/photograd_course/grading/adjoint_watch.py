"""Runs of an adjoint under watch, and what they prove.

A check's calls are remembered. Once it has passed, the worker repeats one or two of them in code
with probes: with the arguments as they are, with each argument moved by a millionth, and with the
shifted copies that this shows put back (`adjoint_evidence`). Evidence counts if it is there again
for arguments a percent away.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from ..worker.layouts import laid_out
from .adjoint_evidence import Change, Kinds, Stage, changes, puts_back, stages
from .cost import agree
from .failures import StudentFailure
from .shifted_copies import Seen, nearby, scaled, shifted
from .trial import Breach, Student

MOVE = 2.0**-20  # relative: so small that nothing is sorted, rounded or cut otherwise
AWAY = 1e-2
MAX_BYTES = 1 << 18  # bytes of arguments that are remembered
CALLS = 2  # watched in a check
TRIES = 4  # of which some may show more numbers than are kept
SECONDS = 20.0
DIFFERENCED = "is a quotient of shifted evaluations"
OTHER = "another answer"
# Of a repeated call, by the reason of its failure.
OTHERWISE = {
    "raised": "raises an exception only while it is watched",
    OTHER: "gives another answer while it is watched",
}
Array = np.ndarray[Any, np.dtype[Any]]


@dataclass(frozen=True)
class Call:
    """A call that a check has made.

    Attributes:
        function: "module.function".
        args: copies.
        answer: what came back.
    """

    function: str
    args: Sequence[Any]
    answer: Any

    @property
    def size(self) -> int:
        """Bytes of the arrays among the arguments."""
        return sum(each.nbytes for each in _arrays(list(self.args)))


@dataclass
class Remembering:
    """A student whose calls of some functions are remembered; see `Student`."""

    student: Student
    functions: Sequence[str]
    calls: list[Call] = field(default_factory=list)

    @property
    def breaches(self) -> Mapping[str, Breach]:
        """See Student."""
        return self.student.breaches

    def call(self, function: str, args: Sequence[Any], *, seconds: float) -> Any:
        """See Student for function, args and seconds."""
        module, _, name = function.rpartition(".")
        if name not in self.functions and module != "adapters":
            return self.student.call(function, args, seconds=seconds)
        kept = Call(function, laid_out(list(args), "plain"), None)
        answer = self.student.call(function, args, seconds=seconds)
        if kept.size <= MAX_BYTES:
            self.calls.append(Call(function, kept.args, answer))
        return answer

    def look(
        self, function: str, args: Sequence[Any], *, seconds: float, layout: str
    ) -> tuple[Any, Any]:
        """See Student for function, args, seconds and layout."""
        return self.student.look(function, args, seconds=seconds, layout=layout)

    def watch(
        self, function: str, args: Sequence[Any], puts: Any, *, seconds: float
    ) -> tuple[Any, Any] | None:
        """See Student for function, args, puts and seconds."""
        return self.student.watch(function, args, puts, seconds=seconds)

    def cpu_seconds(self) -> float | None:
        """See Student."""
        return self.student.cpu_seconds()

    def close(self) -> None:
        """See Student."""
        self.student.close()


def find_breach(remembered: Remembering) -> tuple[Breach | None, str]:
    """What to say of a derivative that is computed; None where there is no evidence.

    What cannot be watched (too many numbers, an exception, another answer than before) is no
    evidence. Of functions that behave otherwise under watch, the second text tells staff.

    Args:
        remembered: the student of a check that has passed.
    """
    watched, otherwise = 0, ""
    for call in _chosen(remembered.calls)[:TRIES]:
        try:
            found = Session(remembered.student, call).verdict()
        except (StudentFailure, Unwatched) as failure:
            if said := OTHERWISE.get(getattr(failure, "reason", str(failure)), ""):
                otherwise = otherwise or f"{call.function.rpartition('.')[2]} {said}"
            continue
        if found is not None:
            return found, ""
        watched += 1
        if watched == CALLS:
            break
    return None, otherwise


def _chosen(calls: Sequence[Call]) -> list[Call]:
    """The first, then the others from the largest on: a derivative may depend on the size."""
    others = sorted(calls[1:], key=lambda call: -call.size)
    return [*calls[:1], *others]


class Unwatched(Exception):
    """A call about which its probes say nothing."""


class Session:
    """One call, repeated under watch."""

    def __init__(self, student: Student, call: Call) -> None:
        self._student, self._call = student, call

    def verdict(self) -> Breach | None:
        """The evidence of this call, found twice, as a sentence.

        Raises:
            Unwatched, StudentFailure: nothing can be said.
        """
        found = self._evidence(self._call.args, self._call.answer)
        if found is None:
            return None
        rng = np.random.default_rng(1)
        away = _moved(self._call.args, lambda value: value * (1 - AWAY * float(rng.random())))
        again = self._evidence(away, None)
        if again is None or not {c.part for c in found.changes} & {c.part for c in again.changes}:
            return None
        name = self._call.function.rpartition(".")[2]
        said = f"{name} {found.said} ({found.place[0]}, line {found.place[1]})"
        return f"{said}: write its derivative", found.place

    def _evidence(self, args: Sequence[Any], answer: Any) -> _Evidence | None:
        with np.errstate(all="ignore"):
            return _Runs(self._student, self._call.function, args, answer).evidence()


@dataclass(frozen=True)
class _Evidence:
    said: str
    place: tuple[str, int]
    changes: Sequence[Change]


class _Runs:
    """The runs for one set of arguments."""

    def __init__(self, student: Student, function: str, args: Sequence[Any], answer: Any) -> None:
        self._student, self._function, self._args = student, function, list(args)
        self._answer, frame = self._run(self._args, None)
        if answer is not None and not agree(self._answer, answer):
            raise Unwatched(OTHER)
        self._seen, self._frame = _seen(frame), frame

    def evidence(self) -> _Evidence | None:
        """What the probes prove, if anything."""
        places = [k for k, arg in enumerate(self._args) if _floats(arg).size]
        moved = self._moved(places)
        if moved is None:
            raise Unwatched
        if (typed := self._typed(moved)) is not None:
            return typed
        for stage in stages(self._seen.values, self._copies(places, moved)):
            if changed := self._changed(stage):
                return _Evidence(DIFFERENCED, self._place(stage, changed), changed)
        return None

    def _copies(self, places: Sequence[int], moved: tuple[Seen, Seen]) -> Kinds:
        """What is a copy of what: close to an argument's number also by a step made of others.

        In other numbers that is no step: a sum of two parts, of which one moves.
        """
        seen, values, inputs = self._seen, self._seen.values, _floats(self._args)
        other = nearby(seen, moved, inputs)
        for k in places if len(places) > 1 else ():
            if (alone := self._moved([k])) is not None:
                found = shifted(seen, alone).of(inputs, values)
                other = found.close(values).joined(other)
        return Kinds(shifted(seen, moved), scaled(seen, moved), other, inputs)

    def _changed(self, stage: Stage) -> list[Change]:
        """The parts of the answer that change in each of the stage's runs; none if one raises."""
        common: list[Change] = []
        for k, offset in enumerate(stage.offsets):
            puts = puts_back(self._seen, stage.copies, offset)
            try:
                answer, _ = self._run(self._args, puts)
            except StudentFailure:
                return []
            found = changes(self._answer, answer, stage)
            parts = {each.part for each in found}
            common = found if k == 0 else [each for each in common if each.part in parts]
            if not common:
                return []
        return common

    def _place(self, stage: Stage, changed: Sequence[Change]) -> tuple[str, int]:
        """The line without whose shifts the answer would not change, by bisection."""
        records = self._seen.record_of(stage.copies.member)
        numbers = np.asarray(self._frame["lines"])[self._seen.places[records]]
        lines = list(dict.fromkeys(numbers.tolist()))
        parts = {each.part for each in changed}
        low, high = 0, len(lines) - 1
        while low < high:
            middle = (low + high) // 2
            chosen = np.isin(numbers, lines[: middle + 1])
            found = self._changed(stage.only(chosen))
            low, high = (low, middle) if parts & {c.part for c in found} else (middle + 1, high)
        record = records[numbers == lines[low]][0]
        return self._where(int(self._seen.places[record]))

    def _where(self, place: int) -> tuple[str, int]:
        names, files = self._frame["files"], self._frame["file_of"]
        return str(names[int(files[place])])[:80], int(self._frame["lines"][place])

    def _typed(self, moved: tuple[Seen, Seen]) -> _Evidence | None:
        """A type that carries derivatives, in a value that depends on the arguments."""
        change = moved[0].at(self._seen) != self._seen.values
        records = np.unique(self._seen.record_of(np.flatnonzero(change)))
        moving = {int(place) for place in self._seen.places[records]}
        for place, said in self._frame["types"]:
            if place in moving:
                return _Evidence(str(said)[:120], self._where(place), [Change((), 1.0)])
        return None

    def _moved(self, places: Sequence[int]) -> tuple[Seen, Seen] | None:
        """What two runs see whose arguments at these places are moved a little."""
        found = []
        for seed in (1, 2):
            rng = np.random.default_rng([seed, *places])
            args = list(self._args)
            for k in places:
                args[k] = _moved(args[k], partial(_by_a_millionth, rng))
            try:
                found.append(_seen(self._run(args, None)[1]))
            except StudentFailure:
                return None
        return found[0], found[1]

    def _run(self, args: Sequence[Any], puts: Any) -> tuple[Any, Any]:
        reply = self._student.watch(self._function, args, puts, seconds=SECONDS)
        if reply is None:
            raise Unwatched
        return reply


def _seen(frame: Any) -> Seen:
    try:
        return Seen.of(frame)
    except (ValueError, TypeError, KeyError, IndexError, OverflowError):
        raise Unwatched from None


def _by_a_millionth(rng: np.random.Generator, value: Any) -> Any:
    return value * (1 - MOVE * rng.random(np.shape(value)))


def _moved(value: Any, move: Callable[[Any], Any]) -> Any:
    """The same with every number and array of float64 moved."""
    if isinstance(value, float):
        return float(move(value))
    if isinstance(value, np.ndarray) and value.dtype == np.float64:
        return np.asarray(move(value), np.float64)
    if isinstance(value, (list, tuple)):
        return [_moved(each, move) for each in value]
    if isinstance(value, dict):
        return {key: _moved(each, move) for key, each in value.items()}
    return value


def _arrays(value: Any) -> Iterator[Array]:
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, float):
        yield np.array([value])
    elif isinstance(value, (list, tuple, dict)):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _arrays(each)


def _floats(value: Any) -> Array:
    """All numbers of float64 in a value, one after another."""
    arrays = [each.ravel() for each in _arrays(value) if each.dtype == np.float64]
    return np.concatenate([np.zeros(0), *arrays])

"""Is the check itself strong enough? Wrong backward functions, made automatically, that must die.

A test suite for gradients is only worth what it rejects. From one right backward function these
wrong ones are made, for every gradient and every cotangent (test kind T10): zero, negated, twice,
channels permuted, one cotangent dropped, and, for functions that add into buffers, overwritten. A
mutant that changes nothing proves nothing, and is an error.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .errors import RangeError, message
from .gradcheck.probes import (
    AccumulatingBackward,
    Arrays,
    Backward,
    Outputs,
    call_backward,
    copy_outputs,
    copy_parameters,
)

Change = Callable[[Any], Any]

CHANGES: dict[str, Change] = {
    "zero": np.zeros_like,
    "negate": np.negative,
    "twice": lambda gradient: 2.0 * gradient,
    "permute": lambda gradient: np.roll(gradient, 1, axis=-1),
}


@dataclass(frozen=True)
class Mutant:
    """One wrong backward function and the name of what is wrong with it."""

    name: str
    backward: Backward


@dataclass(frozen=True)
class AccumulatingMutant:
    """One wrong accumulating backward function and the name of what is wrong with it."""

    name: str
    accumulate: AccumulatingBackward


@dataclass(frozen=True)
class MutantReport:
    """Which mutants a checker rejected; true only if there were some and all of them died."""

    killed: tuple[str, ...]
    survived: tuple[str, ...]

    @property
    def passed(self) -> bool:
        """Whether there were mutants and none survived."""
        return len(self.killed) > 0 and len(self.survived) == 0

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        total = len(self.killed) + len(self.survived)
        head = f"{len(self.killed)} of {total} mutants killed"
        return "\n".join([head, *(f"  SURVIVED: {name}" for name in self.survived)])


def make_mutants(
    backward: Backward, parameters: Mapping[str, Any], d_outputs: Outputs
) -> tuple[Mutant, ...]:
    """All automatic mutants of a backward function.

    Args:
        backward: `backward(parameters, d_outputs)` returns {group: gradient}.
        parameters, d_outputs: a generic place at which each mutant must differ from the original:
            random values, no zeros, no symmetry.

    Returns:
        zero, negate and twice for each group; permute (last axis rolled by one) for each group
        whose last axis is longer than one; a dropped cotangent for each named output, or for
        channel 0 of the last axis of a single array.

    Raises:
        RangeError: a mutant returns exactly what the original returns.
    """
    base = copy_parameters("make_mutants", parameters)
    right = call_backward("make_mutants", backward, base, d_outputs)
    mutants = []
    for group, gradient in right.items():
        for name, change in CHANGES.items():
            if name == "permute" and (gradient.ndim == 0 or gradient.shape[-1] < 2):
                continue
            mutants.append(Mutant(f"{name} {group}", _changed(backward, group, change)))
    for label, drop in _drops(d_outputs):
        mutants.append(Mutant(f"drop cotangent {label}", _dropped(backward, drop)))
    for mutant in mutants:
        wrong = call_backward("make_mutants", mutant.backward, base, d_outputs)
        _require_change(mutant.name, right, wrong)
    return tuple(mutants)


def overwriting_mutants(
    accumulate: AccumulatingBackward, parameters: Mapping[str, Any], d_outputs: Outputs
) -> tuple[AccumulatingMutant, ...]:
    """For each group, an accumulating backward that assigns to the buffer instead of adding.

    Raises:
        RangeError: the gradient of a group is zero, or a mutant changes nothing.
    """
    base = copy_parameters("overwriting_mutants", parameters)
    mutants = []
    for group in base:
        mutant = AccumulatingMutant(f"overwrite {group}", _overwriting(accumulate, group))
        results = []
        for function in (accumulate, mutant.accumulate):
            buffers = {name: np.ones_like(value) for name, value in base.items()}
            function(base, copy_outputs(d_outputs), buffers)
            results.append(buffers)
        _require_change(mutant.name, results[0], results[1])
        mutants.append(mutant)
    return tuple(mutants)


def check_mutants(
    checker: Callable[[Backward], object],
    backward: Backward,
    parameters: Mapping[str, Any],
    d_outputs: Outputs,
) -> MutantReport:
    """Give the original and every automatic mutant to a checker.

    Args:
        checker: takes a backward function and returns a report or bool, true when it passes; for
            example `lambda b: check_gradient(function, b, parameters, seed=1)`.
        backward, parameters, d_outputs: as for `make_mutants`.

    Raises:
        RangeError: the checker rejects the original, or a mutant changes nothing.
    """
    mutants = make_mutants(backward, parameters, d_outputs)
    _require_right("check_mutants", checker(backward))
    return _verdicts([(mutant.name, bool(checker(mutant.backward))) for mutant in mutants])


def check_overwriting_mutants(
    checker: Callable[[AccumulatingBackward], object],
    accumulate: AccumulatingBackward,
    parameters: Mapping[str, Any],
    d_outputs: Outputs,
) -> MutantReport:
    """The same for mutants that overwrite their buffers; `checker` is often `check_accumulation`.

    Raises:
        RangeError: the checker rejects the original, or a mutant changes nothing.
    """
    mutants = overwriting_mutants(accumulate, parameters, d_outputs)
    _require_right("check_overwriting_mutants", checker(accumulate))
    return _verdicts([(mutant.name, bool(checker(mutant.accumulate))) for mutant in mutants])


def _changed(backward: Backward, group: str, change: Change) -> Backward:
    def mutant(parameters: Arrays, d_outputs: Outputs) -> Mapping[str, Any]:
        gradients = dict(backward(parameters, d_outputs))
        gradients[group] = change(gradients[group])
        return gradients

    return mutant


def _dropped(backward: Backward, drop: Change) -> Backward:
    return lambda parameters, d_outputs: backward(parameters, drop(copy_outputs(d_outputs)))


def _drops(d_outputs: Outputs) -> list[tuple[str, Change]]:
    if isinstance(d_outputs, Mapping):
        if len(d_outputs) < 2:
            return []
        return [(str(name), _drop_output(name)) for name in d_outputs]
    if np.ndim(d_outputs) > 0 and np.shape(d_outputs)[-1] > 1:
        return [("channel 0", _drop_channel)]
    return []


def _drop_output(name: Any) -> Change:
    return lambda d_outputs: {**d_outputs, name: np.zeros_like(d_outputs[name])}


def _drop_channel(d_output: Any) -> Any:
    d_output[..., 0] = 0.0
    return d_output


def _overwriting(accumulate: AccumulatingBackward, group: str) -> AccumulatingBackward:
    def mutant(parameters: Arrays, d_outputs: Outputs, d_parameters: Arrays) -> None:
        d_parameters[group][...] = 0.0
        accumulate(parameters, d_outputs, d_parameters)

    return mutant


def _require_change(name: str, right: Arrays, wrong: Arrays) -> None:
    if all(np.array_equal(right[group], wrong[group]) for group in right):
        remedy = "test at a generic place, without zeros or symmetry"
        expected = "a mutant that changes a gradient"
        raise RangeError(message("mutants", name, expected, "the original's result", remedy))


def _require_right(caller: str, verdict: object) -> None:
    if not verdict:
        raise RangeError(message(caller, "checker", "to accept the original", f"\n{verdict}"))


def _verdicts(outcomes: list[tuple[str, bool]]) -> MutantReport:
    killed = tuple(name for name, accepted in outcomes if not accepted)
    survived = tuple(name for name, accepted in outcomes if accepted)
    return MutantReport(killed, survived)

"""The price of an adjoint: a few forward calls, where differences pay one for each parameter.

Three ways round it are closed. Answers kept from an earlier call: each timed call gets arguments of
its own, and where the reference is at hand its answer is looked at as well. A forward function that
wastes time, so that all else looks cheap: the reference's forward function sets a second cap. Work
left to processes or threads: what is counted is the processor time of all that belongs to the
submission.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .failures import CheckFailed, TooExpensive
from .specs import Spec
from .tolerance import Tolerance
from .trial import Trial

COST_RATIO = 20.0  # an adjoint costs 2 to 5 forward calls, differences one for each parameter
# Of forward calls of the reference: loops over single numbers cost 98 to 870 of them (toy and 03),
# complex steps for 4,000 parameters 9,000. An honest loop must never fail, hence nearer to those.
REFERENCE_RATIO = 3000.0
SHORTEST = 2e-5  # seconds; below it a call is all overhead
# Under a limit of processor time some kernels count it by their timer, in steps of 4 ms (measured);
# five of them, or this many calls, make one measurement.
LEAST_SECONDS = 0.02
MOST_CALLS = 400
VARIATION = 0.01
CONCLUSIVE = 5.0  # times the cap: what costs so much twice in a row is not measured again
AGREEMENT = 1e-6  # relative; two ways to write the same sum differ by some 1e-15

Call = tuple[str, Sequence[Any], Spec]


def require_cheap(trial: Trial, forward: Call, backward: Call, ratio: float = COST_RATIO) -> None:
    """The backward function must cost at most ``ratio`` forward calls of the same submission.

    Processor time, measured from outside; median of three, and one retry near the cap. Where it
    cannot be measured (a student's machine), nothing is asked. For each call the arrays of float64
    among the arguments are made smaller by up to a percent, each by a factor of its own.

    Args:
        trial: of the check; the arguments should hold 2,000 parameters or more, and 4,000 where
            the second cap is to mean something.
        forward, backward: function name, arguments and spec.
        ratio: the cap.

    Raises:
        TooExpensive: it does not.
        CheckFailed: the answer to a timed call is wrong, or that to an earlier call.
    """
    if trial.cpu_seconds() is None:
        return
    measured, most = 0.0, np.inf
    if (plain := _reference_seconds(trial, forward)) is not None:
        most = REFERENCE_RATIO * max(plain, SHORTEST)
    known = [forward[1]], [backward[1]]
    for _ in range(2):
        once = max(statistics.median([_cost(trial, forward, known[0]) for _ in range(3)]), SHORTEST)
        twice = [_cost(trial, backward, known[1]) for _ in range(2)]
        if min(twice) > CONCLUSIVE * ratio * once:
            measured = min(twice) / once
            break
        back = statistics.median([*twice, _cost(trial, backward, known[1])])
        measured = back / once
        if measured <= ratio and back <= most:
            return
    advice = "an adjoint visits each value about once; finite differences do not count"
    if measured <= ratio:
        raise TooExpensive(
            f"{backward[0]}: costs more than {REFERENCE_RATIO:.0f} forward calls should",
            {"advice": f"{advice}, nor does slowing down {forward[0]}"},
        )
    raise TooExpensive(
        f"{backward[0]}: costs {measured:.0f} forward calls, allowed {ratio:.0f}",
        {"advice": advice},
    )


def _cost(trial: Trial, call: Call, known: list[Sequence[Any]]) -> float:
    """Processor seconds of a call, over as many calls as the clock needs to tell.

    `known` are arguments of earlier calls: the plain ones, the first that were varied, the last.
    """
    function, args, spec = call
    seconds, calls = 0.0, 0
    while seconds < LEAST_SECONDS and calls < MOST_CALLS:
        varied = [_varied(trial, value) for value in args]
        before = trial.cpu_seconds() or 0.0
        answer = trial.call(function, *varied, returns=spec)
        seconds += (trial.cpu_seconds() or 0.0) - before
        calls += 1
        _require_right(trial, function, varied, answer, known)
        known[min(len(known), 2) :] = [varied]
    return seconds / calls


def _varied(trial: Trial, value: Any) -> Any:
    """One factor for a whole array, so that what is sorted stays so, and what is >= 0 too."""
    if isinstance(value, np.ndarray) and value.dtype == np.float64:
        return value * (1.0 - VARIATION * float(trial.rng.random()))
    return value


def _require_right(
    trial: Trial, function: str, args: Sequence[Any], answer: Any, known: Sequence[Sequence[Any]]
) -> None:
    """Raise CheckFailed for a wrong answer; one that is right for arguments in `known` is old."""
    reference = _reference(trial, function, args)
    if reference is None or agree(answer, right := reference(*args)):
        return
    if any(agree(answer, reference(*earlier)) for earlier in known):
        raise CheckFailed(
            f"{function}: returns the answer to an earlier call, whose arguments were others",
            {"advice": "compute it from the arguments each time"},
        )
    require_close(trial, f"{function}, in a call that is timed", answer, right)


def _reference(trial: Trial, function: str, args: Sequence[Any]) -> Callable[..., Any] | None:
    """The solution's function; None where there is none, or a call of it might have effects."""
    if not trial.has_reference or any(callable(value) for value in args):
        return None
    found: Callable[..., Any] | None = getattr(trial.reference, function, None)
    return found


def _reference_seconds(trial: Trial, call: Call) -> float | None:
    function, args, _ = call
    reference = _reference(trial, function, args)
    if reference is None:
        return None
    return statistics.median([_reference_cost(reference, args) for _ in range(3)])


def _reference_cost(reference: Callable[..., Any], args: Sequence[Any]) -> float:
    began, calls = time.process_time(), 0
    while time.process_time() - began < LEAST_SECONDS and calls < MOST_CALLS:
        reference(*args)
        calls += 1
    return (time.process_time() - began) / calls


def require_close(trial: Trial, what: str, got: Any, expected: Any) -> None:
    """Raise CheckFailed for two answers that do not `agree`, naming the part that is wrong."""
    if isinstance(expected, dict) and isinstance(got, dict):
        for name in expected:
            require_close(trial, f"{what}, {name}", got.get(name), expected[name])
    elif isinstance(expected, (tuple, list)) and isinstance(got, (tuple, list)):
        for k, (mine, right) in enumerate(zip(got, expected, strict=True)):
            require_close(trial, f"{what}, item {k}", mine, right)
    elif not agree(got, expected):
        trial.close(what, got, expected, Tolerance(AGREEMENT, "two ways to write the same sum"))
        raise CheckFailed(f"{what}: wrong")


def agree(got: Any, expected: Any) -> bool:
    """Whether two answers to one question are the same but for rounding, whatever they are."""
    if isinstance(expected, dict):
        return isinstance(got, dict) and all(agree(got.get(k), v) for k, v in expected.items())
    if isinstance(expected, (tuple, list)):
        return len(got) == len(expected) and all(map(agree, got, expected))
    if isinstance(expected, (float, int, np.number, np.ndarray)):
        right, answer = np.asarray(expected, np.float64), np.asarray(got, np.float64)
        if right.shape != answer.shape:
            return False
        error = float(np.linalg.norm(answer - right))
        return error <= AGREEMENT * float(np.linalg.norm(right))
    return True  # of another kind: nothing to compare

"""Learning-rate factors as functions of the step: multiply the rate of a group by schedule(step).

Steps count from 0. A schedule that ends keeps its final factor afterwards.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from .checks import require_integer, require_number
from .portable_math import cos, integer_power, power

Schedule = Callable[[int], float]


def constant(factor: float = 1.0) -> Schedule:
    """The same factor at every step."""
    factor = require_number("constant", "factor", factor, least=0.0)

    def at(step: int) -> float:
        _at("constant", step)
        return factor

    return at


def exponential(final: float, steps: int) -> Schedule:
    """From 1 to `final` after `steps`, by the same ratio each step: final^(step / steps).

    Raises:
        RangeError: `final` is not positive, or `steps` is below 1.
    """
    final = require_number("exponential", "final", final, least=0.0, open_ends=True)
    steps = require_integer("exponential", "steps", steps, least=1)

    def factor(step: int) -> float:
        passed = _at("exponential", step) / steps
        return final if passed >= 1.0 else float(power(final, passed))

    return factor


def cosine(steps: int, final: float = 0.0) -> Schedule:
    """Half a cosine from 1 to `final` [Loshchilov2017], without restarts."""
    steps = require_integer("cosine", "steps", steps, least=1)
    final = require_number("cosine", "final", final, least=0.0)

    def factor(step: int) -> float:
        phase = math.pi * min(_at("cosine", step), steps) / steps
        return final + (1.0 - final) * 0.5 * (1.0 + float(cos(phase)))

    return factor


def step_decay(every: int, factor: float) -> Schedule:
    """Multiplied by `factor` after each `every` steps: factor^(step // every)."""
    every = require_integer("step_decay", "every", every, least=1)
    factor = require_number("step_decay", "factor", factor, least=0.0, open_ends=True)
    return lambda step: integer_power(factor, _at("step_decay", step) // every)


def warmup(steps: int, schedule: Schedule) -> Schedule:
    """Another schedule with a linear rise in front: times (step + 1) / steps while step < steps.

    The inner schedule sees the same step, so that its end stays where it was.
    """
    steps = require_integer("warmup", "steps", steps, least=1)
    return lambda step: schedule(step) * min(1.0, (_at("warmup", step) + 1) / steps)


def _at(schedule: str, step: int) -> int:
    return require_integer(schedule, "step", step, least=0)

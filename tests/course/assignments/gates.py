"""Cheats that hold only as far as few checks look: made for any function, by wrapping it.

A gate answers rightly below a limit and wrongly beyond: zeros for many rows or for large values,
the first answer for all arguments of equal shapes, fewer steps than asked for, or more. The limit
comes from a check's subject: half of what its large case has.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

Function = Callable[..., Any]
FAR = 4  # times as large as in any other case is the least that a large case may be


def sizes_of(value: Any, name: str = "") -> dict[str, int]:
    """Lengths and whole numbers in arguments, by where they are; of several the largest."""
    if isinstance(value, np.ndarray):
        return {f"{name}.{axis}": length for axis, length in enumerate(value.shape)}
    if isinstance(value, int) and not isinstance(value, bool):
        return {name: value}
    found: dict[str, int] = {}
    if isinstance(value, (list, tuple)):
        found[f"{name}.len"] = len(value)
        parts: list[tuple[str, Any]] = [
            (f"{name}[]" if name else f"{k}", each) for k, each in enumerate(value)
        ]
    else:
        parts = [(f"{name}.{k}", each) for k, each in value.items()] if is_dict(value) else []
    for place, each in parts:
        for key, size in sizes_of(each, place).items():
            found[key] = max(size, found.get(key, size))
    return found


def is_dict(value: Any) -> bool:
    """Whether it holds others by name."""
    return isinstance(value, Mapping)


def growing(small: Sequence[Any], large: Sequence[Any]) -> dict[str, int]:
    """Limits: half of each size of the large arguments that is FAR times as large, or more."""
    before = sizes_of(tuple(small))
    return {
        key: size // 2
        for key, size in sizes_of(tuple(large)).items()
        if size >= FAR * max(before.get(key, 0), 1)
    }


def zeros_beyond(limits: Mapping[str, int]) -> Callable[[Function], Function]:
    """Zeros where any size is beyond its limit."""

    def gate(function: Function) -> Function:
        def gated(*args: Any) -> Any:
            found = sizes_of(args)
            answer = function(*args)
            return zeroed(answer) if beyond(found, limits) else answer

        return gated

    return gate


def beyond(found: Mapping[str, int], limits: Mapping[str, int]) -> bool:
    """Whether a size exceeds its limit."""
    return any(found.get(key, 0) > limit for key, limit in limits.items())


def remembers_shapes(seed_matters: bool) -> Callable[[Function], Function]:
    """The first answer, for all arguments of equal shapes, and perhaps equal whole numbers."""

    def gate(function: Function) -> Function:
        known: dict[Any, Any] = {}

        def gated(*args: Any) -> Any:
            numbers = [arg for arg in args if seed_matters and isinstance(arg, int)]
            key = shape_of(args), tuple(numbers)
            if key not in known:
                known[key] = function(*args)
            return known[key]

        return gated

    return gate


def shape_of(value: Any) -> Any:
    """What two arguments of equal shapes have in common, for a dict."""
    if isinstance(value, np.ndarray):
        return value.shape
    if isinstance(value, (list, tuple)):
        return tuple(map(shape_of, value))
    if is_dict(value):
        return tuple((key, shape_of(each)) for key, each in value.items())
    return value if isinstance(value, str) else type(value).__name__


def other_steps(place: int, limit: int, more: int) -> Callable[[Function], Function]:
    """Where more steps than the limit are asked for: that many, or ``more`` than asked for.

    Arrays with an entry for each step are cut, or go on with their last entry.
    """

    def gate(function: Function) -> Function:
        def gated(*args: Any) -> Any:
            asked = args[place]
            if not isinstance(asked, int) or asked <= limit:
                return function(*args)
            changed = list(args)
            changed[place] = asked + more if more else limit
            return fitted(function(*changed), changed[place], asked)

        return gated

    return gate


def fitted(answer: Any, made: int, asked: int) -> Any:
    """An answer of so many steps with the shape of one of as many as were asked for."""
    if isinstance(answer, (list, tuple)):
        return type(answer)(fitted(each, made, asked) for each in answer)
    if is_dict(answer):
        return {key: fitted(each, made, asked) for key, each in answer.items()}
    if isinstance(answer, np.ndarray) and answer.ndim and len(answer) in (made, made + 1):
        take = np.minimum(np.arange(asked + len(answer) - made), len(answer) - 1)
        return answer[take]
    return answer


def zeros_of_large_values(place: int, limit: float) -> Callable[[Function], Function]:
    """Zeros where an argument holds a value above the limit."""

    def gate(function: Function) -> Function:
        def gated(*args: Any) -> Any:
            answer = function(*args)
            return zeroed(answer) if largest(args[place]) > limit else answer

        return gated

    return gate


def largest(value: Any) -> float:
    """The largest magnitude in an argument."""
    if isinstance(value, (list, tuple)) or is_dict(value):
        parts = value.values() if is_dict(value) else value
        return max(map(largest, parts), default=0.0)
    if callable(value):
        return 0.0
    return float(np.max(np.abs(value), initial=0.0))


def zeroed(answer: Any) -> Any:
    """An answer of the same form whose numbers are 0."""
    if isinstance(answer, (list, tuple)):
        return type(answer)(map(zeroed, answer))
    if is_dict(answer):
        return {key: zeroed(each) for key, each in answer.items()}
    return answer * 0 if isinstance(answer, (np.ndarray, float, int)) else answer

"""Calls of the compiled core as they happen: every function and method with its arguments."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd._compiled import _core

MOST_ALIKE = 2
"""Calls kept of one function with arguments of the same types."""


@dataclass(frozen=True)
class Call:
    """A call that was made: what, with which arguments, and their names as far as they have some.

    Of methods the object is the first argument; `result` is what came back.
    """

    name: str
    function: Callable[..., Any]
    arguments: list[Any]
    names: list[str]
    result: Any


def copied(value: Any) -> Any:
    """Arrays copied, in lists and tuples too; other objects are the same."""
    if isinstance(value, np.ndarray):
        return value.copy()
    if isinstance(value, list | tuple):
        return type(value)(copied(entry) for entry in value)
    return value


def kinds(value: Any) -> str:
    """Types in a value, of arrays their dtype."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.ndim}"
    if isinstance(value, list | tuple):
        return "(" + ",".join(sorted({kinds(entry) for entry in value})) + ")"
    return type(value).__name__


def parameter_names(text: str | None) -> list[str]:
    """Names of the parameters in the signature with which a docstring of pybind11 begins."""
    head = (text or "").partition(") -> ")[0].partition("(")[2]
    return re.findall(r"(?:^|, )(\w+):", head)


def members() -> Iterator[tuple[Any, str, bool]]:
    """(owner, name, whether it is static) of all functions and methods of the core."""
    for name, value in sorted(vars(_core).items()):
        if isinstance(value, type):
            for own, member in sorted(vars(value).items()):
                static = isinstance(member, staticmethod)
                method = static or type(member).__name__ == "instancemethod"
                if method and (own == "__init__" or not own.startswith("_")):
                    yield value, own, static
        elif callable(value):
            yield _core, name, True


def member_name(owner: Any, name: str) -> str:
    """`march`, `Bvh.trace`."""
    return name if owner is _core else f"{owner.__name__}.{name}"


@contextmanager
def recorded() -> Iterator[list[Call]]:
    """The list to which calls are added as long as the context is open."""
    calls: list[Call] = []
    seen: Counter[str] = Counter()
    originals: list[tuple[Any, str, Any]] = []

    def wrapper(owner: Any, name: str, function: Any) -> Callable[..., Any]:
        label = member_name(owner, name)
        names = parameter_names(function.__doc__)

        def call(*args: Any, **kwargs: Any) -> Any:
            given = dict(zip(names, args, strict=False)) | kwargs
            places = [own for own in names if own in given] if len(args) <= len(names) else []
            values = [given[own] for own in places] if places else list(args)
            before, kind = copied(values), label + kinds(values)
            result = function(*args, **kwargs)
            seen[kind] += 1
            if seen[kind] <= MOST_ALIKE and (places or not kwargs):
                made = owner if name == "__init__" else function
                skip = 1 if name == "__init__" else 0
                answer = values[0] if name == "__init__" else result
                calls.append(Call(label, made, before[skip:], places[skip:], answer))
            return result

        return call

    try:
        for owner, name, static in list(members()):
            original = vars(owner)[name]
            originals.append((owner, name, original))
            made = wrapper(owner, name, getattr(owner, name))
            setattr(owner, name, staticmethod(made) if static and owner is not _core else made)
        yield calls
    finally:
        for owner, name, original in originals:
            setattr(owner, name, original)

"""Checks that several packages share: finite renderings, and dataclasses of plain values.

What a JSON text held may be of any type; `from_plain` makes a dataclass of it or says which field
is wrong. Ranges are the business of the dataclass itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from photograd._arrays import Arguments, shortened
from photograd.errors import DtypeError, Error, RangeError, message

NameOfIndex = Callable[[tuple[int, ...]], str]


def require_finite(
    function: str, outputs: Mapping[str, NDArray[Any] | None], name_of: NameOfIndex
) -> None:
    """Check what a renderer returns.

    Args:
        function: the renderer, for the error.
        outputs: arrays by name; None is skipped.
        name_of: what an index of an array is called, such as a pixel.

    Raises:
        Error: an array with NaN or infinity, and where the first one is.
    """
    for name, array in outputs.items():
        if array is None:
            continue
        with np.errstate(over="ignore", invalid="ignore"):
            if np.isfinite(array.sum()):  # one pass; the sum alone may overflow, too
                continue
        bad = np.argwhere(~np.isfinite(array))
        if len(bad):
            got = f"{len(bad)} that are not, the first in {name_of(tuple(bad[0].tolist()))}"
            remedy = "a parameter holds NaN, infinity, or a number too large to add up"
            raise Error(message(function, name, "finite values", got, remedy))


def require_instance(
    function: str, argument: str, value: object, kind: type, remedy: str | None = None
) -> None:
    """Raise DtypeError unless `value` is an instance of `kind`.

    Args:
        function, argument: that was called, and what `value` was given as, for the error.
        value: to be checked.
        kind: a class.
        remedy: what makes one, or takes one out of something larger.
    """
    if not isinstance(value, kind):
        expected = f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}"
        raise DtypeError(message(function, argument, expected, type(value).__name__, remedy))


def require_path(function: str, argument: str, value: str | Path) -> Path:
    """The path of a file or folder, or DtypeError.

    Args:
        function, argument: that was called, and what `value` was given as, for the error.
        value: a text or a `Path`.
    """
    if not isinstance(value, str | Path):
        raise DtypeError(message(function, argument, "a path", type(value).__name__))
    return Path(value)


# Dataclasses of plain values, such as options and policies, checked against their annotations.


T = TypeVar("T")


def from_plain(function: str, kind: type[T], data: object) -> T:
    """A dataclass from the object that `dataclasses.asdict` and JSON made of it.

    Args:
        function: on whose behalf errors speak.
        kind: a dataclass of numbers, texts, `Literal`s and tuples of those.
        data: {field: value}, lists in the place of tuples.

    Raises:
        DtypeError: no object, or a value of another type.
        RangeError: a field that is unknown or missing, and whatever `kind` itself refuses.
    """
    if not isinstance(data, Mapping):
        raise DtypeError(message(function, kind.__name__, "an object", shortened(data)))
    hints = get_type_hints(kind)
    known: Any = kind
    needed = {f.name for f in fields(known) if f.default is MISSING}
    odd = sorted(map(str, needed - set(data))) + sorted(map(str, set(data) - set(hints)))
    if odd:
        got = f"missing or unknown {', '.join(odd[:5])}"
        raise RangeError(message(function, kind.__name__, "its fields", got))
    return kind(**{name: typed(function, name, hints[name], value) for name, value in data.items()})


def require_types(options: Any) -> None:
    """Raise DtypeError or RangeError for a field of a dataclass that is not what it is declared."""
    kind = type(options)
    for name, hint in get_type_hints(kind).items():
        typed(kind.__name__, name, hint, getattr(options, name))


def require_choices(options: Any) -> None:
    """Raise RangeError for a field of a dataclass that is none of the names of its `Literal`."""
    kind = type(options)
    for name, hint in get_type_hints(kind).items():
        if _has_names(hint):
            typed(kind.__name__, name, hint, getattr(options, name))


def require_bounds(options: Any, *names: str, **bounds: float) -> None:
    """Raise DtypeError or RangeError for fields of a dataclass that are no numbers within bounds.

    `bounds` are those of `Arguments.number`; a field that may be None is left out where it is.
    """
    call = Arguments(type(options).__name__)
    hints = get_type_hints(type(options))
    for name in names:
        kinds, value = (hints[name], *get_args(hints[name])), getattr(options, name)
        if value is not None or NoneType not in kinds:
            check: Any = call.integer if int in kinds else call.number
            check(name, value, **bounds)


def _has_names(hint: Any) -> bool:
    return get_origin(hint) is Literal or any(map(_has_names, get_args(hint)))


def typed(function: str, name: str, hint: Any, value: Any) -> Any:
    """The value if it is of the annotated type, lists as tuples.

    Args:
        function, name: that was called, and its argument or field, for errors.
        hint: a class, a `Literal` of names, a tuple of these, or one of these or None.
        value: what was given.

    Raises:
        DtypeError: it is not. RangeError: none of the names of a `Literal`.
    """
    if get_origin(hint) in (Union, UnionType):
        (hint,) = [each for each in get_args(hint) if each is not NoneType]
        return None if value is None else typed(function, name, hint, value)
    if get_origin(hint) is Literal:
        if not isinstance(value, str) or value not in get_args(hint):
            expected = f"one of {', '.join(get_args(hint))}"
            raise RangeError(message(function, name, expected, shortened(value)))
        return value
    if get_origin(hint) is tuple:
        members = get_args(hint)
        if not isinstance(value, list | tuple) or len(value) != len(members):
            raise DtypeError(message(function, name, f"{len(members)} values", shortened(value)))
        return tuple(
            typed(function, name, member, each) for member, each in zip(members, value, strict=True)
        )
    accepted = (int, float) if hint is float else hint
    if not isinstance(value, accepted) or (isinstance(value, bool) and hint is not bool):
        words = {int: "a whole number", float: "a number", bool: "true or false"}
        raise DtypeError(message(function, name, words.get(hint, "a text"), shortened(value)))
    return value

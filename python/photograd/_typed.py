"""What every public function does with a wrong object: a typed error that names the argument.

    @typed_call
    def project(vertices: Array, camera: Camera) -> Array: ...

    project(corners, 3)  # DtypeError: project: camera: expected a Camera, got int

A function's own checks come first: they know better what was meant. Where it fails with another
exception, the arguments are compared with the annotations, and the first that is of another kind is
named. What annotations cannot say, such as arrays that do not fit each other, becomes an `Error`,
too, with the exception as its cause. A right call costs nothing.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache, wraps
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
import numpy.typing as npt

from photograd._arrays import shortened
from photograd.errors import DtypeError, Error, message

T = TypeVar("T", bound=Callable[..., Any])

UNTYPED = (TypeError, ValueError, LookupError, AttributeError, ArithmeticError, MemoryError)
NUMBERS: dict[type, tuple[str, tuple[type, ...]]] = {
    bool: ("true or false", (bool, np.bool_)),
    int: ("a whole number", (int, np.integer)),
    float: ("a number", (int, float, np.integer, np.floating)),
    complex: ("a number", (int, float, complex, np.number)),
}


def typed_call(target: T) -> T:
    """Decorator of a public function, or of a class: of its constructor and public methods.

    Raises, when called:
        DtypeError: an argument that is not what its annotation says.
        Error: arguments that the function fails with.
    """
    if not inspect.isclass(target):
        return _typed(target, target.__qualname__)
    for name, member in list(vars(target).items()):
        if name.startswith("_") and name not in ("__init__", "__call__"):
            continue
        shown = target.__name__ if name.startswith("_") else f"{target.__name__}.{name}"
        if inspect.isfunction(member):
            setattr(target, name, _typed(member, shown))
        elif isinstance(member, classmethod | staticmethod):
            setattr(target, name, type(member)(_typed(member.__func__, shown)))
    return target


def _typed(function: T, name: str) -> T:
    signature = inspect.signature(function)

    @wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        try:
            return function(*arguments, **named)
        except UNTYPED as failure:
            if isinstance(failure, Error):
                raise
            try:
                given = signature.bind(*arguments, **named).arguments
            except TypeError:
                raise failure from None  # too many arguments, or too few, as Python says it
            _explain(name, signature, _hints(function), given, failure)
            raise

    return call  # type: ignore[return-value]


def _explain(
    name: str,
    signature: inspect.Signature,
    hints: Mapping[str, Any],
    given: Mapping[str, Any],
    failure: Exception,
) -> None:
    """Raise DtypeError for the first argument of another kind, or else Error.

    Returns where a callback was given: its exceptions are its caller's.
    """
    try:
        for argument, value in given.items():
            if argument in hints:
                _require(name, argument, hints[argument], value, signature.parameters[argument])
    except DtypeError as refused:
        raise refused from failure
    if not any(_is_callback(hints.get(argument)) for argument in given):
        got, expected = (
            f"{type(failure).__name__}: {failure}",
            "ones that fit each other and this function",
        )
        raise Error(message(name, "arguments", expected, shortened_text(got))) from failure


def _is_callback(hint: Any) -> bool:
    members = get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)
    return any(get_origin(each) is Callable for each in members)


@cache
def _hints(function: Callable[..., Any]) -> dict[str, Any]:
    """{argument: annotation}, of a function whose module is imported by now."""
    return {name: hint for name, hint in get_type_hints(function).items() if name != "return"}


def _require(
    function: str, argument: str, hint: Any, value: Any, parameter: inspect.Parameter
) -> None:
    if parameter.kind is parameter.VAR_POSITIONAL or parameter.kind is parameter.VAR_KEYWORD:
        values = value if parameter.kind is parameter.VAR_POSITIONAL else value.values()
        for each in values:
            _refuse_unless(function, argument, hint, each)
    elif value is not parameter.default:
        _refuse_unless(function, argument, hint, value)


def _refuse_unless(function: str, argument: str, hint: Any, value: Any) -> None:
    if conforms(hint, value):
        return
    got = shortened(value) if isinstance(value, PLAIN) else type(value).__name__
    raise DtypeError(message(function, argument, wanted(hint), got))


PLAIN = (int, float, complex, str, bytes, NoneType, list, tuple, dict, np.generic)


def conforms(hint: Any, value: Any) -> bool:
    """Whether a value is what an annotation says; true for annotations that say nothing of it.

    Args:
        hint: an annotation.
        value: any object.
    """
    if hint in (Any, npt.DTypeLike):
        return True
    origin: Any = get_origin(hint) or hint
    members = get_args(hint)
    if origin in (Union, UnionType):
        return any(conforms(each, value) for each in members)
    if origin is Literal:
        return isinstance(value, str)  # the function says which names there are
    if origin in NUMBERS:
        true_or_false = isinstance(value, bool | np.bool_)
        return isinstance(value, NUMBERS[origin][1]) and true_or_false == (origin is bool)
    if not inspect.isclass(origin) or _is_left_aside(origin):
        return True
    if origin in (type, Callable):
        return isinstance(value, type) if origin is type else callable(value)
    if issubclass(origin, Mapping):
        kind = members[1] if len(members) == 2 else Any
        return isinstance(value, Mapping) and all(conforms(kind, v) for v in value.values())
    if origin in _MANY:
        return _conforms_each(origin, members, value)
    return isinstance(value, (str, Path) if origin is Path else origin)


def _conforms_each(origin: Any, members: tuple[Any, ...], value: Any) -> bool:
    if not _is_listed(value):
        several = isinstance(value, Iterable) and not isinstance(value, TEXT | np.ndarray)
        return origin is Iterable and several
    if origin is tuple and members and members[-1] is not Ellipsis:
        return len(value) == len(members) and all(map(conforms, members, value))
    return all(conforms(members[0], each) for each in value) if members else True


TEXT = str | bytes
_MANY = (list, tuple, set, frozenset, Sequence, Collection, Iterable)


def _is_listed(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.ndim > 0
    return isinstance(value, Collection) and not isinstance(value, TEXT | Mapping)


def _is_left_aside(kind: type) -> bool:
    """Arrays are converted by the function; protocols say what is used of an object."""
    return issubclass(kind, np.ndarray) or getattr(kind, "_is_protocol", False)


def wanted(hint: Any) -> str:
    """What an annotation asks for, in words.

    Args:
        hint: an annotation.
    """
    origin, members = get_origin(hint) or hint, get_args(hint)
    if origin in (Union, UnionType):
        return " or ".join(dict.fromkeys(map(wanted, members)))
    if origin is Literal:
        return f"one of {', '.join(map(str, members))}"
    if origin in NUMBERS:
        return NUMBERS[origin][0]
    plain = {NoneType: "None", str: "a text", Path: "a path", Callable: "a function"}
    if origin in plain:
        return plain[origin]
    if inspect.isclass(origin) and issubclass(origin, np.ndarray):
        return "an array"
    if origin is tuple and members and members[-1] is not Ellipsis:
        kinds = " and ".join(dict.fromkeys(map(wanted, members)))
        return f"{len(members)} values, each {kinds}"
    if origin in (list, tuple, *_MANY) and members:
        return f"a list, each {wanted(members[0])}"
    if issubclass(origin, Mapping):
        return "a mapping"
    return f"{'an' if origin.__name__[0] in 'AEIOU' else 'a'} {origin.__name__}"


def shortened_text(text: str) -> str:
    """One line of at most 120 characters.

    Args:
        text: of any length.
    """
    line = " ".join(text.split())
    return line if len(line) <= 120 else f"{line[:117]}..."

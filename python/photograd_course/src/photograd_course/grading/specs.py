"""The shape of an answer, asked for before its values are looked at. Nothing is converted."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..worker.codec import INTEGER_BITS
from .failures import CheckFailed, NotFinite, WrongForm


class Spec(Protocol):
    """What a returned value must be."""

    def require(self, value: Any, where: str) -> None:
        """Raise CheckFailed unless ``value`` is what it should be; ``where`` names it."""


@dataclass(frozen=True)
class Array:
    """An array of this shape and dtype ("f8", "f4", "i8", "i4", "u1" or "bool").

    Attributes:
        shape: None stands for any length of an axis.
        dtype: exactly this one.
        finite: False where the check looks at NaN and infinities itself.
        above: every value is greater; NaN is not.
    """

    shape: tuple[int | None, ...]
    dtype: str = "f8"
    finite: bool = True
    above: float | None = None

    def require(self, value: Any, where: str) -> None:
        """See Spec."""
        shape = str(self.shape).replace("None", "any")
        want = f"an array of shape {shape} and dtype {np.dtype(_FULL[self.dtype])}"
        if not isinstance(value, np.ndarray):
            raise _wrong_kind(where, want, value)
        if not self._fits(value.shape):
            raise WrongForm(f"{where}: expected {want}, got shape {value.shape}")
        if value.dtype != np.dtype(_FULL[self.dtype]):
            raise WrongForm(f"{where}: expected {want}, got dtype {value.dtype}")
        if self.finite and value.dtype.kind == "f" and not np.isfinite(value).all():
            index = tuple(int(i) for i in np.argwhere(~np.isfinite(value))[0])
            count = int((~np.isfinite(value)).sum())
            raise NotFinite(
                f"{where}: {count} of {value.size} values are not finite, the first at {index}",
                {"worst_index": index},
            )
        if self.above is not None and not (value > self.above).all():
            index = tuple(int(i) for i in np.argwhere(~(value > self.above))[0])
            want = f"values above {self.above:g}{_or_infinity(self.finite)}"
            got = f"{value[index]} at index {index}"
            kind = NotFinite if np.isnan(value[index]) else CheckFailed
            raise kind(f"{where}: expected {want}, got {got}", {"worst_index": index})

    def _fits(self, shape: tuple[int, ...]) -> bool:
        pairs = zip(self.shape, shape, strict=False)
        return len(shape) == len(self.shape) and all(want in (None, n) for want, n in pairs)


@dataclass(frozen=True)
class Number:
    """A float, or an integer of at most 64 bits; an array without axes will do.

    Finite, unless ``finite`` is False; greater than ``above`` where that is given.
    """

    finite: bool = True
    above: float | None = None

    def require(self, value: Any, where: str) -> None:
        """See Spec."""
        if isinstance(value, np.ndarray) and value.shape == () and value.dtype == np.float64:
            value = float(value)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise _wrong_kind(where, "a float", value)
        if isinstance(value, int) and abs(value) >= 1 << INTEGER_BITS:
            raise CheckFailed(f"{where}: expected a finite float, got an integer beyond 64 bits")
        if self.finite and not math.isfinite(value):
            raise NotFinite(f"{where}: expected a finite float, got {value}")
        if self.above is not None and not value > self.above:
            more = _or_infinity(self.finite)
            kind = NotFinite if math.isnan(value) else CheckFailed
            raise kind(f"{where}: expected a float above {self.above:g}{more}, got {value}")


@dataclass(frozen=True)
class Integer:
    """An integer, from ``low`` to ``high`` where given."""

    low: int | None = None
    high: int | None = None

    def require(self, value: Any, where: str) -> None:
        """See Spec."""
        if isinstance(value, bool) or not isinstance(value, int):
            raise _wrong_kind(where, "an int", value)
        if (self.low is not None and value < self.low) or (
            self.high is not None and value > self.high
        ):
            raise CheckFailed(f"{where}: expected {self.low} to {self.high}, got {value}")


@dataclass(frozen=True)
class Truth:
    """True or False."""

    def require(self, value: Any, where: str) -> None:
        """See Spec."""
        if not isinstance(value, bool):
            raise _wrong_kind(where, "True or False", value)


@dataclass(frozen=True)
class Text:
    """A string of at most ``longest`` characters."""

    longest: int = 10_000

    def require(self, value: Any, where: str) -> None:
        """See Spec."""
        if not isinstance(value, str):
            raise _wrong_kind(where, "a str", value)
        if len(value) > self.longest:
            raise CheckFailed(f"{where}: expected at most {self.longest} characters")


class Items:
    """A tuple or list with exactly these parts."""

    def __init__(self, *parts: Spec, names: tuple[str, ...] = ()) -> None:
        self.parts = parts
        self.names = names or tuple(f"item {k}" for k in range(len(parts)))

    def require(self, value: Any, where: str) -> None:
        """See Spec."""
        if not isinstance(value, list):
            raise _wrong_kind(where, f"a tuple of {len(self.parts)}", value)
        if len(value) != len(self.parts):
            raise WrongForm(f"{where}: expected {len(self.parts)} values, got {len(value)}")
        for part, name, item in zip(self.parts, self.names, value, strict=True):
            part.require(item, f"{where}, {name}")


@dataclass(frozen=True)
class Record:
    """A dict with exactly these keys."""

    parts: Mapping[str, Spec]

    def require(self, value: Any, where: str) -> None:
        """See Spec."""
        if not isinstance(value, dict):
            raise _wrong_kind(where, f"a dict with the keys {sorted(self.parts)}", value)
        if set(value) != set(self.parts):
            raise WrongForm(f"{where}: expected the keys {sorted(self.parts)}")
        for key, part in self.parts.items():
            part.require(value[key], f"{where}[{key!r}]")


def asks(function: Callable[..., Any], *specs: Spec, name: str) -> Callable[..., Any]:
    """``function`` as a service that looks at its arguments before it computes with them.

    What a submission asks is as little to be trusted as what it answers: an array of another shape
    can break the check that keeps it, or take hundreds of times its own memory.

    Args:
        function: of the check.
        specs: one for each argument.
        name: of the function, as the submission knows it.

    Returns:
        a function that raises CheckFailed, the verdict, for arguments that are not as specified.
    """

    def service(*args: Any) -> Any:
        if len(args) != len(specs):
            raise CheckFailed(f"{name}: expected {len(specs)} arguments, got {len(args)}")
        for spec, arg in zip(specs, args, strict=True):
            spec.require(arg, f"the argument of {name}")
        return function(*args)

    return service


_FULL = {
    "f8": "float64",
    "f4": "float32",
    "i8": "int64",
    "i4": "int32",
    "u1": "uint8",
    "bool": "bool",
}


def _or_infinity(finite: bool) -> str:
    return "" if finite else ", or infinity"


def _wrong_kind(where: str, want: str, value: Any) -> WrongForm:
    kind = "None" if value is None else type(value).__name__
    hint = " (does a return statement lack?)" if value is None else ""
    return WrongForm(f"{where}: expected {want}, got {kind}{hint}")

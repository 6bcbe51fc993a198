"""Registered models: found by name, and their parameters packed into rows of numbers.

Reflectance models, specular surfaces, phase functions, lights and representations are all kept in a
`Registry`. Models of a few numbers describe them by `ModelParameters`, and every function of such a
model takes its numbers as `Values`: by name, or packed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
from photograd_course.suggest import choose_from

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.types import Array

Model = TypeVar("Model")
Values = Mapping[str, Any] | Array
"""{name: value}, a value being a number or (3,), or one for each of N rows, (N,) or (N, 3); or all
packed in order: (P,), (1, P) or (N, P)."""

SPECULAR = "surfaces without roughness are models of their own: mirror, glass, thin_glass"
"""The remedy where a roughness of 0 is refused."""


class Registry(Mapping[str, Model]):
    """Models by name, in the order in which they were registered."""

    def __init__(self, kind: str, models: Mapping[str, Model]) -> None:
        """Keep `models`; `kind` is what an error calls them, such as "phase function"."""
        self.kind = kind
        self._models = models

    def __getitem__(self, name: str) -> Model:
        """The model of that name.

        Raises:
            RangeError: no such model; names the nearest, or all.
        """
        if name not in self:
            expected, remedy = f"one of {sorted(self)}", choose_from(str(name), self)
            raise RangeError(message(self.kind, "name", expected, repr(name), remedy))
        return self._models[name]

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self._models

    def __iter__(self) -> Iterator[str]:
        return iter(self._models)

    def __len__(self) -> int:
        return len(self._models)

    def get(self, name: str, default: Any = None) -> Any:
        """The model of that name, or `default`."""
        return self._models.get(name, default)


@dataclass(frozen=True)
class ModelParameter:
    """A continuous parameter: `size` numbers that make sense in [lo, hi], in `unit`."""

    name: str
    size: int
    lo: float
    hi: float
    unit: str


class ModelParameters(tuple[ModelParameter, ...]):
    """The parameters of a model, in the order in which the core packs them."""

    __slots__ = ()

    @classmethod
    def of(cls, rows: Iterable[tuple[Any, ...]]) -> ModelParameters:
        """From rows (name, size, lo, hi, unit), as the core describes them."""
        return cls(ModelParameter(*row) for row in rows)

    @property
    def width(self) -> int:
        """P, how many numbers a row has."""
        return sum(parameter.size for parameter in self)

    def pack(
        self, call: Arguments, model: str, values: Values, dtype: npt.DTypeLike | None = None
    ) -> Array:
        """Rows (1, P) or (N, P) of a model's values, N as in other arguments of the call.

        Named values are converted to `dtype`, by default that of the call; packed ones have it.
        Errors call a value `model`.name, or by its name alone where `model` is "".

        Raises:
            DtypeError: not numbers, or packed values of another dtype.
            RangeError: a name that is missing or unknown, a value that is not finite, or one of 0
                or less where the range of the parameter lies above 0.
            ShapeError: another shape, or another number of rows.
        """
        return self._packed(call, model, values, dtype)

    def pack_one(
        self, call: Arguments, model: str, values: Values, *, positive: bool = True
    ) -> Array:
        """(P,) of a model that has no values by row; otherwise as `pack`.

        `positive` False leaves it to the core to refuse 0.
        """
        (row,) = self._packed(call, model, values, None, one_row=True, positive=positive)
        return np.asarray(row)

    def _packed(
        self,
        call: Arguments,
        model: str,
        values: Values,
        dtype: npt.DTypeLike | None,
        *,
        one_row: bool = False,
        positive: bool = True,
    ) -> Array:
        def with_rows(*one: int) -> tuple[tuple[int | str, ...], ...]:
            return (one,) if one_row else (one, (1, *one), ("N", *one))

        if not isinstance(values, Mapping):
            rows = call.array(model, values, *with_rows(self.width), dtype=dtype)
            for name, part in self.unpack(rows).items():
                parameter = next(each for each in self if each.name == name)
                if positive:
                    _require_positive(call.function, _below(model, name), parameter, part)
            return rows.reshape(-1, self.width)
        names = [parameter.name for parameter in self]
        if set(values) != set(names):
            expected, got = f"exactly {names}", sorted(values)
            raise RangeError(message(call.function, _below(model, "values"), expected, got))
        columns = []
        for parameter in self:
            shapes = with_rows(parameter.size) if parameter.size > 1 else with_rows()
            name = _below(model, parameter.name)
            column = call.array(name, values[parameter.name], *shapes, dtype=np.float64)
            if positive:
                _require_positive(call.function, name, parameter, column)
            columns.append(column.reshape(-1, parameter.size))
        count = max((len(column) for column in columns), default=1)
        wide = [np.broadcast_to(column, (count, column.shape[1])) for column in columns]
        target = call.dtype if dtype is None else dtype
        return np.ascontiguousarray(np.concatenate([np.zeros((count, 0)), *wide], axis=1), target)

    def unpack(self, rows: Array) -> dict[str, Array]:
        """Rows (..., P) as {name: (...) or (..., size)}."""
        ends = np.cumsum([parameter.size for parameter in self])[:-1]
        return {
            parameter.name: part[..., 0] if parameter.size == 1 else part
            for parameter, part in zip(self, np.split(rows, ends, axis=-1), strict=True)
        }


def _below(model: str, name: str) -> str:
    return f"{model}.{name}" if model else name


def _require_positive(function: str, name: str, parameter: ModelParameter, column: Array) -> None:
    """A lobe without width has no value, and an index of refraction of 0 none, either."""
    if parameter.lo > 0 and not (column > 0).all():
        remedy = SPECULAR if "roughness" in parameter.name else None
        raise RangeError(message(function, name, "above 0", column.min(), remedy))

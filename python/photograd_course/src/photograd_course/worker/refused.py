"""What stands in the place of a module that a graded module may not import.

While modules load, what is made of a stand-in is one as well: a decorator, a base class, a constant
at the top of a module. Later, whatever uses one raises `ImportRefused`, and nothing else does.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn, TypeVar

T = TypeVar("T")

ARITHMETIC = ("add", "sub", "mul", "truediv", "floordiv", "mod", "pow", "matmul")
BITWISE = ("and", "or", "xor", "lshift", "rshift")
BINARY = (*ARITHMETIC, *BITWISE)
PASSED_ON = ("call", "getitem", "neg", "pos", "abs", *BINARY, *(f"r{name}" for name in BINARY))
COMPARED = ("lt", "le", "gt", "ge", "eq", "ne", "bool", "contains")
CONVERTED = ("len", "iter", "next", "float", "int", "index", "complex", "array", "enter", "exit")


class ImportRefused(ImportError):
    """A function uses what its module may not import."""


class StandIn:
    """Of a module, or of what was to come of it."""

    loading = False

    def __init__(self, said: str) -> None:
        self._said = said

    def __getattr__(self, name: str) -> StandIn:
        if name.startswith("__"):  # how others ask what an object can do
            raise AttributeError(name)
        return self._passed_on()

    def __mro_entries__(self, bases: tuple[Any, ...]) -> tuple[type, ...]:
        """As a base class: one whose objects are stand-ins.

        Args:
            bases: of the class statement.
        """
        return (type("Refused", (), {"__new__": lambda *_args, **_named: self._passed_on()}),)

    def __hash__(self) -> int:
        return id(self)

    def _passed_on(self, *_: Any, **__: Any) -> StandIn:
        return StandIn(self._said) if StandIn.loading else self._refuse()

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise ImportRefused(f"this needs {self._said}, which a graded module may not import")


for _name in PASSED_ON:
    setattr(StandIn, f"__{_name}__", StandIn._passed_on)
for _name in (*COMPARED, *CONVERTED, "setitem", "delitem"):
    setattr(StandIn, f"__{_name}__", StandIn._refuse)


def load(do: Callable[[], T]) -> T:
    """The result of a call during which stand-ins make stand-ins.

    Args:
        do: imports modules.
    """
    StandIn.loading = True
    try:
        return do()
    finally:
        StandIn.loading = False

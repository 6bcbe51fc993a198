"""What can be registered as a representation, and what is refused."""

from __future__ import annotations

from typing import Any

import pytest
from photograd.errors import DtypeError, RangeError
from photograd.representation import REGISTERED, Representation, register

METHODS = ("example", "example_batch", "param_groups", "render", "render_backward")


def a_class(**attributes: Any) -> Any:
    return type("Mine", (Representation,), {**dict.fromkeys(METHODS, print), **attributes})


@pytest.mark.parametrize(
    ("cls", "error", "words"),
    [
        (int, DtypeError, "expected a subclass of Representation"),
        (type("Empty", (Representation,), {}), DtypeError, "the methods example, example_batch"),
        (a_class(), RangeError, "Mine.name: expected a name"),
        (a_class(name="dense_grid"), RangeError, "'dense_grid', the name of DenseGrid"),
        (a_class(name="mine"), RangeError, "Mine.capabilities: expected a frozenset of canvas2d"),
        (a_class(name="mine", capabilities=frozenset({"sound"})), RangeError, "'sound'"),
    ],
)
def test_what_is_refused(cls: Any, error: type[Exception], words: str) -> None:
    import photograd.fields  # noqa: F401  (registers DenseGrid)

    before = dict(REGISTERED)
    with pytest.raises(error, match=words):
        register(cls)
    assert before == REGISTERED


def test_a_class_may_be_defined_again() -> None:
    good = {"name": "mine", "capabilities": frozenset({"rays"})}
    try:
        register(a_class(**good))
        again = register(a_class(**good))
        assert REGISTERED["mine"] is again
    finally:
        REGISTERED.pop("mine", None)

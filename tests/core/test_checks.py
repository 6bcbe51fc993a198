"""Values that are checked against their annotations: options, checkpoints, arguments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import pytest
from photograd._checks import require_choices, typed
from photograd.errors import DtypeError, RangeError

Side = Literal["left", "right"]


@dataclass(frozen=True)
class Options:
    """Names in each of the ways in which options hold them; other fields are not looked at."""

    side: Side = "left"
    pair: tuple[Side, Side] = ("left", "right")
    perhaps: Side | None = None
    count: int = 1

    def __post_init__(self) -> None:
        require_choices(self)


@pytest.mark.parametrize(
    ("hint", "value"),
    [
        (Side, "left"),
        (Side | None, None),
        (Side | None, "right"),
        (float, 1),
        (int | None, 3),
        (bool, True),
    ],
)
def test_what_fits_is_returned(hint: Any, value: Any) -> None:
    assert typed("f", "a", hint, value) is value
    assert typed("f", "a", tuple[Side, Side], ["left", "left"]) == ("left", "left")


@pytest.mark.parametrize(
    ("hint", "value", "error", "text"),
    [
        (Side, "up", RangeError, "^f: a: expected one of left, right, got 'up'$"),
        (Side | None, "up", RangeError, "expected one of left, right, got 'up'"),
        (Side, ["left"], RangeError, "expected one of left, right"),
        (tuple[Side, Side], ["left"], DtypeError, "expected 2 values"),
        (tuple[Side, Side], "left", DtypeError, "expected 2 values"),
        (tuple[Side, Side], ["left", "up"], RangeError, "expected one of left, right, got 'up'"),
        (int | None, 1.5, DtypeError, "expected a whole number, got 1.5"),
        (int, True, DtypeError, "expected a whole number, got True"),
    ],
)
def test_what_does_not_is_named(hint: Any, value: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        typed("f", "a", hint, value)


@pytest.mark.parametrize("wrong", [{"side": "up"}, {"pair": ("left", "up")}, {"perhaps": "up"}])
def test_options_refuse_other_names_when_they_are_made(wrong: dict[str, Any]) -> None:
    Options(count="not looked at")  # type: ignore[arg-type]
    with pytest.raises(RangeError, match=rf"^Options: {next(iter(wrong))}: expected one of left"):
        Options(**wrong)

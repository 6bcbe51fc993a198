"""Options of an exploration: stated once, changed on the command line or in the cell."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import NoReturn

from ..errors import RangeError, message
from ..suggest import nearest
from .environment import kernel, words

Value = int | float | str


@dataclass(frozen=True)
class Option:
    """What an option may be.

    Attributes:
        default: the value where it is not given; a given one has its type.
        low, high: of a number.
        is_path: a text names a file or a folder, which must exist.
        like: another option, whose value is the default.
    """

    default: Value
    low: float = -math.inf
    high: float = math.inf
    is_path: bool = False
    like: str = ""


def at_least(default: Value, low: float) -> Option:
    """A number of ``low`` or more.

    Args:
        default: the value where it is not given.
        low: the least that is taken.
    """
    return Option(default, low)


def between(default: Value, low: float, high: float) -> Option:
    """A number from ``low`` to ``high``.

    Args:
        default: the value where it is not given.
        low, high: the least and the most that are taken.
    """
    return Option(default, low, high)


def same_as(like: str, low: float, high: float) -> Option:
    """A number from ``low`` to ``high``; by default the value of another option.

    Args:
        like: the name of the other one.
        low, high: the least and the most that are taken.
    """
    return Option(low, low, high, like=like)


def existing() -> Option:
    """A file or folder; by default none, an empty text."""
    return Option("", is_path=True)


def options(**stated: Value | Option) -> SimpleNamespace:
    """The options of an exploration, by name; ``max_count`` is ``--max-count``.

    In a notebook they are those of the cell: change a number there. A whole number without bounds
    is 1 or more.

    Args:
        stated: default of each, or what it may be.

    Raises:
        RangeError: in a notebook, a number of the cell is none that the option takes.
        SystemExit: of a script, after a wrong option, with a line that says so; after ``--help``,
            which prints the text at the head of the script.
    """
    known = {name.replace("_", "-"): _option(each) for name, each in stated.items()}
    given = words()
    if "--help" in given or "-h" in given:
        sys.stdout.write(introduction(Path(sys.argv[0]).read_text("utf-8")))
        shown = (f"  --{name} {option.default}\n" for name, option in known.items())
        sys.stdout.write("Defaults:\n" + "".join(shown))
        raise SystemExit
    try:
        found = parse(given, known)
        for name, option in known.items():
            found.setdefault(name, found.get(option.like, option.default))
            found[name] = _checked(name, option, found[name])
    except RangeError as error:
        refuse(error)
    return SimpleNamespace(**{name.replace("-", "_"): value for name, value in found.items()})


def refuse(error: RangeError) -> NoReturn:
    """End a script with the error's sentence alone; in a notebook, raise it.

    Args:
        error: what is wrong with an option.
    """
    if kernel() is not None:
        raise error
    raise SystemExit(str(error)) from None


def parse(given: Sequence[str], known: Mapping[str, Option]) -> dict[str, Value]:
    """Values by name of ``--name value`` and ``--name=value``.

    Args:
        given: the words of the command line behind the script's name.
        known: the options that are stated, by name.

    Raises:
        RangeError: an option is unknown, lacks its value, or has one that it does not take.
    """
    found: dict[str, Value] = {}
    waiting = list(given)
    while waiting:
        word = waiting.pop(0)
        name, has_value, text = word.removeprefix("--").partition("=")
        if not word.startswith("--") or name not in known:
            raise _unknown(word, known)
        if not has_value:
            if not waiting or waiting[0].removeprefix("--") in known:
                raise RangeError(message("explore.py", f"--{name}", _taken(known[name]), "nothing"))
            text = waiting.pop(0)
        found[name] = _checked(name, known[name], text)
    return found


def introduction(script: str) -> str:
    """The first cell of a script, its markdown, without the marks.

    Args:
        script: its text.
    """
    head = script.partition("# %% [markdown]\n")[2].partition("\n\n")[0]
    return "".join(f"{line.removeprefix('#').lstrip(' #')}\n" for line in head.splitlines())


def _option(stated: Value | Option) -> Option:
    if isinstance(stated, Option):
        return stated
    return Option(stated, 1 if type(stated) is int else -math.inf)


def _checked(name: str, option: Option, value: Value) -> Value:
    """``value`` with the type of the default.

    Raises:
        RangeError: it has none, or lies outside of the bounds.
    """
    refused = RangeError(message("explore.py", f"--{name}", _taken(option), repr(value)))
    try:
        typed = type(option.default)(value)
    except (ValueError, OverflowError):
        raise refused from None
    if isinstance(typed, str):
        if option.is_path and typed and not Path(typed).exists():
            raise refused
    elif not (math.isfinite(typed) and option.low <= typed <= option.high):
        raise refused
    return typed


def _taken(option: Option) -> str:
    """What an option takes, in words."""
    if isinstance(option.default, str):
        return "a file or folder that exists" if option.is_path else "a text"
    kind = "a whole number" if isinstance(option.default, int) else "a number"
    if math.isfinite(option.high):
        return f"{kind} from {option.low:g} to {option.high:g}"
    return f"{kind} of {option.low:g} or more" if math.isfinite(option.low) else kind


def _unknown(word: str, known: Mapping[str, Option]) -> RangeError:
    listed = ", ".join(f"--{name}" for name in known) or "no option"
    like = nearest(word.removeprefix("--").partition("=")[0], known)
    remedy = f"did you mean '--{like}'?" if like else "--help says what they are"
    return RangeError(message("explore.py", "option", f"one of {listed}", repr(word), remedy))

"""What the scripts that students play with share."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

Value = TypeVar("Value", int, float, str)
Result = TypeVar("Result")


def option(name: str, default: Value) -> Value:
    """The value after ``--name`` on the command line; the default in a notebook.

    Args:
        name: of the option, without dashes.
        default: the value where the option is not given; a given one gets its type.

    Raises:
        ValueError: what follows is no such number.
        SystemExit: ``--help`` is given; the text at the head of the script has been printed.
    """
    words = sys.argv[1:]
    if "--help" in words:
        sys.stdout.write(introduction(Path(sys.argv[0]).read_text("utf-8")))
        raise SystemExit
    if f"--{name}" not in words:
        return default
    return type(default)(words[words.index(f"--{name}") + 1])


def introduction(script: str) -> str:
    """The first cell of a script's text, its markdown, without the marks."""
    head = script.partition("# %% [markdown]\n")[2].partition("\n\n")[0]
    return "".join(f"{line.removeprefix('#').lstrip(' #')}\n" for line in head.splitlines())


def by_the_core(compute: Callable[[], Result]) -> Result | None:
    """What the C++ core answers; None, and a line on the terminal, where it is not installed.

    Args:
        compute: imports the core and asks it. Pictures then leave out what would be the core's.

    Returns:
        the result of ``compute``; None as well where the core is another than it was written for.
    """
    try:
        return compute()
    except (ImportError, AttributeError, TypeError):
        sys.stdout.write("core not installed: nothing is compared with it\n")
        return None

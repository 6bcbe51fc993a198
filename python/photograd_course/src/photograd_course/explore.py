"""What the scripts that students play with share."""

from __future__ import annotations

import sys
from typing import TypeVar

Value = TypeVar("Value", int, float, str)


def option(name: str, default: Value) -> Value:
    """The value after ``--name`` on the command line; the default in a notebook.

    Args:
        name: of the option, without dashes.
        default: the value where the option is not given; a given one gets its type.

    Raises:
        ValueError: what follows is no such number.
    """
    words = sys.argv[1:]
    if f"--{name}" not in words:
        return default
    return type(default)(words[words.index(f"--{name}") + 1])

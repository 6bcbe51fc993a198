"""The modules that an exploration runs: the student's, and the C++ core where it is installed."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any, TypeVar

Result = TypeVar("Result")
_CHANGED: dict[str, dict[str, Any]] = {}


def set_constants(module: ModuleType, **values: Any) -> None:
    """Replace names of the student's module, also when the edited file is read again.

    Args:
        module: the student's.
        values: by name in the module.
    """
    _CHANGED.setdefault(module.__name__, {}).update(values)
    vars(module).update(values)


def set_again(module: ModuleType) -> None:
    """Replace again what `set_constants` has replaced in a module before it was reloaded.

    Args:
        module: the student's, read anew.
    """
    vars(module).update(_CHANGED.get(module.__name__, {}))


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

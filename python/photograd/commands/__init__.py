"""The core's commands, one a file.

`register` is the entry point that the `photograd` command finds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

import typer

from photograd.commands import (
    bake_ao,
    capture,
    compare,
    convert,
    demo,
    evaluate,
    fit,
    frame,
    gradients,
    info,
    recover,
    render,
    simplify,
    trace,
    vectorize,
    view,
)
from photograd.errors import IoError


def register(app: typer.Typer) -> None:
    """Add the core's commands to the command line."""
    for module in (
        capture,
        fit,
        render,
        view,
        trace,
        frame,
        bake_ao,
        simplify,
        recover,
        vectorize,
        convert,
        evaluate,
        gradients,
        compare,
        demo,
        info,
    ):
        module.register(app)
    for command in app.registered_commands:
        if command.name and command.callback and command.callback.__module__.startswith(__name__):
            command.callback = speaking_for(command.name, command.callback)


def speaking_for(command: str, function: Callable[..., None]) -> Callable[..., None]:
    """The function of a command, with errors of writing in the words of its user.

    Args:
        command: its name.
        function: what it does.
    """

    @wraps(function)
    def run(*arguments: Any, **named: Any) -> None:
        try:
            function(*arguments, **named)
        except IoError as failure:
            writer, _, rest = str(failure).partition(" path: ")
            if writer != "atomic_write:":
                raise
            where = "OUT" if command == "convert" else "--out"
            raise IoError(f"{command}: {where}: {rest}") from failure

    return run

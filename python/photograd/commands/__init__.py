"""The core's commands, one a file.

`register` is the entry point that the `photograd` command finds.
"""

from __future__ import annotations

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

"""The ``photograd`` command: the frame that the core and the course hang their commands on.

A distribution adds commands by an entry point of the group ``photograd.commands`` that names a
function ``register(app: typer.Typer) -> None``. What commands share lives here: options, results,
progress, errors and exit codes.
"""

from __future__ import annotations

from .entry import main, run
from .options import DebugOption, JsonOption, SeedOption, ThreadsOption
from .output import emit, note
from .progress import Column, Progress

__all__ = [
    "Column",
    "DebugOption",
    "JsonOption",
    "Progress",
    "SeedOption",
    "ThreadsOption",
    "emit",
    "main",
    "note",
    "run",
]

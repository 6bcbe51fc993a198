"""Options that mean the same in every command.

>>> def fit(seed: SeedOption = 0, threads: ThreadsOption = 0, as_json: JsonOption = False) -> None:
...     "A command declares the ones it needs."
"""

from __future__ import annotations

from typing import Annotated

import typer

PANEL = "Common options"
MOST_SEED = 2**63 - 1  # NumPy and the scenes take no more
MOST_THREADS = 4096

SeedOption = Annotated[
    int,
    typer.Option(
        "--seed",
        min=0,
        max=MOST_SEED,
        metavar="N",
        help="Seed of all random numbers. The same seed gives the same bits.",
        rich_help_panel=PANEL,
    ),
]

ThreadsOption = Annotated[
    int,
    typer.Option(
        "--threads",
        min=0,
        max=MOST_THREADS,
        metavar="N",
        help="Worker threads; 0 takes every core this process may use. The result is the same "
        "for any number.",
        rich_help_panel=PANEL,
    ),
]

JsonOption = Annotated[
    bool,
    typer.Option(
        "--json",
        help="Print the result, or the error, as one JSON line, the last on stdout; all else goes "
        "to stderr.",
        rich_help_panel=PANEL,
    ),
]

DebugOption = Annotated[
    bool,
    typer.Option(
        "--debug", help="Show the full traceback when something goes wrong.", rich_help_panel=PANEL
    ),
]


def has_option(arguments: list[str], option: str) -> bool:
    """Whether a flag such as ``--debug`` stands anywhere among the options.

    Read from the raw arguments, since an error may come before any command has parsed its own.
    """
    options = arguments[: arguments.index("--")] if "--" in arguments else arguments
    return option in options

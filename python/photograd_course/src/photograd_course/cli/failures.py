"""What goes wrong becomes one line on stderr and an exit code.

0 done, 1 an error, 2 the command was called wrongly or cannot be offered here, 130 interrupted.
"""

from __future__ import annotations

import sys
import traceback

import typer

from ..errors import Error
from .output import note

FAILED, MISUSED, INTERRUPTED = 1, 2, 130

# The base of all complaints of the parser about the command line. Reached through a public child,
# because newer versions of Typer carry their own copy of Click instead of depending on it.
ParserComplaint = typer.BadParameter.__mro__[2]


def complain(text: str) -> None:
    """One red line on stderr."""
    note(f"error: {text}", style="red")


def exit_code(error: BaseException, *, debug: bool) -> int:
    """Tell the user about ``error`` and return the exit code it deserves.

    Args:
        error: whatever ended the command.
        debug: print the traceback as well.
    """
    if isinstance(error, SystemExit):
        return _code_of_exit(error)
    if debug and not isinstance(error, ParserComplaint):
        sys.stderr.write("".join(traceback.format_exception(error)))
    if isinstance(error, (KeyboardInterrupt, typer.Abort)):
        note("interrupted", style="yellow")
        return INTERRUPTED
    if isinstance(error, ParserComplaint):
        return _parser_complaint(error)
    if isinstance(error, Error):
        complain(str(error))
    else:
        more = "" if debug else "; run with --debug for the traceback"
        complain(f"unexpected {type(error).__name__}: {error}{more}")
    return FAILED


def _parser_complaint(error: BaseException) -> int:
    text = str(error.format_message()) if hasattr(error, "format_message") else str(error)
    if type(error).__name__ == "NoArgsIsHelpError":  # a group without a subcommand: text is help
        sys.stderr.write(text + "\n")
        return MISUSED
    path = getattr(getattr(error, "ctx", None), "command_path", "photograd")
    complain(f"{path}: {text} (see {path} --help)")
    return int(getattr(error, "exit_code", MISUSED))


def _code_of_exit(error: SystemExit) -> int:
    if error.code is None or isinstance(error.code, int):
        return error.code or 0
    complain(str(error.code))
    return FAILED

"""What goes wrong becomes one line on stderr, an exit code and, with --json, an object on stdout.

0 done, 1 an error, 2 the command was called wrongly or cannot be offered here, 130 interrupted.
"""

from __future__ import annotations

import json
import sys
import traceback
from dataclasses import dataclass

import typer

from ..errors import Error
from .output import note

FAILED, MISUSED, INTERRUPTED = 1, 2, 130
USAGE = "UsageError"

# The base of all complaints of the parser about the command line. Reached through a public child,
# because newer versions of Typer carry their own copy of Click instead of depending on it.
ParserComplaint = typer.BadParameter.__mro__[2]


def complain(text: str) -> None:
    """One red line on stderr."""
    note(f"error: {text}", style="red")


class UnavailableError(Error):
    """A command that cannot be offered on this machine."""


@dataclass(frozen=True)
class Failure:
    """How a command ended that was not done.

    Attributes:
        code: the exit code; 0 for an early end without fault.
        kind: name of the error's class, "UsageError" or "Interrupted".
        text: what is said of it.
    """

    code: int
    kind: str = ""
    text: str = ""

    def print_json(self) -> None:
        """One line on stdout: {"error": {"type": ..., "message": ..., "exit_code": ...}}."""
        error = {"type": self.kind, "message": self.text, "exit_code": self.code}
        sys.stdout.write(json.dumps({"error": error}) + "\n")
        sys.stdout.flush()


def tell(error: BaseException, *, debug: bool) -> Failure:
    """Tell the user on stderr about what ended a command.

    Args:
        error: whatever ended it.
        debug: print the traceback as well.
    """
    if isinstance(error, SystemExit):
        return _exit(error)
    if debug and not isinstance(error, ParserComplaint):
        sys.stderr.write("".join(traceback.format_exception(error)))
    if isinstance(error, (KeyboardInterrupt, typer.Abort)):
        note("interrupted", style="yellow")
        return Failure(INTERRUPTED, "Interrupted", "interrupted")
    if isinstance(error, ParserComplaint):
        return _parser_complaint(error)
    text = _words_of(error)
    kind = type(error).__name__
    if not text:
        more = "" if debug else "; run with --debug for the traceback"
        text = f"unexpected {kind}: {error}{more}"
    complain(text)
    return Failure(MISUSED if isinstance(error, UnavailableError) else FAILED, kind, text)


def _words_of(error: BaseException) -> str:
    """One line for an error whose cause lies with the input or the machine; else nothing."""
    if isinstance(error, Error):
        return str(error)
    if isinstance(error, MemoryError):
        detail = f": {error}" if str(error) else ""
        return f"not enough memory{detail} (take smaller sizes, or close other programs)"
    if isinstance(error, OSError) and error.strerror and error.filename is not None:
        name = str(error.filename)
        return f"{error.strerror}: {name if len(name) <= 80 else f'{name[:77]}...'}"
    return ""


def _parser_complaint(error: BaseException) -> Failure:
    text = str(error.format_message()) if hasattr(error, "format_message") else str(error)
    if type(error).__name__ == "NoArgsIsHelpError":  # a group without a subcommand: text is help
        sys.stderr.write(text + "\n")
        return Failure(MISUSED, USAGE, "expected a command, got none")
    path = getattr(getattr(error, "ctx", None), "command_path", "photograd")
    text = f"{path}: {text} (see {path} --help)"
    complain(text)
    return Failure(int(getattr(error, "exit_code", MISUSED)), USAGE, text)


def _exit(error: SystemExit) -> Failure:
    if error.code is None or isinstance(error.code, int):
        return ended_early(error.code or 0)
    complain(str(error.code))
    return Failure(FAILED, "SystemExit", str(error.code))


def ended_early(code: int) -> Failure:
    """A command that ended with an exit code and, if it had to, has said why."""
    if code == INTERRUPTED:
        return Failure(code, "Interrupted", "interrupted")
    return Failure(code, "Exit", f"ended with exit code {code}")

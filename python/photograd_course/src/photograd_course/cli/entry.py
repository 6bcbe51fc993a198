"""From the words on the command line to an exit code."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Iterable, Sequence
from importlib import metadata
from typing import Annotated

import typer
from typer.main import get_command

from ..limits import LIMITS
from . import course, version
from .core_commands import add_missing_core_commands
from .failures import INTERRUPTED, exit_code
from .options import DebugOption, wants_debug
from .output import note
from .plugins import PluginProblem, find_plugins, load_plugins

EPILOG = (
    "Example: photograd demo\n\n"
    "Example: photograd fit my_capture --out my_model\n\n"
    "Each command explains itself: photograd COMMAND --help\n\n"
    "Input files that ask for much memory are refused. These environment variables raise the "
    f"limits: {', '.join(limit.variable for limit in LIMITS)}"
)


def main() -> None:
    """Run the command line of this process and exit."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: Sequence[str], *, plugins: Iterable[metadata.EntryPoint] | None = None) -> int:
    """Run one command line and return its exit code; never raises.

    Args:
        arguments: the words after ``photograd``.
        plugins: entry points to take commands from; by default those of all installed
            distributions.
    """
    words = list(arguments)
    debug = wants_debug(words)
    try:
        app, problems = build_app(find_plugins() if plugins is None else plugins)
        for problem in problems:
            _warn(problem, debug=debug)
        outcome = get_command(app).main(args=words, prog_name="photograd", standalone_mode=False)
    except BaseException as error:
        return exit_code(error, debug=debug)
    # Without standalone mode an early exit, also that of Ctrl-C, comes back as its code.
    if outcome == INTERRUPTED:
        note("interrupted", style="yellow")
    return outcome if isinstance(outcome, int) else 0


def build_app(
    plugins: Iterable[metadata.EntryPoint],
) -> tuple[typer.Typer, list[PluginProblem]]:
    """The application with all commands, and the plugins that could not take part."""
    app = typer.Typer(
        name="photograd",
        add_completion=False,
        rich_markup_mode="rich",
        pretty_exceptions_enable=False,
    )
    app.callback(invoke_without_command=True, epilog=EPILOG)(_photograd)
    version.register(app)
    course.register(app)
    names, problems = load_plugins(app, plugins)
    add_missing_core_commands(app, names, problems)
    return app, problems


def _photograd(
    context: typer.Context,
    show_version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.")
    ] = False,
    debug: DebugOption = False,  # noqa: ARG001 - read from the raw words, see wants_debug
) -> None:
    """Recover scenes from photographs by gradient descent."""
    if show_version:
        sys.stdout.write(f"photograd {version.version_of('photograd-course')}\n")
        raise typer.Exit
    if context.invoked_subcommand is None:
        sys.stdout.write(context.get_help())


def _warn(problem: PluginProblem, *, debug: bool) -> None:
    note(f"warning: commands of '{problem.name}' are missing: {problem.reason()}", style="yellow")
    if debug:
        sys.stderr.write("".join(traceback.format_exception(problem.error)))

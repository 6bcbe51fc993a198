"""From the words on the command line to an exit code."""

from __future__ import annotations

import inspect
import sys
import traceback
from collections.abc import Iterable, Sequence
from importlib import metadata
from typing import Annotated

import typer
from typer.main import get_command

from ..limits import LIMITS
from ..worker.debuggers import close_to_debuggers
from . import course, version
from .core_commands import add_missing_core_commands
from .failures import INTERRUPTED, Failure, ended_early, tell
from .options import DebugOption, has_option
from .output import json_printed, note
from .plugins import PluginProblem, find_plugins, load_plugins

EPILOG = (
    "Example: photograd course start 01\n\n"
    "Example: photograd demo\n\n"
    "Example: photograd fit my_capture --out my_model\n\n"
    "Each command explains itself: photograd COMMAND --help\n\n"
    "Input files that ask for much memory are refused. These environment variables raise the "
    f"limits: {', '.join(limit.variable for limit in LIMITS)}"
)


def main() -> None:
    """Run the command line of this process and exit."""
    if "grade" in sys.argv[1:]:
        close_to_debuggers()
    sys.exit(run(sys.argv[1:]))


def run(arguments: Sequence[str], *, plugins: Iterable[metadata.EntryPoint] | None = None) -> int:
    """Run one command line and return its exit code; never raises.

    Args:
        arguments: the words after ``photograd``.
        plugins: entry points to take commands from; by default those of all installed
            distributions.
    """
    words = list(arguments)
    json_printed.clear()
    failure = _run(words, plugins, debug=has_option(words, "--debug"))
    if failure.code and has_option(words, "--json") and not json_printed.is_set():
        failure.print_json()
    return failure.code


def _run(
    words: list[str], plugins: Iterable[metadata.EntryPoint] | None, *, debug: bool
) -> Failure:
    try:
        app, problems = build_app(find_plugins() if plugins is None else plugins)
        for problem in problems:
            _warn(problem, debug=debug)
        outcome = get_command(app).main(args=words, prog_name="photograd", standalone_mode=False)
    except BaseException as error:
        return tell(error, debug=debug)
    # Without standalone mode an early exit, also that of Ctrl-C, comes back as its code.
    if outcome == INTERRUPTED:
        note("interrupted", style="yellow")
    return ended_early(outcome if isinstance(outcome, int) else 0)


def build_app(plugins: Iterable[metadata.EntryPoint]) -> tuple[typer.Typer, list[PluginProblem]]:
    """The application with all commands, and the plugins that could not take part."""
    app = typer.Typer(
        name="photograd",
        rich_markup_mode="rich",
        pretty_exceptions_enable=False,
        # Commands inherit it.
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True, epilog=EPILOG)(_photograd)
    version.register(app)
    course.register(app)
    names, problems = load_plugins(app, plugins)
    add_missing_core_commands(app, names, problems)
    _join_help_lines(app)
    return app, problems


def _join_help_lines(app: typer.Typer) -> None:
    """A paragraph of a docstring becomes one line, which the terminal breaks by its own width.

    Typer does so with the first paragraph alone.
    """
    for command in app.registered_commands:
        text = command.help or inspect.getdoc(command.callback) or ""
        paragraphs = inspect.cleandoc(text).split("\n\n")
        command.help = "\n\n".join(" ".join(each.split("\n")) for each in paragraphs)
    for group in app.registered_groups:
        if group.typer_instance is not None:
            _join_help_lines(group.typer_instance)


def _photograd(
    context: typer.Context,
    show_version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.")
    ] = False,
    debug: DebugOption = False,  # noqa: ARG001 - read from the raw words, see has_option
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

"""Commands of other distributions, found by their entry points.

Each is tried out on a scratch application first. One that does not load, half registers, declares a
command that cannot be built or takes a name that is taken leaves no trace but a one-line report.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from importlib import metadata

import typer
from typer.main import get_group

GROUP = "photograd.commands"


@dataclass(frozen=True)
class PluginProblem:
    """Why the commands of one entry point are missing."""

    name: str
    error: BaseException

    def reason(self) -> str:
        """The error in one line."""
        return " ".join(f"{type(self.error).__name__}: {self.error}".split())


def find_plugins(group: str = GROUP) -> list[metadata.EntryPoint]:
    """All entry points of ``group``, in the order of their names."""
    return sorted(metadata.entry_points(group=group), key=lambda entry: (entry.name, entry.value))


def load_plugins(
    app: typer.Typer, entries: Iterable[metadata.EntryPoint]
) -> tuple[list[str], list[PluginProblem]]:
    """Add the commands of every entry point to ``app``.

    Returns:
        The names of all commands that ``app`` has afterwards, and the entry points that failed.
    """
    names = set(get_group(app).commands)
    problems = []
    for entry in entries:
        scratch = typer.Typer()
        try:
            entry.load()(scratch)
            new = _command_names(scratch)
            if taken := sorted(names & new):
                problems.append(PluginProblem(entry.name, _taken(taken)))
                continue
        except (Exception, SystemExit) as error:  # whatever foreign code does
            problems.append(PluginProblem(entry.name, error))
            continue
        names |= new
        app.registered_commands.extend(scratch.registered_commands)
        app.registered_groups.extend(scratch.registered_groups)
    return sorted(names), problems


def _command_names(scratch: typer.Typer) -> set[str]:
    """Build the commands, which is when wrong signatures show, and return their names."""
    if not (scratch.registered_commands or scratch.registered_groups):
        return set()
    return set(get_group(scratch).commands)


def _taken(names: list[str]) -> ValueError:
    return ValueError(f"command already taken: {', '.join(names)}")

"""Versions of everything a result may depend on, for bug reports and result tables.

The core tells its part through an entry point of the group ``photograd.info`` that names a
function without arguments returning a mapping, for example ``{"instruction_set": "x86-64-v3"}``.
"""

from __future__ import annotations

import os
import platform
from importlib import metadata

import typer

from .options import DebugOption, JsonOption
from .output import emit, note
from .plugins import PluginProblem, find_plugins

INFO_GROUP = "photograd.info"
LIBRARIES = ("numpy", "matplotlib", "typer", "rich")


def register(app: typer.Typer) -> None:
    """Add ``photograd version``."""

    @app.command(
        epilog="Example: photograd version --json",
        short_help="Versions, instruction set and threads of this installation.",
    )
    def version(as_json: JsonOption = False, debug: DebugOption = False) -> None:  # noqa: ARG001
        """Say what is installed: course, core, instruction set, threads and libraries.

        Put the output into a bug report. The core's entries are "none" where it is not installed;
        "commands_of" says for each plugin whether it loads.
        """
        emit(describe_installation(), as_json=as_json, title="photograd")


def describe_installation() -> dict[str, object]:
    """The installation as plain values; a part that fails is reported on stderr and left out."""
    result: dict[str, object] = {
        "course_version": version_of("photograd-course"),
        "core_version": version_of("photograd"),
        "instruction_set": None,
        "threads": available_threads(),
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        **{library: version_of(library) for library in LIBRARIES},
        "commands_of": {entry.name: _state_of(entry) for entry in find_plugins()},
    }
    for entry in find_plugins(INFO_GROUP):
        try:
            result.update(entry.load()())
        except Exception as error:  # foreign code; the rest is still worth knowing
            note(f"warning: {entry.name}: {type(error).__name__}: {error}", style="yellow")
    return result


def _state_of(entry: metadata.EntryPoint) -> str:
    """Whether a plugin loads, else why not."""
    try:
        entry.load()
    except (Exception, SystemExit) as error:  # foreign code, tried out on purpose
        return PluginProblem(entry.name, error).reason()
    return "ok"


def version_of(distribution: str) -> str | None:
    """Version of an installed distribution, or None."""
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return None


def available_threads() -> int:
    """Cores that this process may use, which can be fewer than the machine has."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1

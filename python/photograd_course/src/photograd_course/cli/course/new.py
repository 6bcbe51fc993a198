"""``photograd course new``: begin an assignment."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption
from ..output import note


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course new 17 light_fields",
        short_help="Scaffold an assignment that keeps the build rules.",
    )
    def new(
        number: Annotated[str, typer.Argument(metavar="NN", help="Two digits, not yet taken.")],
        name: Annotated[str, typer.Argument(help="Of folder and module, such as light_fields.")],
        root: Annotated[
            Path | None, typer.Option(help="Folder of assignments; by default the checkout's.")
        ] = None,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Write a small, complete assignment: module, checks, questions, mutants, alternatives.

        It builds as it is. Change it piece by piece, and run 'photograd course build' after each.
        """
        from ...build.kits import ENVIRONMENT, source_root
        from ...build.new import new_assignment

        found = source_root()
        top = root or found or Path("assignments")
        folder = new_assignment(number, name, top)
        command = f"photograd course build {number}"
        if found is None or top.resolve() != found.resolve():
            command = f"{ENVIRONMENT}={shlex.quote(str(top.resolve()))} {command}"
        note(f"{folder}: build it with '{command}', then make it yours")

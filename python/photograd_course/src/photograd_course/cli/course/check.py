"""``photograd course check``: the one command a student needs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption, JsonOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course check 01 --task gd_1d",
        short_help="Run the public checks on your code.",
    )
    def check(
        assignment: Annotated[str, typer.Argument(help="Number or name, such as 01.")],
        task: Annotated[
            str | None, typer.Option(help="Only this task: its id, or the name of a function.")
        ] = None,
        folder: Annotated[
            Path | None, typer.Option("--dir", help="Folder of your code; by default here.")
        ] = None,
        pictures: Annotated[
            bool, typer.Option(help="Draw wrong arrays beside the right ones, as check_*.png.")
        ] = True,
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Run the public checks on your code and say what to do next.

        Checks run in the order of the tasks; one that only fails because of an earlier task is
        blocked. Before the first check, your predictions are locked. Exit code 1 when a check
        does not pass.
        """
        from ...build.kits import find_kit
        from ...student.session import run_check_command

        kit = find_kit(assignment)
        done = run_check_command(kit.bundle, folder, task, pictures=pictures, as_json=as_json)
        if not done:
            raise typer.Exit(1)

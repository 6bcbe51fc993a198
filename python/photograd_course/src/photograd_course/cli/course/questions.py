"""``photograd course questions``: the questions, with the numbers that your code draws."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course questions 01",
        short_help="Show the questions, with the numbers drawn for you.",
    )
    def questions(
        assignment: Annotated[str, typer.Argument(help="Number or name, such as 01.")],
        folder: Annotated[
            Path | None, typer.Option("--dir", help="Folder of your code; by default here.")
        ] = None,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Show every question and your answer so far.

        The numbers in some of them are drawn from your name and your code, so answer those last:
        they change when the code does, though not with its comments.
        """
        from rich.console import Console

        from ...build.kits import find_kit
        from ...student.folder import find_folder
        from ...student.sheet import question_sheet, remember_shown

        bundle = find_kit(assignment).bundle
        work = find_folder(bundle.manifest, folder)
        console = Console(highlight=False)
        for line in question_sheet(bundle, work):
            console.print(line, soft_wrap=True, markup=False)
        remember_shown(bundle, work)

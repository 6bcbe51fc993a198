"""``photograd course predict``: say beforehand what will happen."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course predict 01", short_help="Make and lock your predictions."
    )
    def predict(
        assignment: Annotated[str, typer.Argument(help="Number or name, such as 01.")],
        folder: Annotated[
            Path | None, typer.Option("--dir", help="Folder of your code; by default here.")
        ] = None,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Ask for the predictions of an assignment that are still open, and lock them.

        A locked prediction earns its points whatever it says; it cannot be changed afterwards.
        """
        from rich.console import Console

        from ...build.kits import find_kit
        from ...student.asking import ask_where_one_can
        from ...student.folder import LOCK_NAME, find_folder
        from ...student.predictions import prediction_letters, write_lock

        bundle = find_kit(assignment).bundle
        work = find_folder(bundle.manifest, folder)
        console = Console(highlight=False)
        if (work.path / LOCK_NAME).exists():
            console.print(f"The predictions are locked already ({LOCK_NAME}).", soft_wrap=True)
            return
        made, lacking = prediction_letters(bundle.questions, work.answers()[1])
        if lacking:
            made = {**made, **ask_where_one_can(lacking, work, console)}
        if made:
            write_lock(work.path, bundle.manifest.id, made)
            console.print(f"{len(made)} predictions locked.", soft_wrap=True)
        else:
            console.print("This assignment asks for no predictions.", soft_wrap=True)

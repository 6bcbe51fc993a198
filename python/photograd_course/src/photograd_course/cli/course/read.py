"""``photograd course read``: the handout in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course read 01", short_help="Read the handout in your browser."
    )
    def read(
        assignment: Annotated[str, typer.Argument(help="Number or name, such as 01.")],
        folder: Annotated[
            Path | None, typer.Option("--dir", help="Folder of your code; by default here.")
        ] = None,
        browser: Annotated[
            bool, typer.Option("--open/--no-open", help="Open it, or only say where it lies.")
        ] = True,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Open the handout as a page: formulas, figures, values to copy; it needs no network.

        In the folder of a kit that is handout.html. Elsewhere it is written beside you, as
        NN_name.html.
        """
        import sys
        import webbrowser

        from rich.console import Console

        from ...build.kits import find_kit
        from ...student.reading import page_to_read

        path = page_to_read(find_kit(assignment), folder)
        Console(highlight=False).print(str(path), soft_wrap=True, markup=False)
        if browser and sys.stdout.isatty():
            webbrowser.open(path.resolve().as_uri())

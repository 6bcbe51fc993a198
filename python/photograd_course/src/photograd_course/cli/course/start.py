"""``photograd course start``: begin an assignment."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course start 01",
        short_help="Begin an assignment: lay out its kit in a folder.",
    )
    def start(
        assignment: Annotated[str, typer.Argument(help="Number or name, such as 01.")],
        folder: Annotated[
            Path | None,
            typer.Argument(help="Where; by default a folder of the assignment's name, here."),
        ] = None,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Lay out the kit of an assignment: handout, starter code, answers, things to play with.

        No file is ever replaced.
        """
        from rich.console import Console

        from ...build.kits import find_kit
        from ...build.public import PAGE
        from ...student.reading import kit_page
        from ...student.starting import lay_out, taken_along, with_own_modules

        kit = find_kit(assignment)
        target = folder or Path(kit.manifest.folder_name)
        files, taken = with_own_modules(kit.files, kit.manifest, target)
        if page := kit_page(files):
            files[PAGE] = page
        lay_out(files, target)
        console = Console(highlight=False)
        for path in taken:
            console.print(taken_along(path), soft_wrap=True)
        console.print(f"{kit.manifest.id} {kit.manifest.title}: ready in {target}", soft_wrap=True)
        console.print("Next:", soft_wrap=True)
        predicts = any(q.kind == "prediction" for q in kit.bundle.questions)
        for line in _next_steps(kit.manifest.id, kit.manifest.module, target, predicts=predicts):
            console.print(f"  {line}", soft_wrap=True)


def _next_steps(number: str, module: str, target: Path, *, predicts: bool) -> list[str]:
    first = [f"photograd course predict {number}   (before you read on)"] if predicts else []
    return [
        f"cd {target}",
        *first,
        f"photograd course read {number}      (the handout in your browser)",
        f"photograd course check {number}     (red at first)",
        f"write {module}.py, and check again until all is green",
        f"photograd course submit {number}",
    ]

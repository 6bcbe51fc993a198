"""``photograd course start``: begin an assignment."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..options import DebugOption

if TYPE_CHECKING:
    from ...assignment.manifest import Manifest
    from ...build.kits import Kit
    from ...student.folder import WorkFolder


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
        update: Annotated[
            bool,
            typer.Option(
                "--update", help="Only bring your files of earlier assignments up to date."
            ),
        ] = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Lay out the kit of an assignment: handout, starter code, answers, things to play with.

        Your own files of earlier assignments, from folders beside this one, are taken along. No
        file is ever replaced; a kit that was cut off is completed. With --update, in a folder that
        is there, copies of earlier files are replaced by those of the assignments that own them;
        what was in them is kept beside them.
        """
        from rich.console import Console

        from ...build.kits import find_kit, list_manifests
        from ...student.folder import WorkFolder, find_folder
        from ...student.updating import update_brought

        kit, console = find_kit(assignment), Console(highlight=False)
        manifests = list_manifests()
        if update:
            lines = update_brought(find_folder(kit.manifest, folder), manifests)
        else:
            target = folder or Path(kit.manifest.folder_name)
            lines = _lay_out(kit, WorkFolder(target, kit.manifest), manifests)
        for line in lines:
            console.print(line, soft_wrap=True, markup=False)


def _lay_out(kit: Kit, work: WorkFolder, manifests: Sequence[Manifest]) -> list[str]:
    """Lay out the kit; what is said of it."""
    from ...build.public import PAGE
    from ...student.comparing import differences, said_of_difference
    from ...student.reading import kit_page
    from ...student.starting import lay_out, taken_along, with_own_modules

    manifest, number = kit.manifest, kit.manifest.id
    files, taken = with_own_modules(kit.files, manifest, work.path, manifests)
    if page := kit_page(files):
        files[PAGE] = page
    laid = lay_out(files, work.path, manifest.module, manifest.brought)
    lines = [taken_along(each, number) for each in taken if f"{each.module}.py" in laid.written]
    if laid.edited:
        lines.append(f"Left as you have it: {', '.join(laid.edited)}.")
        lines += [said_of_difference(each, number) for each in differences(work, manifests)]
    lines += [f"{number} {manifest.title}: ready in {work.path}", "Next:"]
    predicts = any(q.kind == "prediction" for q in kit.bundle.questions)
    steps = _next_steps(number, manifest.module, work.path, predicts=predicts)
    return [*lines, *(f"  {step}" for step in steps)]


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

"""``photograd course submit``: pack what is handed in."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption, JsonOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course submit 01",
        short_help="Pack your work into one file to submit.",
    )
    def submit(
        assignment: Annotated[str, typer.Argument(help="Number or name, such as 01.")],
        folder: Annotated[
            Path | None, typer.Option("--dir", help="Folder of your code; by default here.")
        ] = None,
        out: Annotated[
            Path | None,
            typer.Option(help="The archive; by default NN_name_submission.zip in that folder."),
        ] = None,
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Pack the files that count into a zip archive, and say what is still open."""
        from ...build.kits import find_kit, list_manifests
        from ...student.comparing import differences, said_of_difference
        from ...student.folder import find_folder
        from ...student.next_steps import next_steps
        from ...student.packing import pack
        from ...student.sheet import notes_before_submission
        from ..output import emit, note

        bundle = find_kit(assignment).bundle
        work = find_folder(bundle.manifest, folder)
        files = work.files()
        found = differences(work, list_manifests())
        target = out or work.path / f"{bundle.manifest.folder_name}_submission.zip"
        notes = [
            *notes_before_submission(bundle, work),
            *(said_of_difference(each, bundle.manifest.id) for each in found),
        ]
        student = work.answers()[0]
        digest, kept = pack(files, target)
        if kept is not None:
            note(f"your earlier archive is kept as {kept.name}")
        if lacking := [name for name in bundle.manifest.submission if name not in files]:
            note(f"warning: not in the folder: {', '.join(lacking)}", style="yellow")
        for text in notes:
            note(text, style="yellow")
        result: dict[str, object] = {"notes": len(notes)} if notes or as_json else {}
        emit(
            {
                "archive": target,
                "student": student,
                "files": " ".join(sorted(files)),
                **result,
                "sha256": digest,
            },
            as_json=as_json,
            title=f"Submission of {bundle.manifest.id}",
        )
        for line in next_steps(bundle, target.name):
            note(line)

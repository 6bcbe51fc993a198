"""``photograd course list``: which assignments there are."""

from __future__ import annotations

import typer

from ..options import DebugOption, JsonOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        name="list",
        epilog="Example: photograd course list",
        short_help="Which assignments there are.",
    )
    def list_assignments(
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """List the assignments that can be started here, with estimated hours and prerequisites."""
        from ...build.kits import find_kit, list_kits
        from ..output import emit

        manifests = [find_kit(name).manifest for name in list_kits()]
        rows = [
            {
                "id": manifest.id,
                "title": manifest.title,
                "estimated_hours": manifest.hours,
                "after": " ".join(manifest.prerequisites) or "-",
                "folder": manifest.folder_name,
            }
            for manifest in manifests
        ]
        emit({"assignments": rows}, as_json=as_json)

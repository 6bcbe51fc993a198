"""``photograd course syllabus``: weeks, estimated hours and what comes before what."""

from __future__ import annotations

from typing import Annotated

import typer

from ..options import DebugOption, JsonOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course syllabus semester",
        short_help="Weeks, estimated hours and prerequisites of a track.",
    )
    def syllabus(
        name: Annotated[
            str | None,
            typer.Argument(metavar="[TRACK]", help="Such as quarter (the default) or semester."),
        ] = None,
        track: Annotated[str | None, typer.Option(help="The same, as an option.")] = None,
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Print the weeks of a track: assignment, estimated hours, prerequisites, state."""
        from ...build.syllabus import print_syllabus

        if name is not None and track not in (None, name):
            raise typer.BadParameter(f"--track {track} and {name}: give one of them")
        print_syllabus(name or track or "quarter", as_json=as_json)

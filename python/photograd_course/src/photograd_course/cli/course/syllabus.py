"""``photograd course syllabus``: weeks, estimated hours and what comes before what."""

from __future__ import annotations

from typing import Annotated

import typer

from ..options import DebugOption, JsonOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course syllabus --track semester",
        short_help="Weeks, estimated hours and prerequisites of a track.",
    )
    def syllabus(
        track: Annotated[
            str, typer.Option(help="A track of course.toml, such as quarter or semester.")
        ] = "quarter",
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Print the weeks of a track: assignment, estimated hours, prerequisites, state."""
        from ...build.syllabus import print_syllabus

        print_syllabus(track, as_json=as_json)

"""``photograd course bundle``: one product at a time."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption, JsonOption


class Kind(str, Enum):
    """What can be bundled."""

    gradescope = "gradescope"
    hidden = "hidden"


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course bundle gradescope 01 --out 01_gradescope.zip",
        short_help="Write one zip: for Gradescope, or the sealed bundle.",
    )
    def bundle(
        kind: Annotated[Kind, typer.Argument(help="gradescope, or hidden: the sealed bundle.")],
        number: Annotated[str, typer.Argument(metavar="NN", help="Assignment, such as 01.")],
        out: Annotated[
            Path | None, typer.Option(help="The zip; by default NN_KIND.zip in this folder.")
        ] = None,
        secret_file: Annotated[
            Path | None,
            typer.Option(
                help="The course secret, made there if there is none; by default that of "
                "'course build', else course.secret/secret.txt beside the zip."
            ),
        ] = None,
        wheels: Annotated[
            Path | None, typer.Option(help="Wheels of the dependencies, for a build offline.")
        ] = None,
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Check the rules of one assignment and write one of its zips.

        The Gradescope zip holds the grader, the sealed bundle and the course secret: it is for
        instructors only.
        """
        from ...build.bundle_command import bundle_command

        written = bundle_command(kind.value, number, out, secret_file, wheels, as_json=as_json)
        if not written:
            raise typer.Exit(1)

"""``photograd course build``: from sources to what students, graders and Gradescope get."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption, JsonOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course build 01 02 --out build/course",
        short_help="Check the rules and make kits, bundles and Gradescope zips.",
    )
    def build(
        numbers: Annotated[
            list[str] | None,
            typer.Argument(metavar="[NN]...", help="Assignments; all if none is named."),
        ] = None,
        out: Annotated[
            Path | None, typer.Option(help="Output folder; by default build/course.")
        ] = None,
        no_answers: Annotated[
            bool,
            typer.Option(
                "--no-answers", help="Only the tree that may be published: stubs, no keys."
            ),
        ] = False,
        secret_file: Annotated[
            Path | None,
            typer.Option(
                help="The course secret, made there if there is none; by default "
                "$PHOTOGRAD_COURSE_SECRET, else OUT.secret/secret.txt beside the output folder. "
                "Keep it: hidden seeds and seals come from it."
            ),
        ] = None,
        update_hints: Annotated[
            bool, typer.Option("--update-hints", help="Write hints.json of each folder anew.")
        ] = False,
        wheels: Annotated[
            Path | None, typer.Option(help="Wheels of the dependencies, for the Gradescope zip.")
        ] = None,
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Build kit, public checks, sealed bundle, solution and Gradescope zip of each assignment.

        Every rule is looked at first: markers, leaks, points, and by running them the solution, the
        starter, every mutant and every alternative. A broken rule makes the build fail, with all
        findings; then nothing is written. Results of runs are kept, so an unchanged assignment
        builds at once. The same input gives the same bytes.
        """
        from ...build.command import Request, build_command

        request = Request(
            tuple(numbers or ()), out, not no_answers, secret_file, update_hints, wheels, as_json
        )
        if not build_command(request):
            raise typer.Exit(1)

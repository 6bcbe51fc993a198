"""``photograd course doctor``: what the course claims, found out by running it."""

from __future__ import annotations

from typing import Annotated

import typer

from ..options import DebugOption, JsonOption


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course doctor --quick",
        short_help="Prove the course by running it: mutants, alternatives, attacks, margins.",
    )
    def doctor(
        quick: Annotated[
            bool, typer.Option("--quick", help="Leave out the attacks, which take minutes.")
        ] = False,
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Run everything that the course rests on, and count.

        Each assignment: checks, mutants killed, alternatives accepted, margins of tolerances, and
        its solution graded in isolation; those of your own folder where $PHOTOGRAD_ASSIGNMENTS
        names one. Then the attacks on the grader, in each strict isolation mode that works here.
        Exit code 1 where anything is missing or broken.
        """
        from ...submissions.doctor import examine
        from ...submissions.doctor_report import print_examination
        from ..output import note

        result = examine(quick=quick, say=note)
        print_examination(result, as_json=as_json)
        if not result["ok"]:
            raise typer.Exit(1)

"""``photograd course grade``: one submission, or those of a whole course."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..options import DebugOption, JsonOption

Assignment = Annotated[str, typer.Argument(help="Number, such as 01.")]
Submissions = Annotated[
    Path,
    typer.Argument(
        help="An archive, a folder or the graded file; a folder or zip of submissions (as "
        "Gradescope, Canvas, Moodle, Blackboard, Brightspace or Classroom export them); a "
        "CSV table with columns student and path, and id, email and late if you like."
    ),
]
BundlePath = Annotated[
    Path | None, typer.Option(help="Built bundle, or source folder; by default assignments/NN_*.")
]
SecretFile = Annotated[
    Path | None, typer.Option(help="File with the course secret, from which hidden seeds come.")
]
Jobs = Annotated[int, typer.Option(min=1, help="Submissions graded at the same time.")]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with a run that was cut off.")]
Out = Annotated[Path | None, typer.Option(help="Folder for grades.csv, pages and records.")]
Mode = Annotated[str | None, typer.Option(help="Only this isolation mode, A to E.")]
Closed = Annotated[
    bool, typer.Option("--closed", help="After the due date: reports explain every question.")
]
GradebookPath = Annotated[
    Path | None,
    typer.Option(
        help="Gradebook or grading worksheet (CSV) that Canvas, Moodle, Blackboard or "
        "Brightspace exported: filled with the scores, it is gradebook.csv in --out."
    ),
]
GradebookColumn = Annotated[
    str | None, typer.Option(help="Its column for the scores; by default that with the title.")
]


def register(course: typer.Typer) -> None:
    """Add the command."""

    @course.command(
        epilog="Example: photograd course grade 01 submissions/ --jobs 2 --out grades",
        short_help="Grade a submission, a folder of them, or a table.",
    )
    def grade(
        assignment: Assignment,
        submission: Submissions,
        bundle: BundlePath = None,
        secret_file: SecretFile = None,
        jobs: Jobs = 1,
        resume: Resume = False,
        out: Out = None,
        mode: Mode = None,
        closed: Closed = False,
        gradebook: GradebookPath = None,
        gradebook_column: GradebookColumn = None,
        as_json: JsonOption = False,
        debug: DebugOption = False,  # noqa: ARG001
    ) -> None:
        """Judge submissions with the hidden checks, each check in a process of its own.

        A folder or table gives grades.csv, a page and a sealed record for each submission, pairs
        that resemble each other, and, where --out holds an earlier run, who changes and by which
        check. What is no submission stands in ignored.csv, with the reason.
        Exit code 3 when the grader itself failed for someone: no such grade counts as a zero.
        """
        from ...submissions.command import Request, grade_command

        request = Request(
            assignment,
            submission,
            bundle,
            secret_file,
            jobs,
            resume,
            out,
            mode,
            as_json,
            closed,
            gradebook,
            gradebook_column,
        )
        if not grade_command(request):
            raise typer.Exit(3)

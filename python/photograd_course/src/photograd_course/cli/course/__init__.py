"""``photograd course``: the graded course, for students and for instructors.

A command is a module of this package with a function ``register(course: typer.Typer) -> None`` that
adds it. Modules import what they need inside their commands, so that ``--help`` stays fast.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

import typer

# In the order in which --help lists them: what a student needs, then what an instructor needs.
COMMANDS = (
    "list",
    "start",
    "read",
    "check",
    "predict",
    "questions",
    "submit",
    "grade",
    "new",
    "build",
    "bundle",
    "syllabus",
    "doctor",
)


def register(app: typer.Typer) -> None:
    """Add the group to the application."""
    course = typer.Typer(
        name="course",
        help="The graded course: start, check and submit assignments; build and grade them.",
        no_args_is_help=True,
        rich_markup_mode="rich",
        pretty_exceptions_enable=False,
    )
    for name in COMMANDS:
        module = f"{__name__}.{name}"
        if find_spec(module) is not None:
            import_module(module).register(course)
    app.add_typer(course)

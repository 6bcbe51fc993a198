"""What a machine without the core says of the core's commands is all of them, in their order."""

from __future__ import annotations

import typer
from photograd.commands import register
from photograd_course.cli.core_commands import CORE_COMMANDS
from typer.main import get_group


def test_every_command_of_the_core_is_listed_where_the_core_is_missing() -> None:
    app = typer.Typer()
    register(app)
    assert [name for name, _ in CORE_COMMANDS] == list(get_group(app).commands)

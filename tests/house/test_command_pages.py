"""docs/commands/ says what the command line says; options mean the same in every command."""

from __future__ import annotations

import sys

import pytest

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
try:
    import command_pages
finally:
    sys.path.pop(0)

pytestmark = pytest.mark.usefixtures("core")


def test_pages_are_those_of_the_script() -> None:
    written = {
        path.name: path.read_text(encoding="utf-8") for path in command_pages.FOLDER.iterdir()
    }
    assert written == command_pages.pages()  # python docs/command_pages.py


def test_every_command_explains_itself() -> None:
    assert len(command_pages.commands()) > 20
    for command in command_pages.commands():
        assert command.examples, command.words
        assert all(example.startswith(command.words) for example in command.examples)
        for parameter in (*command.arguments, *command.options):
            assert parameter.meaning.endswith("."), f"{command.words}: {parameter.name}"

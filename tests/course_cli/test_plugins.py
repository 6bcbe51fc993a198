"""Commands come from entry points; a broken one costs a line, never the command line."""

from __future__ import annotations

import importlib.util
from typing import Any

import pytest
from photograd_course.cli import core_commands, run
from photograd_course.cli.core_commands import CORE_COMMANDS
from photograd_course.cli.entry import build_app
from typer.testing import CliRunner

GOOD = """
    def register(app):
        @app.command(epilog="Example: photograd hello")
        def hello():
            "Say hello."
            print("hello")
"""

BROKEN = {
    "missing module": ("import photograd_no_such_module", "ModuleNotFoundError"),
    "missing function": ("x = 1", "AttributeError"),
    "raises": ("def register(app):\n    raise RuntimeError('two\\nlines')", "two lines"),
    "exits": ("raise SystemExit(3)", "SystemExit: 3"),
    "half": (
        "def register(app):\n    app.command('half')(lambda: None)\n    raise ValueError('late')",
        "ValueError: late",
    ),
    "bad signature": (
        "def register(app):\n    @app.command()\n    def odd(x: 'Missing'): pass\n",
        "NameError",
    ),
    "taken name": (
        "def register(app):\n    app.command('version')(lambda: None)",
        "command already taken: version",
    ),
}


def test_a_plugin_adds_its_command(make_plugin: Any) -> None:
    app, problems = build_app([make_plugin(GOOD)])
    assert problems == []
    runner = CliRunner()
    assert runner.invoke(app, ["hello"]).stdout == "hello\n"
    shown = runner.invoke(app, ["--help"])
    assert shown.exit_code == 0
    assert "Say hello." in shown.stdout


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_plugin_is_reported_in_one_line_and_the_rest_works(
    case: str, make_plugin: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    source, part = BROKEN[case]
    plugins = [make_plugin(source, "bad"), make_plugin(GOOD, "good")]
    assert run(["--help"], plugins=plugins) == 0
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert captured.err.startswith("warning: commands of 'bad' are missing: ")
    assert part in captured.err
    assert "hello" in captured.out
    assert "half" not in captured.out.lower()
    assert run(["hello"], plugins=plugins) == 0
    assert capsys.readouterr().out == "hello\n"


def test_debug_shows_where_a_plugin_broke(
    make_plugin: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    run(["--debug", "version"], plugins=[make_plugin("1 / 0", "bad")])
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize("name", [name for name, _ in CORE_COMMANDS])
@pytest.mark.parametrize("arguments", [[], ["--help"], ["a", "--steps", "3", "-x", "--json"]])
def test_core_commands_without_the_core_say_how_to_get_it(
    name: str,
    arguments: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(core_commands, "find_spec", lambda _: None)
    assert run([name, *arguments], plugins=[]) == 2
    captured = capsys.readouterr()
    assert ("UnavailableError" in captured.out) == ("--json" in arguments)
    assert captured.err.count("\n") == 1
    assert captured.err.startswith(f"error: photograd {name}: core not installed")
    assert "pip install ." in captured.err


def test_core_commands_with_a_core_that_does_not_load_say_why(
    make_plugin: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(core_commands, "find_spec", lambda _: importlib.util.find_spec("json"))
    plugin = make_plugin("raise ImportError('no _core: build it')", "core")
    assert run(["fit"], plugins=[plugin]) == 2
    error = capsys.readouterr().err.splitlines()[-1]
    assert "core installed, but it does not load: core: ImportError: no _core: build it" in error


def test_a_plugin_command_takes_the_place_of_the_stand_in(
    make_plugin: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    source = "def register(app):\n    app.command('fit')(lambda: print('fitted'))"
    assert run(["fit"], plugins=[make_plugin(source)]) == 0
    assert capsys.readouterr().out == "fitted\n"

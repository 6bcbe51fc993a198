"""Whatever goes wrong: one line on stderr, the right exit code, a traceback only with --debug."""

from __future__ import annotations

from typing import Any

import pytest
from photograd_course.cli import run

PLUGIN = """
    from typing import Annotated
    import typer
    from photograd_course import errors
    from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit

    def register(app):
        @app.command(epilog="Example: photograd fail range")
        def fail(kind: str, debug: DebugOption = False, seed: SeedOption = 0,
                 threads: ThreadsOption = 0, as_json: JsonOption = False):
            "Fail in a chosen way."
            if kind == "range":
                raise errors.RangeError(errors.message("fit", "steps", "at least 1", "0\\n"))
            if kind == "io":
                raise errors.IoError("load: path: expected a file, got none")
            if kind == "interrupt":
                raise KeyboardInterrupt
            if kind == "bug":
                raise ZeroDivisionError("oh\\nno")
            if kind == "memory":
                raise MemoryError
            if kind == "exit":
                raise SystemExit(7)
            emit({"seed": seed, "threads": threads}, as_json=as_json)
"""

Run = Any


@pytest.fixture
def run_words(make_plugin: Any, capsys: pytest.CaptureFixture[str]) -> Run:
    plugin = make_plugin(PLUGIN)

    def run_words(*words: str) -> tuple[int, str, str]:
        code = run(words, plugins=[plugin])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run_words


@pytest.mark.parametrize(
    ("kind", "code", "line"),
    [
        ("range", 1, "error: fit: steps: expected at least 1, got 0"),
        ("io", 1, "error: load: path: expected a file, got none"),
        ("interrupt", 130, "interrupted"),
        ("bug", 1, "error: unexpected ZeroDivisionError: oh no; run with --debug for the tracebac"),
        ("memory", 1, "error: unexpected MemoryError: ; run with --debug for the traceback"),
    ],
)
def test_one_line_and_exit_code(run_words: Run, kind: str, code: int, line: str) -> None:
    got, out, err = run_words("fail", kind)
    assert got == code
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith(line)
    assert "Traceback" not in err


@pytest.mark.parametrize("words", [("fail", "bug", "--debug"), ("--debug", "fail", "range")])
def test_debug_adds_the_traceback(run_words: Run, words: tuple[str, ...]) -> None:
    code, _, err = run_words(*words)
    assert code == 1
    assert "Traceback (most recent call last)" in err
    assert err.splitlines()[-1].startswith("error: ")
    assert "run with --debug" not in err


def test_after_two_dashes_debug_is_an_argument(run_words: Run) -> None:
    code, _, err = run_words("fail", "bug", "--", "--debug")
    assert code == 2  # one argument too many
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (("fial", "bug"), "Did you mean 'fail'?"),
        (("fail",), "Missing argument"),
        (("fail", "ok", "--sed", "3"), "--seed"),
        (("fail", "ok", "--seed", "x"), "valid int"),
        (("fail", "ok", "--threads", "-1"), "--threads"),
    ],
)
def test_wrong_usage_exits_with_2_and_points_to_help(
    run_words: Run, words: tuple[str, ...], part: str
) -> None:
    code, out, err = run_words(*words)
    assert code == 2
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith("error: photograd")
    assert part in err
    assert "--help)" in err


def test_success_and_explicit_exit(run_words: Run) -> None:
    code, out, _ = run_words("fail", "ok", "--seed", "3", "--threads", "2", "--json")
    assert (code, out) == (0, '{"seed": 3, "threads": 2}\n')
    assert run_words("fail", "exit")[0] == 7


def test_every_help_text_has_an_example_and_explains_each_option(run_words: Run) -> None:
    for words in (("--help",), ("version", "--help"), ("fail", "--help")):
        code, out, err = run_words(*words)
        assert code == 0
        assert "Example: photograd" in out
        assert err == ""
    for option in ("--seed", "--threads", "--json", "--debug"):
        line = next(line for line in out.splitlines() if f"│ {option} " in line)
        assert len(line.replace("│", "").split()) > 4  # more than the option and its type

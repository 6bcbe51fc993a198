"""Whatever goes wrong: one line on stderr, the right exit code, a traceback only with --debug."""

from __future__ import annotations

import itertools
import json
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
            if kind == "disk":
                raise PermissionError(13, "Permission denied", "/dev/full")
            if kind == "late":
                emit({"seed": seed}, as_json=as_json)
                raise errors.IoError("draw: path: expected room, got none")
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
        ("memory", 1, "error: not enough memory (take smaller sizes, or close other programs)"),
        ("disk", 1, "error: Permission denied: /dev/full\n"),
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


@pytest.mark.parametrize(
    ("words", "code", "kind", "part"),
    [
        (("fail", "range"), 1, "RangeError", "fit: steps: expected at least 1, got 0"),
        (("fail", "bug"), 1, "ZeroDivisionError", "unexpected ZeroDivisionError: oh"),
        (("fail", "interrupt"), 130, "Interrupted", "interrupted"),
        (("fail", "exit"), 7, "Exit", "ended with exit code 7"),
        (("fail",), 2, "UsageError", "Missing argument"),
        (("fail", "ok", "--seed", str(2**63)), 2, "UsageError", "--seed"),
        (("fail", "ok", "--threads", "1000000000000"), 2, "UsageError", "--threads"),
        (("fial",), 2, "UsageError", "Did you mean 'fail'?"),
        (("fit", "photos"), 2, "UnavailableError", "photograd fit: core"),
        (("course", "chekc"), 2, "UsageError", "Did you mean 'check'?"),
        (("course", "check", "nothing"), 1, "", "nothing"),
    ],
)
def test_with_json_an_error_is_an_object_on_stdout_and_a_line_on_stderr(
    run_words: Run, words: tuple[str, ...], code: int, kind: str, part: str
) -> None:
    plain = run_words(*words)
    got, out, err = run_words(*words, "--json")
    assert (got, err) == (plain[0], plain[2])
    assert (got, plain[1], out.count("\n")) == (code, "", 1)
    error = json.loads(out)["error"]
    assert error["exit_code"] == code
    assert kind in error["type"]
    assert part in error["message"]


def test_a_result_in_json_is_not_followed_by_an_error(run_words: Run) -> None:
    code, out, err = run_words("fail", "late", "--json")
    assert (code, out) == (1, '{"seed": 0}\n')
    assert err.splitlines()[-1].startswith("error: draw: path")
    assert json.loads(run_words("fail", "range", "--json")[1])["error"]["type"] == "RangeError"
    assert run_words("fail", "range", "--", "--json")[1] == ""  # an argument, and no option


def test_the_largest_seed_and_number_of_threads_are_accepted(run_words: Run) -> None:
    words = ("--seed", str(2**63 - 1), "--threads", "4096", "--json")
    assert run_words("fail", "ok", *words)[1] == f'{{"seed": {2**63 - 1}, "threads": 4096}}\n'


def test_success_and_explicit_exit(run_words: Run) -> None:
    code, out, _ = run_words("fail", "ok", "--seed", "3", "--threads", "2", "--json")
    assert (code, out) == (0, '{"seed": 3, "threads": 2}\n')
    assert run_words("fail", "exit")[0] == 7


def test_paragraphs_of_help_are_broken_by_the_width_alone(
    run_words: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    code, out, _ = run_words("course", "check", "-h")
    assert code == 0
    assert out == run_words("course", "check", "--help")[1]
    lines = [line.strip() for line in out.splitlines()]
    start = lines.index(next(line for line in lines if line.startswith("Checks run in")))
    # The next line's first word did not fit into any line but the last.
    for line, following in itertools.pairwise(lines[start : lines.index("", start)]):
        assert len(line) + 1 + len(following.split()[0]) > 78


def test_every_help_text_has_an_example_and_explains_each_option(run_words: Run) -> None:
    for words in (("--help",), ("version", "--help"), ("fail", "--help")):
        code, out, err = run_words(*words)
        assert code == 0
        assert "Example: photograd" in out
        assert err == ""
    for option in ("--seed", "--threads", "--json", "--debug"):
        line = next(line for line in out.splitlines() if f"│ {option} " in line)
        assert len(line.replace("│", "").split()) > 4  # more than the option and its type

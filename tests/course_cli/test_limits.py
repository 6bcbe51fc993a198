"""Limits of input files: regular files only, bounded TOML, and the variables that raise a limit."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path

import pytest
from photograd_course.assignment.toml import read_toml
from photograd_course.cli import run
from photograd_course.errors import IoError, RangeError
from photograd_course.input_files import read_file, read_text, require_file
from photograd_course.limits import LIMITS, Limit
from photograd_course.toml_limits import parse_toml, without_strings

from support.tree import ROOT


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (".".join("a" * 50_000) + " = 1", "dotted keys of at most 16 parts, got 50000"),
        ("[" + ".".join("a" * 50_000) + "]", "dotted keys of at most 16 parts, got 50000"),
        ("x = {" + " . ".join("a" * 17) + " = 1}", "at most 16 parts, got 17"),
        ('"b"' + ".'a'" * 16 + " = 1", "at most 16 parts, got 17"),
        ("a = " + "[" * 33 + "]" * 33, "at most 32 brackets within each other, got 33"),
        ("a = " + "{a = " * 5000 + "1" + "}" * 5000, "at most 32 brackets"),
        ("a = " + "9" * 5000, "expected TOML"),
        ('a = """' + '\\"' * 50_000, "expected TOML, got Unterminated string"),
        ("a = 1 # " + "x" * (4 << 20), "at most 4,194,304 bytes of TOML"),
    ],
)
def test_toml_beyond_a_limit_is_refused_before_it_is_parsed(text: str, words: str) -> None:
    with pytest.raises(IoError) as caught:
        parse_toml("read_it", "a.toml", text)
    assert str(caught.value).startswith("read_it: a.toml: expected ")
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        ".".join("a" * 16) + " = 1.5",
        "a = " + "[" * 32 + "]" * 32,
        'a = "' + "." * 100 + '" # ' + "[." * 100,
        'a = """\n' + "[." * 100 + '\\"""\n"""" # x\nb = \'\'\'"""' + ".[" * 100 + "\n''''\nc = 1",
        "a = '\\' # " + "[." * 50 + '\nb = "\\"" # ' + "[." * 50,
        "a = [" + "0.5, -1.25e-3,\n" * 1000 + "]",
        "a = [-9223372036854775808, 9223372036854775807, 0xFF, 1979-05-27T07:32:00Z]",
    ],
)
def test_what_is_within_the_limits_is_parsed_as_ever(text: str) -> None:
    assert parse_toml("f", "a.toml", text) == tomllib.loads(text)


def test_strings_and_comments_are_blanked_out_in_place() -> None:
    text = "a = \"#\" # b\n\"c d\" = '''x\n[y'''\n"
    assert without_strings(text) == "a = ___ ___\n_____ = ____\n_____\n"


def test_a_size_may_be_given_or_set_in_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "a = 1 # " + "x" * 100
    with pytest.raises(IoError, match="at most 64 bytes of TOML, got 108"):
        parse_toml("f", "a.toml", text, most=64)
    monkeypatch.setenv("PHOTOGRAD_MAX_TOML_BYTES", "100")
    with pytest.raises(IoError, match="set PHOTOGRAD_MAX_TOML_BYTES to a larger number"):
        parse_toml("f", "a.toml", text)
    monkeypatch.setenv("PHOTOGRAD_MAX_TOML_BYTES", "108")
    assert parse_toml("f", "a.toml", text) == {"a": 1}


@pytest.mark.parametrize("value", ["", "0", "-1", "1e9", "many", "9" * 30, "\u0661"])
def test_a_limit_that_is_no_number_is_refused(monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    monkeypatch.setenv("PHOTOGRAD_MAX_TEST", value)
    with pytest.raises(RangeError, match="PHOTOGRAD_MAX_TEST: expected a positive whole number"):
        Limit("PHOTOGRAD_MAX_TEST", 5, "things").value()


@pytest.mark.skipif(os.name != "posix", reason="FIFOs and devices are of POSIX systems")
def test_inputs_are_regular_files(tmp_path: Path) -> None:
    fifo, folder, link = tmp_path / "a.toml", tmp_path / "folder", tmp_path / "link"
    os.mkfifo(fifo)
    folder.mkdir()
    for path, kind in ((fifo, "a FIFO"), (folder, "a folder"), (Path("/dev/zero"), "a device")):
        link.unlink(missing_ok=True)
        link.symlink_to(path)
        for name in (path, link):
            with pytest.raises(IoError, match=f"f: {name}: expected a file, got {kind}"):
                read_file("f", name)
    with pytest.raises(IoError, match="got a FIFO"):
        read_toml(fifo)
    for missing in (tmp_path / "none", tmp_path / "a\0b"):
        with pytest.raises(IoError):
            read_text("f", missing)


def test_a_link_to_a_regular_file_is_followed(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"x\r\ny")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    assert require_file("f", tmp_path / "b") == 4
    assert read_file("f", tmp_path / "b", 2) == b"x\r"
    assert read_text("f", tmp_path / "b") == "x\ny"


def test_the_readme_and_the_help_list_all_limits(capsys: pytest.CaptureFixture[str]) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert run(["--help"]) == 0
    shown = capsys.readouterr().out
    for limit in LIMITS:
        assert f"| `{limit.variable}` | {limit.default:,} | {limit.unit}" in readme
        assert limit.variable in shown
    assert readme.count("PHOTOGRAD_MAX_") == len(LIMITS)

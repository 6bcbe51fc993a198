"""The README tells the truth: its Python runs, its commands exist, its paths too.

Above each fenced block stands a comment that says how it is checked:
`<!-- check: run -->` Python, run in order in one namespace; `<!-- check: commands -->` shell lines
whose command and options must exist; `<!-- check: text -->` anything else.
"""

from __future__ import annotations

import contextlib
import functools
import io
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from photograd_course.cli import run

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "tools"))
try:
    import ready
finally:
    sys.path.pop(0)

PAGES = ["README.md", "CONTRIBUTING.md", "docs/architecture.md"]
SETTINGS = {"PHOTOGRAD_ASSIGNMENTS"}
KINDS = {"run", "commands", "text"}
BLOCK = re.compile(r"(?:^<!-- check: (\w+) -->\n)?^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PATH = re.compile(r"`((?:cpp|python|tests|docs|bench|tools|assignments)/[\w./-]*)`")


def blocks(page: str, kind: str | None = None) -> list[tuple[str, str]]:
    """(kind, text) of the fenced blocks of a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = [(check, body) for check, _, body in BLOCK.findall(text)]
    assert 2 * len(found) == len(re.findall(r"^```", text, re.MULTILINE)), "a fence is not closed"
    return [block for block in found if kind in {None, block[0]}]


def command_lines() -> list[str]:
    lines = [
        line for page in PAGES for _, body in blocks(page, "commands") for line in body.splitlines()
    ]
    return [line for line in lines if line.strip() and not line.startswith("#")]


@functools.cache
def help_of(command: str) -> str | None:
    """What `photograd COMMAND --help` prints, or None where there is no such command.

    In this process: `tests/course_cli/test_process.py` proves that the installed command runs it.
    """
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(io.StringIO()):
        code = run([*command.split(), "--help"])
    return printed.getvalue() if code == 0 else None


def faults(line: str) -> list[str]:
    """What is wrong with a line of shell: a command, option or path that does not exist."""
    words = shlex.split(line, comments=True)
    if words[0] == "./run":
        usage = subprocess.run(
            ["./run", "help"], cwd=ROOT, capture_output=True, text=True, check=True
        )
        known = set(re.findall(r"^\./run (\w+)|^ {4}(--\w+)", usage.stdout, re.MULTILINE))
        names = {name for pair in known for name in pair}
        wrong = [word for word in words[1:] if word not in names and not (ROOT / word).exists()]
        return [f"./run knows no {word}" for word in wrong if not word.isdigit()]
    if words[0] == "photograd":
        name = " ".join(words[1 : 3 if words[1] == "course" else 2])
        page = help_of(name)
        if page is None:
            return [f"photograd has no command {name}"]
        return [f"{name} has no {w}" for w in words if w.startswith("--") and w not in page]
    if words[0] == "export":
        return [] if words[1].partition("=")[0] in SETTINGS else [f"no setting {words[1]}"]
    if words[0] in {"pip", "cmake", "ctest", "git"}:
        places = [word.partition("[")[0] for word in words if "/" in word]
        return [f"no {place}" for place in places if not (ROOT / place).exists()]
    return (
        []
        if (ROOT / words[0]).exists() or words[0].startswith(".venv/bin/")
        else [f"no {words[0]}"]
    )


@pytest.mark.parametrize("page", PAGES)
def test_every_block_says_how_it_is_checked(page: str) -> None:
    assert [body for kind, body in blocks(page) if kind not in KINDS] == []


@pytest.mark.parametrize("line", command_lines())
def test_command_exists(line: str) -> None:
    assert faults(line) == []


@pytest.mark.usefixtures("core")
@pytest.mark.parametrize("page", PAGES)
def test_python_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    names: dict[str, Any] = {}
    for number, (_, body) in enumerate(blocks(page, "run")):
        # What the page promises to print as True is asserted.
        code = re.sub(r"print\((.*)\)(?=\s+# True)", r"assert \1", body)
        exec(compile(code, f"{page} block {number}", "exec"), names)


@pytest.mark.parametrize("page", PAGES)
def test_paths_exist(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    assert [name for name in PATH.findall(text) if not (ROOT / name).exists()] == []


def test_the_line_about_what_is_ready_is_the_generated_one() -> None:
    (line,) = [
        text
        for text in (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
        if text.startswith(ready.START)
    ]
    assert line == ready.ready_line()  # python tools/ready.py --write


def test_what_does_not_exist_is_seen() -> None:
    assert faults("./run dance") == ["./run knows no dance"]
    assert faults("./run test --loud") == ["./run knows no --loud"]
    assert faults("photograd dance --help") == ["photograd has no command dance"]
    assert faults("photograd course dance") == ["photograd has no command course dance"]
    assert faults("photograd course check 01 --loud") == ["course check has no --loud"]
    assert faults("photograd version --loud") == ["version has no --loud"]

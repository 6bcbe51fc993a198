"""The entry point `./run`: what it lists, refuses, and says where it cannot install."""

from __future__ import annotations

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from support.tree import ROOT

COMMANDS = ["demo", "test", "lint", "bench", "fuzz", "wheel", "release", "docs", "clean", "help"]


def call(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        words, cwd=ROOT, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
    )


def shell(script: str) -> subprocess.CompletedProcess[str]:
    """Run lines of bash with the functions of tools/setup.sh at hand."""
    return call(
        "bash", "-euo", "pipefail", "-c", f"say() {{ echo $*; }}\n. tools/setup.sh\n{script}"
    )


def test_help_lists_every_command() -> None:
    page = call("./run", "help")
    assert page.returncode == 0
    listed = [line.split()[1] for line in page.stdout.splitlines() if line.startswith("./run ")]
    assert listed == COMMANDS
    assert call("./run").stdout == page.stdout


@pytest.mark.parametrize("words", [("dance",), ("lint", "--loud")])
def test_an_unknown_word_ends_with_status_2(words: tuple[str, ...]) -> None:
    answer = call("./run", *words)
    assert answer.returncode == 2
    assert words[-1] in answer.stderr


def test_without_root_the_missing_packages_are_named_with_status_2() -> None:
    answer = shell("is_there() { return 1; }; apt_prefix() { return 1; }; ensure_system dev")
    assert answer.returncode == 2
    for word in (
        "Embree 3 or 4",
        "libembree-dev",
        "libopenvdb-dev",
        "doctest-dev",
        "apt-get install",
    ):
        assert word in answer.stderr


def test_only_what_is_missing_is_named() -> None:
    answer = shell("is_there() { [[ $1 != *zlib* ]]; }; missing_needs demo")
    assert answer.stdout == "zlib | zlib1g-dev\n"
    assert (
        shell("is_there() { return 0; }; apt_prefix() { return 1; }; ensure_system dev").returncode
        == 0
    )


def test_probes_see_what_is_there_and_what_is_not() -> None:
    assert shell("is_there command:bash && is_there python:venv").returncode == 0
    assert shell("is_there command:no-such-tool").returncode == 1
    assert shell("is_there header:no/such/header.h").returncode == 1
    assert shell("is_there library:libno_such_library*").returncode == 1


def test_a_changed_source_changes_the_stamp(tmp_path: Path) -> None:
    source = tmp_path / "a.cpp"
    script = f"hash_of {tmp_path}"
    source.write_text("int a;", encoding="utf-8")
    before = shell(script).stdout
    assert shell(script).stdout == before != ""
    source.write_text("int b;", encoding="utf-8")
    assert shell(script).stdout != before


def test_requirements_come_from_the_project_files() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    lines = call("python3", "tools/requirements.py", "build", "dev").stdout.splitlines()
    assert set(project["build-system"]["requires"]) < set(lines)
    assert set(project["project"]["optional-dependencies"]["dev"]) < set(lines)


def test_what_all_holds() -> None:
    """Each part is offered by name; continuous integration runs them, or the rest is named."""
    script = (ROOT / "run").read_text(encoding="utf-8")
    parts = re.findall(r"^PARTS=\((.*)\)$", script, re.MULTILINE)[0].split()
    assert parts == ["docs", "modes", "mutants"]
    assert all(f'" {part} "*' in script for part in parts)  # each does something
    page = call("./run", "help").stdout
    assert all(part in page for part in [*parts, "--all", "--with", "--asan", "--tsan"])
    calls = (ROOT / ".ci/run").read_text(encoding="utf-8")
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for part in set(parts) - set(re.findall(r"--with (\w+)", calls)):
        assert re.search(rf"`./run test --with {part}` adds \d+ minutes", text)
    assert re.search(r"`./run test --asan` and `./run test --tsan` take about \d+ minutes", text)


def test_an_unknown_part_is_refused() -> None:
    for words in (("--with", "magic"), ("--with",)):
        answer = call("./run", "test", *words)
        assert answer.returncode == 2
        assert "expected one of docs modes mutants" in answer.stderr


def test_scripts_parse_and_may_be_executed() -> None:
    for name in ("run", ".ci/run"):
        assert os.access(ROOT / name, os.X_OK)
    assert call("bash", "-n", "run", ".ci/run", "tools/setup.sh").returncode == 0

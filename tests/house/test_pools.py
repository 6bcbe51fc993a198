"""Two pools of tests: what runs in which, and what is said at the end."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from tools import pools

from support.tree import ROOT

WAITING = list(pools.WAITING)


def collected(words: list[str]) -> dict[str, list[str]]:
    return {pool.name: pool.paths for pool in pools.split(words)[0]}


@pytest.mark.parametrize(
    ("words", "computing", "waiting"),
    [
        ([], ["tests"], WAITING),
        (["-k", "bits", "-x"], ["tests"], WAITING),
        (["tests/house"], ["tests/house"], None),
        (["tests/house", "tests/course"], ["tests/house", "tests/course"], WAITING),
        ([WAITING[0]], None, [WAITING[0]]),
        (
            ["tests/course/isolation/test_modes.py::test_x", "tests/ops"],
            ["tests/ops"],
            ["tests/course/isolation/test_modes.py::test_x"],
        ),
    ],
)
def test_paths_go_to_their_pool(
    words: list[str], computing: list[str] | None, waiting: list[str] | None
) -> None:
    found = {"computing": computing, "waiting": waiting}
    assert collected(words) == {name: paths for name, paths in found.items() if paths}


def test_options_go_to_both_pools() -> None:
    assert pools.split(["-k", "bits", "tests/house", "--exitfirst"])[1] == [
        "-k",
        "bits",
        "--exitfirst",
    ]
    assert all((ROOT / place).exists() for place in WAITING)


def test_the_end_counts_all() -> None:
    assert pools.last_line({"passed": 3, "skipped": 1, "failed": 0}, 7.2) == (
        "3 passed, 1 skipped in 7 s"
    )
    tests = {f"t{n}": [float(n), 1.0] for n in range(30)}
    table = pools.dearest(tests)
    assert len(table) == 21
    assert table[1].split() == ["29.0", "1.0", "t29"]
    assert [pools.status_of(found) for found in ([0, 5], [5, 5], [0, 1], [0, -9])] == [0, 5, 1, 9]


def run_pools(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "tools/pools.py"), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_both_pools_run_and_are_added_up(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text("from tests.conftest import pytest_configure\n")
    (tmp_path / "test_a.py").write_text("def test_a():\n    assert sum(range(3_000_000)) > 0\n")
    (tmp_path / "test_b.py").write_text("def test_b():\n    assert False\n")
    waits = (
        "tests/course/isolation/test_program.py::test_the_list_of_files_is_what_the_program_imports"
    )
    project = ROOT / "pyproject.toml"
    cache = ["-o", f"cache_dir={tmp_path / 'cache'}"]
    done = run_pools(str(tmp_path), waits, f"--config-file={project}", "-n", "0", *cache)
    assert done.returncode == 1, done.stdout + done.stderr
    assert done.stdout.count("test session starts") == 2
    last = done.stdout.splitlines()[-1]
    assert re.fullmatch(r"1 failed, 2 passed in \d+ s", last), done.stdout
    assert "the dearest tests" in done.stdout
    assert re.search(r"^ +[\d.]+ +[\d.]+  \S*test_a.py::test_a$", done.stdout, re.MULTILINE)

"""README's lines for instructors, in an install that is not editable: the wheel and its extras."""

from __future__ import annotations

import csv
import os
import shlex
import subprocess
from pathlib import Path

import pytest
from tests.house.test_readme import blocks

from course.student.laptop import build_wheel, laptop_with, link
from support.missing import missing, need_module
from support.tree import ROOT

EXTRAS = {
    "pyseccomp": "pyseccomp",
    "latex2mathml": "latex2mathml",
    "mdit-py-plugins": "mdit_py_plugins",
}


def printed() -> list[list[str]]:
    """The words of each line of README's block for instructors."""
    (block,) = [body for _, body in blocks("README.md", "commands") if "course grade" in body]
    return [shlex.split(line, comments=True) for line in block.splitlines()]


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("instructor")
    for module in EXTRAS.values():
        need_module(module, by_choice=True)
    own = laptop_with(build_wheel(folder / "wheels"), folder).python
    (site,) = (folder / "env").glob("lib/python3*/site-packages")
    (site / "sitecustomize.py").unlink()  # here it is no laptop
    for name in EXTRAS:
        link(name, site)
    return own


def call(python: Path, words: list[str], cwd: Path) -> subprocess.CompletedProcess[str]:
    settings = {"PHOTOGRAD_ASSIGNMENTS": str(ROOT / "assignments"), "HOME": str(cwd)}
    return subprocess.run(
        [str(python), "-m", "photograd_course", *words],
        cwd=cwd,
        env={"PATH": os.environ["PATH"], **settings},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_first_lines_install_and_say_where_assignments_are() -> None:
    install, export, release = printed()[:3]
    assert install[:3] == ["pip", "install", "--constraint"]
    assert install[-1] == "./python/photograd_course[grader,handouts]"
    assert export == ["export", "PHOTOGRAD_ASSIGNMENTS=$PWD/assignments"]
    assert release == ["./run", "release"]


@pytest.mark.slow
def test_the_commands_run(python: Path, tmp_path: Path) -> None:
    """With the first assignment, which is the smallest, in the place of all and of another."""
    lines = {words[2]: words[1:] for words in printed() if words[0] == "photograd"}
    assert list(lines) == ["build", "grade", "doctor"]
    (tmp_path / "submissions").mkdir()
    pack = ["course", "submit", "00", "--dir", "work", "--out", "submissions/first.zip"]
    build = [*lines["build"][:2], "00", *lines["build"][2:]]
    grade = ["00" if word == "01" else word for word in lines["grade"]]
    for words in (["course", "start", "00", "work"], pack, build, grade):
        done = call(python, words, tmp_path)
        if words is grade and done.returncode == 3:
            missing("no mode of isolation works here", by_choice=True)
        assert done.returncode == 0, f"{words}: {done.stderr}"
    assert (tmp_path / "build" / "course").is_dir()
    (row,) = csv.DictReader((tmp_path / "grades" / "grades.csv").read_text().splitlines())
    assert float(row["score"]) == 0

"""A class of thirty through all assignments, graded under the oldest and the newest NumPy.

What decides a grade is the submission: not the layout of an export, not the versions of the grading
machine. Each assignment comes in the layout of another learning system.
"""

from __future__ import annotations

import csv
import os
import subprocess
from fractions import Fraction
from pathlib import Path

import pytest
from photograd_course.assignment.manifest import read_manifest

from course.building.test_gradescope_container import interpreter
from support.tree import ROOT

from .class_of_30 import HandIn, class_of_30
from .layouts import LAYOUTS

pytestmark = pytest.mark.exhaustive
ASSIGNMENTS = sorted(path.parent for path in (ROOT / "assignments").glob("*/assignment.toml"))
VERSIONS = {"oldest": ("3.10", "numpy==1.24.*"), "newest": ("3.13", "numpy")}


def install(folder: Path, version: str, numpy: str) -> Path:
    """The grader in an environment of its own; its command."""
    subprocess.run([interpreter(version), "-m", "venv", folder], check=True)
    course = f"{ROOT / 'python' / 'photograd_course'}[grader,handouts]"
    pip = [folder / "bin" / "python", "-m", "pip", "install", "-q", course, numpy]
    subprocess.run(pip, check=True, capture_output=True)
    return folder / "bin" / "photograd"


@pytest.fixture(scope="session")
def graders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """By age, the command of each environment."""
    top = tmp_path_factory.mktemp("graders")
    return {age: install(top / age, *wanted) for age, wanted in VERSIONS.items()}


def grade(command: Path, number: str, handed_in: Path, out: Path) -> bytes:
    """The table of grades."""
    words = [command, "course", "grade", number, handed_in, "--out", out, "--jobs", "2"]
    environment = {**os.environ, "PHOTOGRAD_ASSIGNMENTS": str(ROOT / "assignments")}
    environment.pop("PYTHONPATH", None)
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return (out / "grades.csv").read_bytes()


def row_of(rows: list[dict[str, str]], each: HandIn) -> dict[str, str] | None:
    """The row of one student, by number where the layout has one."""
    found = [row for row in rows if str(each.number) in f"{row['id']} {row['student']}"]
    return found[0] if len(found) == 1 else None


def faults(rows: list[dict[str, str]], each: HandIn) -> list[str]:
    """What is wrong with the row of one student."""
    row = row_of(rows, each)
    who = f"{each.kind} ({each.student}, {each.number})"
    if row is None:
        return [] if not each.files else [f"{who} has no row"]
    score = Fraction(row["score"])
    found = []
    if each.score is not None and score != each.score:
        found.append(f"{who} got {row['score']} instead of {each.score}")
    if each.at_most is not None and not 0 < score < each.at_most:
        found.append(f"{who} got {row['score']}: not between nothing and {each.at_most}")
    if each.score is None and each.at_most is None and (score or not row["notes"]):
        found.append(f"{who} got {row['score']} and is told {row['notes']!r}")
    return found


@pytest.mark.parametrize("folder", ASSIGNMENTS, ids=lambda path: path.name)
def test_a_class_gets_the_grades_that_it_earns_on_any_machine(
    folder: Path, graders: dict[str, Path], tmp_path: Path
) -> None:
    layout = LAYOUTS[ASSIGNMENTS.index(folder) % len(LAYOUTS)]
    class_ = class_of_30(folder)
    handed_in = tmp_path / "handed in"
    handed_in.mkdir()
    layout(class_, handed_in)
    number = read_manifest(folder).id
    tables = {
        age: grade(command, number, handed_in, tmp_path / age) for age, command in graders.items()
    }
    rows = list(csv.DictReader(tables["newest"].decode("utf-8-sig").splitlines()))
    assert [text for each in class_ for text in faults(rows, each)] == []
    if layout.__name__ == "canvas":
        assert {row["id"] for row in rows if row["late"]} == {
            str(each.number) for each in class_ if each.late
        }
    assert tables["oldest"] == tables["newest"]
    if number != "00":  # one line is no evidence
        copied = (tmp_path / "newest" / "similarity.csv").read_text("utf-8")
        assert any(each.student.split()[0] in copied for each in class_ if each.kind == "copied")

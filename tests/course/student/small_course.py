"""A course of three small assignments, each of which builds upon the earlier ones."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest
from photograd_course.build.regions import strip_solution
from photograd_course.cli import run

from support.tree import ROOT

TOY = ROOT / "tests" / "course" / "fixture_course" / "90_toy"
MANIFEST = """
id = "{number}"
name = "{name}"
title = "{name}"
module = "{name}"
submission = ["{name}.py", {brings}, "answers.toml"]
prerequisites = ["90"]
hours = 1
imports = ["numpy"]
points = {{ code = 2, questions = 2 }}

[[tasks]]
id = "{number}.1"
title = "The sum"
functions = ["{function}"]

[[tasks]]
id = "{number}.2"
title = "A number"
functions = ["plain"]
"""
MODULE = '''"""Builds upon earlier assignments."""

{imports}


def {function}(w, x):
    """A multiple of the weighted sum."""
    # >>> solution {number}.1
    return {value}
    # <<< solution


def plain():
    """Seven, without help."""
    # >>> solution {number}.2
    return 7.0
    # <<< solution
'''
CHECKS = '''"""Checks."""

import numpy as np
from photograd_course.grading import Number, Tolerance, checks_for

check = checks_for(tolerance=Tolerance(1e-12, "exact"))


@check("{number}.1.sum", points=1, calls=("{function}",), hint="of {number}: multiply")
def multiple(t):
    """It is a multiple."""
    got = t.call("{function}", np.ones(3), np.zeros(3), returns=Number())
    t.close("s", got, {expected})
'''
PLAIN = '''"""Checks."""

from photograd_course.grading import Number, Tolerance, checks_for

check = checks_for(tolerance=Tolerance(1e-12, "exact"))


@check("{number}.2.plain", points=1, calls=("plain",))
def seven(t):
    """It is seven."""
    t.close("seven", t.call("plain", returns=Number()), 7.0)
'''
QUESTIONS = """
[[prediction]]
id = "{number}.p1"
points = 2
text = "Up or down?"
options = ["up", "down"]
answer = "a"
because = "It is so."
where = "section 1"
"""
WRONG = "    return float(np.sum(w * np.exp(x))) + 1.0\n"


def make_course(root: Path) -> Path:
    """90_toy, 91_twice (brings toy), 92_thrice (brings twice and toy) in a folder."""
    shutil.copytree(TOY, root / "90_toy")
    _make(root / "91_twice", "91", "from toy import weighted_sum", "2 * weighted_sum(w, x)", 6.0)
    imports = "from twice import double"
    _make(root / "92_thrice", "92", imports, "1.5 * double(w, x)", 9.0)
    return root


def _make(folder: Path, number: str, imports: str, value: str, expected: float) -> None:
    name = folder.name[3:]
    words = {
        "number": number,
        "name": name,
        "function": {"twice": "double", "thrice": "treble"}[name],
        "imports": imports,
        "value": value,
        "expected": expected,
        "brings": {"twice": '"toy.py"', "thrice": '"twice.py", "toy.py"'}[name],
    }
    texts = {
        "assignment.toml": MANIFEST,
        f"{name}.py": MODULE,
        "questions.toml": QUESTIONS,
        "checks/__init__.py": '"""Checks."""\n',
        "checks/task_1.py": CHECKS,
        "checks/task_2.py": PLAIN,
    }
    for path, text in texts.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text.format(**words), encoding="utf-8")
    (folder / "handout.md").write_text(f"# {name}\n\n## 1. The sum\n\nWrite it.\n", "utf-8")


class Semester:
    """A student's folder, and the commands that are given in it."""

    def __init__(self, home: Path, course: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.home = home
        self._course = course
        self._capsys = capsys

    def solution(self, name: str) -> str:
        """The finished module of an assignment, such as "90_toy"."""
        return (self._course / name / f"{name[3:]}.py").read_text("utf-8")

    def stub(self, name: str) -> str:
        """The same as the kit has it."""
        return strip_solution(self.solution(name), f"{name[3:]}.py")

    def put(self, path: str, text: str) -> Path:
        """Write a file of the student's."""
        place = self.home / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")
        return place

    def text(self, path: str) -> str:
        """What a file of the student's holds."""
        return (self.home / path).read_text("utf-8")

    def files(self) -> Mapping[str, bytes]:
        """All files of the student's."""
        paths = sorted(path for path in self.home.rglob("*") if path.is_file())
        return {path.relative_to(self.home).as_posix(): path.read_bytes() for path in paths}

    def course(self, *words: str, code: int = 0) -> str:
        """`photograd course WORDS`; all that it says, in one line."""
        self._capsys.readouterr()
        assert run(["course", *words]) == code, self._capsys.readouterr()
        said = self._capsys.readouterr()
        return " ".join(f"{said.out} {said.err}".split())

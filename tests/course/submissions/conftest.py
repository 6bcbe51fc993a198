"""The toy assignment as a bundle that may be graded on any machine, and submissions for it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.submissions.load import Loaded, load
from photograd_course.submissions.one import Case, grade_one
from photograd_course.submissions.report import Report
from photograd_course.submissions.source import Source
from photograd_course.submissions.workers import Workers, isolated_workers

TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"

QUESTIONS = """
[[prediction]]
id = "90.p1"
points = 1
text = "Will it fall?"
options = ["yes", "no"]

[[diagnosis]]
id = "90.d1"
points = 2
text = "Which?"
options = ["one", "two", "three"]
answer = "b"

[[generated]]
id = "90.g1"
points = 2
text = "What is s for w = {w}?"
draw = { w = [2, 3, 5] }
answer = "doubled"

[[concept]]
id = "90.c1"
points = 1
text = "How many?"
answer = 12.5
tolerance = 0.01
"""

ANSWERS_PY = '''"""Keys."""
import numpy as np


def doubled(reference, w):
    return 2 * reference.weighted_sum(np.array([w]), np.zeros(1))
'''


QUICK_CHECKS = '''"""One check."""
import numpy as np
from photograd_course.grading import Number, Tolerance, check


@check("90.1.value", points=3, calls=("weighted_sum",), seconds=2.0,
       tolerance=Tolerance(1e-12, "rounding"))
def value(t):
    """The sum is right."""
    w = t.rng.uniform(1.0, 2.0, 5)
    s = t.call("weighted_sum", w, np.full(5, np.log(2.0)), returns=Number())
    t.close("s", s, w.sum() / 2)
'''


@pytest.fixture(scope="session")
def toy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its source folder, with questions, and with verdicts allowed to rest on mode E."""
    folder = tmp_path_factory.mktemp("bundle") / "90_toy"
    shutil.copytree(TOY, folder, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "questions.toml").write_text(QUESTIONS)
    (folder / "answers.py").write_text(ANSWERS_PY)
    manifest = folder / "assignment.toml"
    lines = [x for x in manifest.read_text().splitlines() if not x.startswith("minimum_mode")]
    text = "\n".join(['minimum_mode = "E"', *lines]).replace("questions = 0", "questions = 6")
    manifest.write_text(text)
    return folder


@pytest.fixture(scope="session")
def quick(toy: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same with one check and little time, for many submissions."""
    folder = tmp_path_factory.mktemp("quick") / "90_toy"
    shutil.copytree(toy, folder)
    shutil.rmtree(folder / "checks")
    (folder / "checks").mkdir()
    (folder / "checks" / "__init__.py").write_text("")
    (folder / "checks" / "task_1.py").write_text(QUICK_CHECKS)
    manifest = folder / "assignment.toml"
    lines = [x for x in manifest.read_text().splitlines() if not x.startswith("limits")]
    tables = "[limits]\nseconds = 20\ncpu_seconds = 10\n"
    manifest.write_text("\n".join(lines) + "\n" + tables)
    return folder


@pytest.fixture(scope="session")
def bundle(toy: Path) -> Bundle:
    return read_folder(toy, secret=b"a secret of the tests")


@pytest.fixture(scope="session")
def small(bundle: Bundle) -> Bundle:
    """With one public and one hidden check only, where that is enough."""
    kept = tuple(c for c in bundle.checks if c.id in {"90.1.value", "90.1.hidden"})
    assert len(kept) == 2
    return replace(bundle, checks=kept)


@pytest.fixture(scope="session")
def loaded(toy: Path) -> Loaded:
    return load("90", toy)


@pytest.fixture(scope="session")
def solution() -> str:
    return (TOY / "toy.py").read_text()


@pytest.fixture(scope="session")
def workers(bundle: Bundle) -> Iterator[Workers]:
    with isolated_workers(bundle.manifest, "E") as plain:
        yield plain


@pytest.fixture
def grade_text(bundle: Bundle, workers: Workers, tmp_path: Path) -> Callable[..., Report]:
    """Grade a module's text, and other files by name; another bundle where given."""

    def grade(text: str, other: Bundle | None = None, **files: str) -> Report:
        judged = other or bundle
        folder = tmp_path / "submission"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        (folder / "toy.py").write_text(text)
        for name, content in files.items():
            (folder / name.replace("__", ".")).write_text(content)
        taken = Source("Ada", folder).take(judged.manifest)
        return grade_one(Case("Ada", taken, judged, "0" * 64), workers)

    return grade

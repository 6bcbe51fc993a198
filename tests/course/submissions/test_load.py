"""Right solutions keep their points on a machine that is crowded and busy."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.submissions.one import Case, grade_one
from photograd_course.submissions.submission import Submission
from photograd_course.submissions.workers import IsolatedWorkers
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.self_test import self_test

from support.missing import missing
from support.tree import ROOT

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="isolation needs Linux")
TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"
ASSIGNMENTS = sorted(path.parent for path in (ROOT / "assignments").glob("*/assignment.toml"))
SECRET = b"seeds of hidden checks on a busy day"
LOOP = [sys.executable, "-I", "-S", "-c", "while True: pass"]


@contextmanager
def crowd(sleepers: int, loops: int = 2) -> Iterator[None]:
    """Processes that sleep, and processes that never do."""
    commands = [["sleep", "3600"]] * sleepers + [LOOP] * loops
    running = [subprocess.Popen(command) for command in commands]
    try:
        yield
    finally:
        for each in running:
            each.kill()
        for each in running:
            each.wait()


@pytest.fixture(scope="module")
def full_crowd() -> Iterator[None]:
    """As many as a lab's server may have."""
    with crowd(600):
        yield


def points_lost(folder: Path) -> list[str]:
    """What the solution loses in the strongest mode that works here."""
    mode = next((each for each in "ABCD" if not self_test(each)), "")
    if not mode:
        missing("no mode that enforces anything works here")
    bundle = read_folder(folder, secret=SECRET)
    submission = Submission(bundle.solution_files(bundle.solution))
    with WorkerHome(bundle.manifest.imports) as home:
        workers = IsolatedWorkers(home, mode, bundle.manifest)
        report = grade_one(Case("right", submission, bundle, "0" * 64), workers)
    return [f"{o.id}: {o.status.value}, {o.text}" for o in report.checks if o.points != o.max]


def test_a_right_solution_keeps_its_points_beside_some_processes() -> None:
    with crowd(60):
        assert points_lost(TOY) == []


@pytest.mark.exhaustive
@pytest.mark.slow
@pytest.mark.usefixtures("full_crowd")
@pytest.mark.parametrize("folder", ASSIGNMENTS, ids=lambda folder: folder.name)
def test_every_right_solution_keeps_its_points_beside_a_crowd(folder: Path) -> None:
    assert points_lost(folder) == []

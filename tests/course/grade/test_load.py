"""Right solutions keep their points on a machine that is crowded and busy."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.grade.hand_in import HandIn
from photograd_course.grade.one import Case, grade_one
from photograd_course.grade.workers import IsolatedWorkers
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.self_test import self_test

ROOT = Path(__file__).parents[3]
ASSIGNMENTS = sorted(path.parent for path in (ROOT / "assignments").glob("*/assignment.toml"))
SLEEPERS, LOOPS = 600, 2
SECRET = b"seeds of hidden checks on a busy day"


@pytest.fixture(scope="module")
def crowd() -> Iterator[None]:
    """Processes that sleep, and processes that never do."""
    loop = [sys.executable, "-I", "-S", "-c", "while True: pass"]
    commands = [["sleep", "3600"]] * SLEEPERS + [loop] * LOOPS
    running = [subprocess.Popen(command) for command in commands]
    yield
    for each in running:
        each.kill()
    for each in running:
        each.wait()


@pytest.mark.slow
@pytest.mark.usefixtures("crowd")
@pytest.mark.skipif(sys.platform != "linux", reason="isolation needs Linux")
@pytest.mark.parametrize("folder", ASSIGNMENTS, ids=lambda folder: folder.name)
def test_a_right_solution_keeps_its_points_beside_a_crowd(folder: Path) -> None:
    mode = next((each for each in "ABCD" if not self_test(each)), "")
    if not mode:
        pytest.skip("no mode that enforces anything works here")
    bundle = read_folder(folder, secret=SECRET)
    hand_in = HandIn(bundle.solution_files(bundle.solution))
    with WorkerHome(bundle.manifest.imports) as home:
        workers = IsolatedWorkers(home, mode, bundle.manifest)
        report = grade_one(Case("right", hand_in, bundle, "0" * 64), workers)
    lost = [f"{o.id}: {o.status.value}, {o.text}" for o in report.checks if o.points != o.max]
    assert lost == []

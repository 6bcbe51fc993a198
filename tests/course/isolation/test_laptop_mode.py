"""Mode E uses nothing that only POSIX systems have, in the grader and in the worker."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

from photograd_course.worker.home import WorkerHome

from course.isolation.support import submission
from course.student.laptop import POISON
from support.tree import ROOT

GRADE = """
import json
from photograd_course.worker.modes import choose
from photograd_course.worker.home import WorkerHome
from course.isolation.support import WRONG, essence, outcomes_of

if __name__ == "__main__":
    with WorkerHome() as home:
        mode = choose(only="E")
        print(json.dumps(essence(outcomes_of(WRONG, home, mode))))
"""


def test_the_grader_needs_no_posix(expected: dict[str, Any]) -> None:
    done = subprocess.run(
        [sys.executable, "-c", POISON + GRADE],
        env={**os.environ, "PYTHONPATH": str(ROOT / "tests")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == expected["wrong"]


def test_the_worker_imports_nothing_of_it_either(home: WorkerHome) -> None:
    student = submission("import sys\ndef loaded(x): return sorted(sys.modules)", home, "E")
    loaded = set(student.call("toy.loaded", [0], seconds=5.0))
    student.close()
    assert {"numpy", "photograd_worker.courtesy"} <= loaded
    posix = {"resource", "fcntl", "pwd", "grp", "termios", "photograd_worker.confine"}
    assert not loaded & posix

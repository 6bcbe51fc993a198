"""Run where a test has made things tight: tells, as JSON, what the grader achieves there.

``python -m course.isolation.witness MODES``: the self-tests, the mode chosen, and with each of the
given modes that works the outcomes of a submission that is right but for one sign, and how some
misbehavior ends.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

from photograd_course.grading import StudentFailure
from photograd_course.worker import modes, processes
from photograd_course.worker.home import WorkerHome

from course.isolation.support import WRONG, essence, outcomes_of, submission

MISBEHAVIOR = {
    "loop": "while True: pass",
    "crash": "import ctypes; ctypes.string_at(0)",
    "fork": "import os; os.fork()",
    "socket": "import _socket; _socket.socket()",
    "signal": "import os; os.kill(os.getppid(), 9)",
    "secret": "open(x)",
    "file": "open('/tmp/photograd-attempt', 'w')",
    "memory": "import numpy; numpy.ones(10**9)",
}


def endings(home: WorkerHome, mode: str, secret: Path) -> dict[str, list[str]]:
    """Reason and exception of each."""
    found = {}
    for name, body in MISBEHAVIOR.items():
        student = submission(f"def f(x):\n    {body}", home, mode)
        try:
            student.call("toy.f", [str(secret)], seconds=1.0)
            found[name] = ["nothing happened", ""]
        except StudentFailure as failure:
            found[name] = [failure.reason, failure.private.split(":")[0]]
        finally:
            student.close()
    return found


def testify(wanted: str) -> dict[str, Any]:
    """All of it."""
    with WorkerHome(("_socket", "ctypes")) as home, tempfile.TemporaryDirectory() as folder:
        secret = Path(folder) / "secret"
        secret.write_text("the answers", encoding="utf-8")
        secret.chmod(0o600)
        works = modes.probe((Path(folder), secret))
        seen = {
            mode: {
                "wrong": essence(outcomes_of(WRONG, home, mode)),
                "endings": endings(home, mode, secret),
                "left": processes.of_user(home.uid(0)) if home.has_users else [],
            }
            for mode in wanted
            if not works[mode]
        }
        return {"uid": os.geteuid(), "works": works, "chosen": modes.choose(), "seen": seen}


if __name__ == "__main__":
    sys.stdout.write(json.dumps(testify(sys.argv[1])))

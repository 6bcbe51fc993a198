"""Nothing that a submission starts outlives its grader, however that ends."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from photograd_course.worker import processes
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.watchdog import Watchdog

from course.isolation.conftest import modes, need
from course.isolation.support import TOY, submission

PATIENCE = 20.0  # seconds
# How a submission tries to stay, before it sleeps for an hour.
STAYS = {
    "sleeps": "",
    "takes the signal back": """
libc.prctl(1, 0, 0, 0, 0)
libc.prctl(4, 1, 0, 0, 0)
""",
    "changes its user": """
for name in ("setresuid", "setresgid", "setuid", "setfsuid", "setgid"):
    getattr(libc, name)(*[os.getuid()] * (3 if "res" in name else 1))
libc.unshare(0x10000000)
""",
    "closes its pipes": "os.closerange(0, 64)",
    "ignores every signal": """
for number in range(1, 65):
    try: signal.signal(number, signal.SIG_IGN)
    except (OSError, ValueError): pass
""",
    "leaves the first thread": """
threading.Thread(target=time.sleep, args=(3600,)).start()
libc.syscall(60, 0)
""",
    "is stopped": "libc.syscall(62, os.getpid(), signal.SIGSTOP)",
}
# A grader: opens a worker, loads the submission, and tells who is who.
GRADER = """
import sys, threading
from pathlib import Path
from course.isolation.support import submission
from photograd_course.worker.home import WorkerHome
from photograd_course.worker import processes
home = WorkerHome(("ctypes", "threading", "signal"))
if sys.argv[2]:
    place = Path(home.program) / "photograd_worker" / "confine.py"
    text = place.read_text()
    assert sys.argv[2] in text
    place.write_text(text.replace(sys.argv[2], "pass", 1))
    import shutil
    shutil.rmtree(place.parent / "__pycache__")
student = submission(sys.argv[3], home, sys.argv[1])
threading.Timer(0.5, lambda: print("grader:", *processes.family(__import__("os").getpid()),
    flush=True)).start()
student.call("toy.f", [1.0], seconds=10.0)
"""


def source(how: str) -> str:
    body = "import ctypes, os, signal, threading, time\nlibc = ctypes.CDLL(None)\n"
    lines = [line for line in STAYS[how].strip().splitlines() if line]
    return body + "def f(x):\n" + "".join(f"    {line}\n" for line in (*lines, "time.sleep(3600)"))


def start(command: Sequence[str]) -> subprocess.Popen[str]:
    path = os.pathsep.join(str(Path(__file__).parents[k]) for k in (2, 3))
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": path}
    )


def left_after(family: Sequence[int]) -> list[int]:
    until = time.monotonic() + PATIENCE
    while (left := [pid for pid in family if processes.is_alive(pid)]) and time.monotonic() < until:
        time.sleep(0.05)
    return left


def killed(mode: str, how: str, without: str = "") -> list[int]:
    """What is left of a grader and its family once the grader alone has been killed."""
    grader = start([sys.executable, "-c", GRADER, mode, without, source(how)])
    assert grader.stdout is not None
    family = [int(word) for word in grader.stdout.readline().split()[1:]]
    assert len(family) >= 3, "the grader, its watchdog and a worker"
    grader.kill()
    grader.communicate()
    return left_after(family)


@pytest.mark.parametrize("how", STAYS)
@pytest.mark.parametrize("mode", modes("ABCD"))
def test_nothing_outlives_a_killed_grader(mode: str, how: str) -> None:
    need(mode)
    assert killed(mode, how) == []


@pytest.mark.parametrize("mode", modes("BCD"))
def test_the_watchdog_ends_what_the_kernel_leaves(mode: str) -> None:
    need(mode)
    without = "kernel.prctl(kernel.PR_SET_PDEATHSIG, 9)"
    assert killed(mode, "closes its pipes", without) == []


@pytest.mark.parametrize("mode", modes("CBAD"))
def test_nothing_outlives_a_killed_command(mode: str, tmp_path: Path) -> None:
    """The whole of `photograd course grade`, with two workers at a time."""
    need(mode)
    inbox = tmp_path / "inbox"
    for student in ("one", "two"):
        folder = inbox / student
        folder.mkdir(parents=True)
        (folder / "toy.py").write_text(
            "import numpy as np\nos = __import__('os')\ntime = __import__('time')\n"
            "libc = __import__('ctypes').CDLL(None)\nlibc.prctl(1, 0, 0, 0, 0)\ntime.sleep(3600)\n"
        )
    toy = shutil.copytree(TOY, tmp_path / TOY.name)
    manifest = toy / "assignment.toml"
    manifest.write_text(f'minimum_mode = "{mode}"\n' + manifest.read_text("utf-8"), "utf-8")
    words = ["course", "grade", "90", str(inbox), "--bundle", str(toy), "--mode", mode]
    code = "from photograd_course.cli.entry import main; main()"
    command = [sys.executable, "-c", code, *words, "--jobs", "2", "--out", str(tmp_path / "out")]
    grader = start(command)
    # The grader, its watchdog and two workers; bubblewrap stands before a worker twice.
    size = 2 + 2 * (3 if mode == "A" else 1)
    until = time.monotonic() + PATIENCE
    while len(processes.family(grader.pid)) < size and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(1.0)  # into the submissions
    family = processes.family(grader.pid)
    assert len(family) == size
    grader.kill()
    grader.communicate()
    assert left_after(family) == []


def test_a_process_whose_first_thread_has_ended_is_alive() -> None:
    code = (
        "import ctypes, threading, time\n"
        "threading.Thread(target=time.sleep, args=(3600,)).start()\n"
        "print('started', flush=True)\n"
        "ctypes.CDLL(None).pthread_exit(None)\n"
    )
    process = start([sys.executable, "-c", code])
    assert process.stdout is not None
    process.stdout.readline()
    until = time.monotonic() + PATIENCE
    while processes.stat_fields(process.pid)[0] != "Z" and time.monotonic() < until:
        time.sleep(0.02)
    assert processes.stat_fields(process.pid)[0] == "Z"
    assert processes.is_alive(process.pid)
    assert process.pid in processes.of_user(os.getuid())
    process.kill()
    process.communicate()
    assert not processes.is_alive(process.pid)


def test_a_watchdog_ends_only_what_it_was_not_told_to_forget() -> None:
    sleep = shutil.which("sleep") or "sleep"
    first, second = (subprocess.Popen([sleep, "3600"], start_new_session=True) for _ in range(2))
    watchdog = Watchdog()
    watchdog.watch(first.pid)
    watchdog.watch(second.pid)
    watchdog.forget(first.pid)
    watchdog.close()
    assert second.wait(PATIENCE) == -signal.SIGKILL
    assert first.poll() is None
    first.kill()
    first.wait()


def test_a_worker_that_ended_is_forgotten(home: WorkerHome) -> None:
    student = submission("def f(x):\n    return x", home, "E")
    assert student.call("toy.f", [1.0], seconds=5.0) == 1.0
    student.close()
    assert home.watchdog._watched == {}

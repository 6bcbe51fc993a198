"""Neither a grader nor a worker lets a debugger in."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from photograd_course.cli import entry
from photograd_course.worker import debuggers
from photograd_course.worker.home import WorkerHome

from course.isolation.support import submission

# What Python 3.14 answers; 3.13 and older have no such function.
LOOK = """
import os, sys

def look():
    return [getattr(sys, "is_remote_debug_enabled", bool)(), sorted(os.environ)]
"""


def test_a_worker_takes_no_file_from_others(mode: str, home: WorkerHome) -> None:
    student = submission(LOOK, home, mode)
    try:
        enabled, names = student.call("toy.look", [], seconds=5.0)
    finally:
        student.close()
    assert not enabled
    assert "PYTHON_DISABLE_REMOTE_DEBUG" in names
    assert not {"PYTHONPERFSUPPORT", "PYTHONINSPECT", "PYTHONSTARTUP", "PYTHONPATH"} & set(names)


def test_a_grader_starts_again_without_remote_debugging(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[list[str]] = []

    def stop(_program: str, words: list[str]) -> None:
        started.append(words)
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "execv", stop)
    monkeypatch.setattr(sys, "is_remote_debug_enabled", lambda: True, raising=False)
    monkeypatch.setattr(sys, "argv", ["photograd", "course", "grade", "01", "inbox"])
    monkeypatch.setattr(sys, "orig_argv", ["python", "-I", "photograd", "course", "grade"])
    with pytest.raises(KeyboardInterrupt):
        entry.main()
    words = ["-X", "disable-remote-debug", "-I", "photograd", "course", "grade"]
    assert started == [[sys.executable, *words]]


def test_other_commands_can_be_debugged(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[bool] = []
    monkeypatch.setattr(entry, "close_to_debuggers", lambda: asked.append(True))
    monkeypatch.setattr(entry, "run", lambda _: 0)
    for words, calls in ((["course", "check", "01"], 0), (["course", "grade", "01"], 1)):
        asked.clear()
        monkeypatch.setattr(sys, "argv", ["photograd", *words])
        with pytest.raises(SystemExit):
            entry.main()
        assert len(asked) == calls


@pytest.mark.skipif(sys.platform != "linux", reason="the kernel's flag is Linux's")
def test_another_process_of_the_account_cannot_trace_it() -> None:
    source = Path(debuggers.__file__).parents[2]
    code = (
        f"import sys; sys.path.insert(0, {str(source)!r})\n"
        "from photograd_course.worker.debuggers import close_to_debuggers\n"
        "from photograd_course.worker import kernel\n"
        "close_to_debuggers()\n"
        "print(kernel.prctl(3))\n"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout == "0\n"  # PR_GET_DUMPABLE

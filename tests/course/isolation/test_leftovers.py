"""Ending a worker ends all that it has started, and removes what it has written."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from photograd_course.grading import StudentFailure
from photograd_course.worker import launch, processes, reapers
from photograd_course.worker.home import WorkerHome, remove_tree

from course.isolation.conftest import need
from course.isolation.support import CALL_SECONDS, submission

# A grandchild in a session of its own that keeps the pipe open.
DETACHED = """
import ctypes, os, time
libc = ctypes.CDLL(None)

def f(marker):
    if libc.fork() == 0:
        libc.setsid()
        if libc.fork() == 0:
            time.sleep(LIFE)
        os._exit(0)
    ENDING
"""


def linux_root() -> None:
    if sys.platform != "linux" or os.geteuid() != 0:
        pytest.skip("needs root on Linux")


@pytest.mark.parametrize("ending", ["os._exit(0)", "time.sleep(1000)"])
def test_a_namespace_dies_with_its_worker(
    ending: str, home: WorkerHome, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bubblewrap alone, with nothing that keeps a submission from starting processes."""
    need("A")
    monkeypatch.setattr(launch, "_filter", lambda **_: None)
    student = submission(DETACHED.replace("LIFE", "1000").replace("ENDING", ending), home, "A")
    with pytest.raises(StudentFailure) as caught:
        student.call("toy.f", ["x"], seconds=CALL_SECONDS)
    # The grandchild holds the pipe: the grader sees no end of it, and does not wait for one.
    assert caught.value.reason in {"timeout", "died"}
    student.close()  # that no process is left is what the fixture asserts


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_the_grader_does_not_wait_for_who_holds_the_pipe(home: WorkerHome) -> None:
    """Mode E cannot stop it, and is not stopped by it."""
    text = DETACHED.replace("LIFE", "8").replace("ENDING", "os._exit(0)")
    student = submission(text, home, "E")
    with pytest.raises(StudentFailure) as caught:
        student.call("toy.f", ["x"], seconds=CALL_SECONDS)
    assert caught.value.reason == "timeout"
    student.close()


def test_a_sweep_finds_every_session(home: WorkerHome) -> None:
    linux_root()
    uid = home.uid(3)
    started = [
        subprocess.Popen(
            ["/bin/sleep", "1000"], user=uid, group=uid, extra_groups=[], start_new_session=new
        )
        for new in (True, False, True)
    ]
    assert sorted(processes.of_user(uid)) == sorted(each.pid for each in started)
    reapers.sweep(uid)
    assert processes.of_user(uid) == []
    assert [each.wait() for each in started] == [-9, -9, -9]


def test_two_runs_share_no_users() -> None:
    linux_root()
    with WorkerHome() as one, WorkerHome() as two:
        first, second = ({home.uid(slot) for slot in range(16)} for home in (one, two))
        assert len(first) == len(second) == 16
        assert not first & second


def test_parallel_workers_do_not_end_each_other(strict: str, home: WorkerHome) -> None:
    from course.isolation.support import LIMITS

    first, second = (launch.open_worker(home, strict, LIMITS, slot) for slot in (0, 1))
    first.kill()
    load = {"sources": {"toy": "x = 1"}, "graded": [], "allowed": [], "substitutes": {}}
    assert second.request("load", load, seconds=10.0).kind == "loaded"
    second.kill()


def test_processor_time_is_seen_from_outside(mode: str, home: WorkerHome) -> None:
    text = """
    import time
    def work(seconds):
        end = time.process_time() + seconds
        while time.process_time() < end: pass
        return time.process_time()
    """
    student = submission(text, home, mode)
    before = student.cpu_seconds()
    if sys.platform != "linux":
        assert before is None
    else:
        assert before is not None
        own = student.call("toy.work", [0.3], seconds=10.0)
        after = student.cpu_seconds()
        assert after is not None
        assert 0.3 <= after - before < own + 0.1
    student.close()


def test_folders_that_resist_are_removed(tmp_path: Path) -> None:
    folder = tmp_path / "room"
    deep = folder
    for _ in range(5):
        deep = deep / "d"
    deep.mkdir(parents=True)
    kept = tmp_path / "kept"
    kept.mkdir()
    (kept / "file").write_text("not theirs")
    (deep / "file").write_text("theirs")
    (deep / "link").symlink_to(kept, target_is_directory=True)
    for place in (deep, *deep.parents):
        if tmp_path in place.parents:
            place.chmod(0)
    remove_tree(folder)
    assert not folder.exists()
    assert (kept / "file").read_text() == "not theirs"


def test_a_chmod_in_mode_e_does_not_keep_its_folder(home: WorkerHome) -> None:
    text = """
    import ctypes, os
    libc = ctypes.CDLL(None)
    def f(x):
        for k in range(200):
            libc.mkdir(b"d%d" % k, 0)
        return libc.chmod(b".", 0)
    """
    student = submission(text, home, "E")
    assert student.call("toy.f", [0], seconds=5.0) == 0
    student.close()
    time.sleep(0)  # the fixture asserts that the folder is gone


def test_the_home_of_a_killed_grader_is_removed_by_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("fcntl")
    code = (
        "import time; from photograd_course.worker.home import WorkerHome; home = WorkerHome(); "
        "home.scratch(); print(home.folder, flush=True); time.sleep(1000)"
    )
    killed, running = (
        subprocess.Popen(
            [sys.executable, "-c", code],
            env={**os.environ, "TMPDIR": str(tmp_path)},
            stdout=subprocess.PIPE,
            text=True,
        )
        for _ in range(2)
    )
    assert killed.stdout is not None
    assert running.stdout is not None
    abandoned, alive = (Path(each.stdout.readline().strip()) for each in (killed, running))
    killed.kill()
    killed.communicate()
    foreign = tmp_path / "photograd-home-foreign"  # without a lock: nobody knows whose
    foreign.mkdir()
    assert all((place / "program").is_dir() for place in (abandoned, alive))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with WorkerHome() as home:
        assert sorted(tmp_path.iterdir()) == sorted([alive, foreign, home.folder])
    running.kill()
    running.communicate()
    assert sorted(tmp_path.iterdir()) == sorted([alive, foreign])

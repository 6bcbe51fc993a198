"""What a worker can find out about files that it cannot read, and what staff are told of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd_course.worker import landlock, launch, modes
from photograd_course.worker.home import WorkerHome

from course.isolation.conftest import modes as marked
from course.isolation.conftest import need
from course.isolation.support import submission

# Every way to a name that asks for no right to read: what each returns where it succeeds.
LOOK = """
import os

def found(path):
    ways = [os.stat, os.lstat, os.readlink, os.statvfs, os.chdir, os.listdir, os.listxattr]
    ways += [lambda path: os.open(path, os.O_PATH), os.path.realpath]
    seen = []
    for way in ways:
        try:
            told = way(path)
        except OSError:
            continue
        if way is not os.path.realpath or told != path:
            seen.append(repr(told))
    if os.access(path, os.F_OK):
        seen.append("access")
    return seen

def root():
    return os.listdir("/")
"""


@pytest.mark.parametrize("mode", marked("ABC"))
def test_nothing_outside_has_a_name(mode: str, home: WorkerHome, tmp_path: Path) -> None:
    need(mode)
    open_to_all = home.folder / "open"
    open_to_all.write_text("the answers")
    open_to_all.chmod(0o644)
    link = home.folder / "link"
    link.symlink_to(open_to_all)
    student = submission(LOOK, home, mode)
    try:
        for path in (open_to_all, link, home.canary, tmp_path, Path("/etc/passwd"), Path("/proc")):
            assert student.call("toy.found", [str(path)], seconds=5.0) == [], path
        if mode != "A":
            assert student.call("toy.root", [], seconds=5.0) == []
    finally:
        student.close()


@pytest.mark.parametrize("mode", marked("CD"))
def test_where_names_can_be_seen_it_is_said(
    mode: str, home: WorkerHome, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A container that has taken away this right of root, and mode D, which never has it."""
    need(mode)
    monkeypatch.setattr(launch, "may_change_root", lambda: False)
    student = submission(LOOK, home, mode)
    try:
        seen = student.call("toy.found", [str(home.canary)], seconds=5.0)
        assert any(text.startswith("os.stat_result") for text in seen)
    finally:
        student.close()
    assert "names, sizes and times" in modes.note(mode)


def test_a_weaker_layer_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launch, "_filter", lambda **_: b"program")
    monkeypatch.setattr(launch, "may_change_root", lambda: True)
    assert [modes.note(mode) for mode in "ABC"] == ["", "", ""]
    monkeypatch.setattr(launch, "may_change_root", lambda: False)
    monkeypatch.setattr(landlock, "version", lambda: 0)
    assert "no Landlock" in modes.note("C")
    monkeypatch.setattr(launch, "_filter", lambda **_: None)
    assert "no filter of system calls" in modes.note("A")
    assert "nothing is enforced" in modes.note("E")

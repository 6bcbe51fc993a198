"""A write that fails at any moment leaves the old file as it was and nothing beside it."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import BinaryIO

import pytest
from photograd_course.atomic_io import atomic_write, remove_leftovers
from photograd_course.errors import IoError

OLD, NEW = b"old checkpoint", b"new" * 50_000


def files_in(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def run_python(code: str, target: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", code, str(target)]
    return subprocess.run(command, check=False, capture_output=True, text=True)


@pytest.fixture
def target(tmp_path: Path) -> Path:
    path = tmp_path / "model.npz"
    path.write_bytes(OLD)
    return path


def test_bytes_and_writers_replace_the_file(target: Path) -> None:
    assert atomic_write(target, NEW) == target
    assert target.read_bytes() == NEW
    atomic_write(target, lambda file: file.write(b"from a writer"))
    assert target.read_bytes() == b"from a writer"
    assert files_in(target.parent) == ["model.npz"]


def test_a_new_file_gets_the_usual_permissions(tmp_path: Path) -> None:
    (tmp_path / "plain").write_bytes(b"")
    atomic_write(tmp_path / "atomic", b"")
    modes = [(tmp_path / name).stat().st_mode for name in ("plain", "atomic")]
    assert modes[0] == modes[1]


def test_a_symbolic_link_stays_a_link(target: Path) -> None:
    link = target.with_name("latest")
    link.symlink_to(target)
    atomic_write(link, NEW)
    assert link.is_symlink()
    assert target.read_bytes() == NEW


@pytest.mark.parametrize("call", ["fsync", "write"])
def test_a_full_disk_keeps_the_old_file(
    target: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def refuse(*_: object) -> int:
        raise full

    if call == "fsync":
        monkeypatch.setattr(os, "fsync", refuse)
    with pytest.raises(IoError) as caught:
        atomic_write(target, NEW if call == "fsync" else refuse)
    text = str(caught.value)
    assert text.startswith("atomic_write: path: expected room on the disk for ")
    assert "No space left on device" in text
    assert "the old file is unchanged" in text
    assert target.read_bytes() == OLD
    assert files_in(target.parent) == ["model.npz"]


@pytest.mark.skipif(sys.platform == "win32", reason="file size limits are a POSIX feature")
def test_a_file_size_limit_of_the_system_keeps_the_old_file(target: Path) -> None:
    code = """
import resource, sys
from pathlib import Path
from photograd_course.atomic_io import atomic_write
from photograd_course.errors import IoError
resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
try:
    atomic_write(Path(sys.argv[1]), b"x" * 100_000)
except IoError as error:
    print(error)
"""
    done = run_python(code, target)
    assert "expected room on the disk" in done.stdout
    assert "the old file is unchanged" in done.stdout
    assert target.read_bytes() == OLD
    assert files_in(target.parent) == ["model.npz"]


@pytest.mark.parametrize("kind", [KeyboardInterrupt, ValueError])
def test_an_interrupted_writer_keeps_the_old_file(target: Path, kind: type[BaseException]) -> None:
    def write_half(file: BinaryIO) -> None:
        file.write(NEW[:100])
        raise kind

    with pytest.raises(kind):
        atomic_write(target, write_half)
    assert target.read_bytes() == OLD
    assert files_in(target.parent) == ["model.npz"]


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is a POSIX signal")
def test_a_killed_process_keeps_the_old_file_and_its_leftover_can_be_removed(target: Path) -> None:
    code = """
import os, signal, sys
from pathlib import Path
from photograd_course.atomic_io import atomic_write
def write_half(file):
    file.write(b"half")
    file.flush()
    os.kill(os.getpid(), signal.SIGKILL)
atomic_write(Path(sys.argv[1]), write_half)
"""
    assert run_python(code, target).returncode == -signal.SIGKILL
    assert target.read_bytes() == OLD
    assert len(files_in(target.parent)) == 2
    bystanders = [target.with_name(".model.npz.mine.tmp"), target.with_name(".other.npz.1.tmp")]
    for bystander in bystanders:
        bystander.write_bytes(b"")
    assert remove_leftovers(target) == 1
    assert files_in(target.parent) == sorted(["model.npz", *(b.name for b in bystanders)])
    assert run_python(code, target).returncode == -signal.SIGKILL
    atomic_write(target, NEW)  # the next write removes it, too
    assert files_in(target.parent) == sorted(["model.npz", *(b.name for b in bystanders)])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows keeps files that are open")
def test_what_a_running_process_writes_stays(target: Path) -> None:
    code = """
import sys
from pathlib import Path
from photograd_course.atomic_io import atomic_write
def write_slowly(file):
    print("writing", flush=True)
    sys.stdin.readline()
    file.write(b"slow")
atomic_write(Path(sys.argv[1]), write_slowly)
"""
    with subprocess.Popen(
        [sys.executable, "-c", code, str(target)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as slow:
        assert slow.stdout is not None
        assert slow.stdout.readline() == "writing\n"
        atomic_write(target, NEW)
        assert len(files_in(target.parent)) == 2
        slow.communicate("go on\n")
    assert slow.returncode == 0
    assert target.read_bytes() == b"slow"
    assert files_in(target.parent) == ["model.npz"]


def test_a_missing_folder_is_an_io_error_that_names_the_file(tmp_path: Path) -> None:
    with pytest.raises(IoError, match=r"existing folder.*model\.npz.*no file was written"):
        atomic_write(tmp_path / "missing" / "model.npz", NEW)

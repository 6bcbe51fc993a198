"""A second run in the same place is refused while the first goes on, and only then."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from photograd._run_lock import LOCK_NAME, one_run_for, one_run_in

from tests.commands.conftest import FIT, Photograd
from tests.commands.test_interruptions import start


def test_a_second_fit_is_refused_and_the_first_is_not_disturbed(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    words = ("fit", capture_folder, "--out", tmp_path)
    first = start(capture_folder, tmp_path, *FIT, "--json")
    lock = tmp_path / LOCK_NAME
    while not (lock.exists() and lock.stat().st_size):
        assert first.poll() is None, first.communicate()[1]
        time.sleep(0.01)
    first.send_signal(signal.SIGSTOP)  # it cannot end before it is disturbed
    for more in ((), ("--resume",)):
        second = photograd(*words, *more)
        assert (second.code, second.out) == (1, "")
        assert f"process {first.pid}, 'photograd fit' (wait until it ends" in second.err
    first.send_signal(signal.SIGCONT)
    out, err = first.communicate()
    assert first.returncode == 0, err
    assert json.loads(out.splitlines()[-1])["finished"] is True
    assert not list(tmp_path.glob(".*"))
    assert photograd(*words[:3], tmp_path / "alone", *FIT).code == 0
    assert (tmp_path / "model.npz").read_bytes() == (tmp_path / "alone/model.npz").read_bytes()


HOLD = """
import sys
import time
from pathlib import Path
from photograd._run_lock import one_run_in
with one_run_in("fit", Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.readline()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is a POSIX signal")
def test_the_lock_ends_with_a_killed_process_and_its_file_does_not_matter(tmp_path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"held\n"
        with pytest.raises(OSError, match=f"process {holder.pid}"), one_run_in("fit", tmp_path):
            pass
        holder.send_signal(signal.SIGKILL)
        holder.wait()
        assert (tmp_path / LOCK_NAME).exists()
        with one_run_in("fit", tmp_path):
            assert (tmp_path / LOCK_NAME).read_text() == f"{os.getpid()} photograd fit\n"
    assert list(tmp_path.iterdir()) == []


def test_every_command_that_fills_a_folder_asks(
    photograd: Photograd, capture_folder: Path, model_folder: Path, tmp_path: Path
) -> None:
    picture, folder = tmp_path / "x.exr", tmp_path / "folder"
    lines: list[tuple[object, ...]] = [
        ("capture", "--out", folder),
        ("capture", "--photos", capture_folder / "train", "--out", folder),
        ("fit", capture_folder, "--out", folder),
        ("compare", capture_folder, "--out", folder),
        ("gradients", model_folder, capture_folder, "--out", folder),
        ("demo", "--out", folder),
        (
            "recover",
            "cornell-box",
            "--target",
            picture,
            "--parameter",
            "materials.red.albedo",
            "--out",
            folder,
        ),
        ("trace", "cornell-box", "--out", picture),
        ("trace", "cornell-box", "--out", picture, "--resume"),
        ("trace", "cornell-box", "--out", picture.with_suffix(".png")),  # it writes x.png, too
    ]
    with one_run_in("fit", folder), one_run_for("trace", picture):
        for words in lines:
            done = photograd(*words)
            assert (done.code, done.out) == (1, ""), words
            assert f"{words[0]}: --out: expected " in done.err, words
            assert f"got process {os.getpid()}, 'photograd " in done.err, words
    assert list(tmp_path.iterdir()) == []  # what they made, they removed


def test_a_run_that_was_refused_leaves_no_folder(photograd: Photograd, tmp_path: Path) -> None:
    done = photograd("fit", tmp_path / "none", "--out", tmp_path / "a" / "b", *FIT)
    assert done.code == 1
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_to_is_refused(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("")
    done = photograd("fit", capture_folder, "--out", tmp_path / "file", *FIT)
    assert (done.code, done.out) == (1, "")
    assert "fit: --out: expected a folder that can be made at" in done.err

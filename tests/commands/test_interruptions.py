"""A fit in a process of its own: killed at a random moment, told to stop, interrupted."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd._checkpoint import Checkpoint, load_checkpoint
from photograd.capture.load import load_capture
from photograd.fitting import FitOptions
from photograd.fitting.loop import Fit
from photograd_course.random import uniform

# Levels of 8, 16 and 32 voxels; a second or two in all, so that a kill
# within the first half second, and another as long after resuming, come before the end.
OPTIONS: dict[str, Any] = {"steps": 600, "resolution": 32, "rays": 256, "seed": 3}
WORDS = [word for name, value in OPTIONS.items() for word in (f"--{name}", str(value))]


def start(capture: Path, out: Path, *more: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [
            sys.executable,
            "-m",
            "photograd_course",
            "fit",
            str(capture),
            "--out",
            str(out),
            "--checkpoint-seconds",
            "0.1",
            *more,
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
    )


def wait_for_checkpoint(process: subprocess.Popen[str], out: Path, *, after: int = 0) -> None:
    """Until the checkpoint of a step beyond `after` is there; the process must still be running."""
    for _ in range(3000):
        assert process.poll() is None, process.communicate()[1]
        if (out / "model.npz").exists() and load_checkpoint(out).meta["step"] > after:
            return
        time.sleep(0.01)
    raise AssertionError("no checkpoint within half a minute")


@pytest.fixture(scope="module")
def straight(capture_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Checkpoint:
    """The same fit in this process, from beginning to end."""
    folder = tmp_path_factory.mktemp("straight")
    Fit.start(load_capture(capture_folder), FitOptions(**OPTIONS)).run(folder)
    return load_checkpoint(folder)


def assert_same(one: Checkpoint, two: Checkpoint) -> None:
    for part in ("params", "optimizer", "state"):
        first, second = getattr(one, part), getattr(two, part)
        assert set(first) == set(second)
        assert all(np.array_equal(first[name], second[name]) for name in first)
    assert np.array_equal(one.history, two.history)


def test_killed_twice_and_resumed_it_ends_with_the_same_bits(
    capture_folder: Path, tmp_path: Path, straight: Checkpoint
) -> None:
    steps = [0]
    for turn in range(2):
        process = start(capture_folder, tmp_path, *(["--resume"] if turn else WORDS))
        wait_for_checkpoint(process, tmp_path, after=steps[-1])
        # A random moment of the following sixth of a second: within a step, or within a checkpoint.
        time.sleep(0.17 * float(uniform(5, step=turn)))
        assert process.poll() is None, "it finished before it could be killed"
        process.send_signal(signal.SIGKILL)
        process.communicate()
        assert process.returncode == -signal.SIGKILL
        steps.append(load_checkpoint(tmp_path).meta["step"])
    assert 0 < steps[1] < steps[2] < OPTIONS["steps"]
    # What a kill within a checkpoint leaves behind; a resumed fit clears it away.
    (tmp_path / ".model.npz.99999.tmp").write_bytes(b"half")
    process = start(capture_folder, tmp_path, "--resume", "--json", "--threads", "1")
    out, err = process.communicate()
    assert process.returncode == 0, err
    assert f"resumed at step {steps[2]} of {OPTIONS['steps']}" in err
    assert json.loads(out.splitlines()[-1])["finished"] is True
    assert list(tmp_path.glob(".*")) == []
    assert_same(load_checkpoint(tmp_path), straight)


@pytest.mark.parametrize(
    ("number", "code"),
    [(signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGHUP, 129)],
    ids=["SIGTERM", "Ctrl-C", "SIGHUP"],
)
def test_told_to_stop_it_saves_first(
    capture_folder: Path, tmp_path: Path, number: signal.Signals, code: int
) -> None:
    process = start(capture_folder, tmp_path, *WORDS, "--json")
    wait_for_checkpoint(process, tmp_path)
    before = load_checkpoint(tmp_path).meta["step"]
    process.send_signal(number)
    out, err = process.communicate()
    assert process.returncode == code, err
    assert "Traceback" not in err
    result = json.loads(out.splitlines()[-1])
    saved = load_checkpoint(tmp_path).meta["step"]
    assert result["finished"] is False
    assert result["step"] == saved >= before
    assert f"stopped at step {saved}; continue with --resume" in err
    assert list(tmp_path.glob(".*")) == []

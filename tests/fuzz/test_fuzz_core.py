"""Damaged calls of the compiled core: a result or a typed error, and never the end of the process.

What the library asks of its core in a small run is recorded and asked again with other arguments
(support/core_replay.py), in a process of its own: a crash, a call that does not come back and an
error without a type are failures that name the seed and the call. A round is a fixed list of calls;
PHOTOGRAD_FUZZ_SECONDS has more of them, each with a seed of its own.
"""

from __future__ import annotations

import os
import select
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from support.tree import ROOT

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0"))
CALLS = 1500
"""In a round."""
PATIENCE = 60.0
"""Seconds for one call; on a busy machine, ten times what the longest takes."""


def lines(child: subprocess.Popen[bytes]) -> Iterator[str]:
    """What the child prints, line by line; ends with it, or when it says nothing for too long."""
    assert child.stdout is not None
    rest = b""
    while select.select([child.stdout], [], [], PATIENCE)[0]:
        data = os.read(child.stdout.fileno(), 1 << 16)
        if not data:
            return
        *whole, rest = (rest + data).split(b"\n")
        yield from (line.decode(errors="replace") for line in whole)
    child.kill()
    yield f"BAD no answer in {PATIENCE:g} s"


def faults_of(seed: int, calls: int, folder: Path) -> list[str]:
    """What went wrong in a round; files with strange names may come to be in `folder`."""
    paths = os.pathsep.join([str(ROOT / "tests"), str(ROOT)])
    command = [sys.executable, "-m", "support.core_replay", str(seed), str(calls)]
    faults, last = [], "nothing"
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,  # of Embree's assertions: a crash is known by its signal
        cwd=folder,
        env=os.environ | {"PYTHONPATH": paths},
    ) as child:
        for line in lines(child):
            if line.startswith("BAD "):
                faults.append(f"seed {seed}: {line[4:]}; last call: {last}")
            else:
                last = line
        if child.wait() != 0:
            faults.append(f"seed {seed}: ended with {child.returncode} in call {last}")
    assert faults or last == f"made {calls} calls"
    return faults


def test_damaged_calls(tmp_path: Path) -> None:
    end = time.monotonic() + SECONDS
    seed, faults = 0, []
    while seed == 0 or time.monotonic() < end:
        faults += faults_of(seed, CALLS, tmp_path)
        seed += 1
    assert faults == []

"""Rounds of wrong calls in a process of its own, which may die of them or hang.

A round is a fixed list of calls: `python -m MODULE SEED CALLS` prints each before it is made, and a
line that begins with `BAD` after one that went wrong.
"""

from __future__ import annotations

import os
import select
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from support.tree import ROOT

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


def faults_of(module: str, seed: int, calls: int, folder: Path) -> tuple[list[str], list[str]]:
    """What went wrong in a round of a module that makes wrong calls, and what else it noted.

    Files with strange names may come to be in `folder`.
    """
    paths = os.pathsep.join([str(ROOT / "tests"), str(ROOT)])
    command = [sys.executable, "-m", module, str(seed), str(calls)]
    faults: list[str] = []
    notes: list[str] = []
    last = "nothing"
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
            elif line.startswith("NET "):
                notes.append(line)
            else:
                last = line
        if child.wait() != 0:
            faults.append(f"seed {seed}: ended with {child.returncode} in call {last}")
    assert faults or last == f"made {calls} calls"
    return faults, notes

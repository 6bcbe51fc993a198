"""Damaged .vdb files: the reader may refuse with a typed error or take them; it may not crash.

OpenVDB was not written for hostile files, so the reading happens in a process of its own, with a
limit on its memory; a crash is then a failed test with the bytes that caused it.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from photograd.grids.vdb import write_vdb

from grid.solids import spotted_grid
from support.tree import ROOT

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))
EXAMPLES_A_ROUND = 12
READER = """
import sys
from pathlib import Path
from photograd.errors import IoError
from photograd.grids.vdb import read_vdb
from support.memory_limit import limit_memory
limit_memory(4 << 30)
for line in sys.stdin:
    try:
        for grid in read_vdb(Path(line.strip()), memory_limit=1 << 30).grids:
            grid.statistics
        print("taken", flush=True)
    except IoError:
        print("refused", flush=True)
"""


class Reader:
    """A process that reads files and says how it went; started again after it died."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[str] | None = None

    def ask(self, path: Path) -> str:
        if self.process is None:
            self.process = subprocess.Popen(
                [sys.executable, "-c", READER],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                env=os.environ | {"PYTHONPATH": str(ROOT / "tests")},
            )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(f"{path}\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        if not answer:
            answer = f"died with {self.process.wait()}"
            self.close()
        return answer

    def close(self) -> None:
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None


@pytest.fixture(scope="module")
def reader() -> Iterator[Reader]:
    process = Reader()
    yield process
    process.close()


class File:
    """The bytes of a file, too many to be printed."""

    def __init__(self, data: bytes) -> None:
        self.data = data

    def __repr__(self) -> str:
        return f"File({len(self.data)} bytes)"


@st.composite
def damage(draw: st.DrawFn, good: File) -> File:
    """One to three places overwritten, one piece perhaps removed, and perhaps the end."""
    data = good.data
    result = bytearray(data)
    # Half of the damage falls on the first kilobyte, which holds headers, names and offsets.
    place = st.integers(0, min(1023, len(data) - 1)) | st.integers(0, len(data) - 1)
    for _ in range(draw(st.integers(1, 3))):
        at = draw(place)
        if draw(st.booleans()):
            result[at] ^= 1 << draw(st.integers(0, 7))
        else:
            patch = draw(st.sampled_from([b"\xff" * 4, b"\0" * 8, b"\x7f" * 8]) | st.binary())
            result[at : at + len(patch)] = patch
    if draw(st.integers(0, 3)) == 0:
        at = draw(place)
        del result[at : at + draw(st.integers(1, 64))]
    if draw(st.integers(0, 7)) == 0:
        del result[draw(place) :]
    return File(bytes(result))


@pytest.mark.parametrize("channels", [1, 3])
def test_damaged_grids(channels: int, reader: Reader, tmp_path: Path) -> None:
    path = tmp_path / "grid.vdb"
    write_vdb(path, [spotted_grid(channels, density=0.02)])
    good = File(path.read_bytes())
    assert reader.ask(path) == "taken"
    answers: list[str] = []
    end = time.monotonic() + SECONDS / 2
    rounds = 0
    while time.monotonic() < end or rounds == 0:

        @seed(rounds)
        @settings(
            max_examples=EXAMPLES_A_ROUND,
            deadline=None,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(damage(good))
        def survive(bad: File) -> None:
            path.write_bytes(bad.data)
            answers.append(reader.ask(path))
            assert answers[-1] in ("taken", "refused"), f"{path}: {answers[-1]}"

        survive()
        rounds += 1
    assert "refused" in answers
    assert np.isin(answers, ["taken", "refused"]).all()

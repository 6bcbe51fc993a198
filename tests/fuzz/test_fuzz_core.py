"""Damaged calls of the compiled core: a result or a typed error, and never the end of the process.

What the library asks of its core in a small run is recorded and asked again with other arguments
(support/core_replay.py), in a process of its own: a crash, a call that does not come back and an
error without a type are failures that name the seed and the call. A round is a fixed list of calls;
PHOTOGRAD_FUZZ_SECONDS has more of them, each with a seed of its own.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from support.rounds import faults_of

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0"))
CALLS = 1500
"""In a round."""


def test_damaged_calls(tmp_path: Path) -> None:
    end = time.monotonic() + SECONDS
    seed, faults = 0, []
    while seed == 0 or time.monotonic() < end:
        faults += faults_of("support.core_replay", seed, CALLS, tmp_path)[0]
        seed += 1
    assert faults == []

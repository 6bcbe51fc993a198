"""Wrong calls of the public functions and classes: a result or an error of photograd.

The calls of support/public_calls.py are made with wrong objects, numbers, sizes and shapes
(support/public_replay.py) in a process of its own, in 6 GiB: an exception of another type, a crash,
a hang, and gigabytes are failures that name the seed and the call.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from support.public_calls import every_call
from support.rounds import faults_of

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0"))
CALLS = 1500
"""In a round."""
UNNAMED = 0.01
"""Of a round, at most so many errors come from no check of the function itself."""


def test_right_calls_are_many() -> None:
    assert 150 < len(every_call()) < CALLS / 8


def test_wrong_calls(tmp_path: Path) -> None:
    end = time.monotonic() + SECONDS
    seed, faults, unnamed = 0, [], []
    while seed == 0 or time.monotonic() < end:
        found, notes = faults_of("support.public_replay", seed, CALLS, tmp_path)
        faults += found
        unnamed += notes
        seed += 1
    assert faults == []
    assert len(unnamed) <= UNNAMED * CALLS * seed, unnamed

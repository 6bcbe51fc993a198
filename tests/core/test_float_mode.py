"""Loops run in the caller's floating-point mode, whatever has used the threads before.

Embree flushes denormal numbers to zero while it builds a scene, and a pool of threads may keep the
mode of its first user: results below 2.2e-308 would then depend on what came first in the process.
"""

from __future__ import annotations

import subprocess
import sys

import pytest

CHILD = """
import sys
import numpy as np
from photograd import bsdf
from photograd.transport import PathTracer
from photograd.transport.builtin import cornell_box

if sys.argv[1] == "scene first":
    PathTracer(cornell_box(2)).render(spp=1, seed=1)
model = bsdf.registry()["lambert"].core
rows = np.full((1 << 16, 3), 1e-310)
up = np.tile([0.0, 0.6, 0.8], (1 << 16, 1))
print(*np.unique(model.f(rows, up, up)).tolist())
"""


@pytest.mark.parametrize("order", ["scene first", "loop first"])
def test_denormal_numbers_stay(order: str) -> None:
    run = subprocess.run(
        [sys.executable, "-c", CHILD, order], capture_output=True, text=True, check=True
    )
    assert [float(x) for x in run.stdout.split()] == [pytest.approx(1e-310 / 3.141592653589793)]

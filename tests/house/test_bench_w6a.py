"""The benchmark of spherical harmonics does the work that it says: NumPy in double agrees."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from photograd import sh

from support.tree import ROOT

BENCH = ROOT / "bench"
STEP = 1e-6

pytestmark = pytest.mark.usefixtures("core")


def test_w6a_computes_the_workload(monkeypatch: pytest.MonkeyPatch) -> None:
    command = [sys.executable, str(BENCH / "w6a_sh.py"), "--points", "1000", "--reps", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert (row["workload"], row["peer"]) == ("W6a", "photograd")
    assert row["size"] == {"points": 1000, "degree": 3}
    assert row["inputs"]["agree"]
    assert row["seconds_fwdbwd"] > row["bound"]["seconds_fwdbwd"] > 0

    monkeypatch.syspath_prepend(str(BENCH))
    d, c, w = (a.astype(np.float64) for a in import_module("_inputs").sh_points(1000))
    Y = sh.basis(d, 3)
    slopes = []
    for axis in range(3):
        away = STEP * np.eye(3)[axis]
        dY = (sh.basis(d + away, 3) - sh.basis(d - away, 3)) / (2 * STEP)
        slopes.append(np.einsum("nk,nkc,nc->n", dY, c, w))
    expected = {
        "sum": np.einsum("nk,nkc->", Y, c),
        "grad_norm_coeff": np.sqrt(np.einsum("nk,nc->", Y**2, w**2)),
        "grad_norm_dir": np.linalg.norm(slopes),
    }
    # Rounding to float32, averaged over thousands of numbers: measured 5e-8.
    assert row["quality"] == pytest.approx(expected, rel=1e-6)

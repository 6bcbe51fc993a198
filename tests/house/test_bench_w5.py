"""The texture benchmark does the work that it says: NumPy in double precision agrees."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from tests.texture.oracle import adjoint, lookup

from support.tree import ROOT

BENCH = ROOT / "bench"
SIZE = {"n": 256, "points": 200_000, "iters": 1}  # with fewer texels a step of 40,000 diverges

pytestmark = pytest.mark.usefixtures("core")


def test_w5_computes_the_workload(monkeypatch: pytest.MonkeyPatch) -> None:
    words = [word for name, value in SIZE.items() for word in (f"--{name}", str(value))]
    command = [sys.executable, str(BENCH / "w5_texture.py"), *words, "--reps", "1", "--breakdown"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert (row["workload"], row["peer"], row["size"]) == ("W5", "photograd", SIZE)
    assert row["inputs"]["agree"]
    assert row["seconds_fwd"] > 0
    assert row["seconds_fwdbwd"] > 0
    assert {"sort", "loss_and_gradient", "step", "sample_backward"} < set(row["breakdown"])

    monkeypatch.syspath_prepend(str(BENCH))
    inputs = import_module("_inputs")
    truth = inputs.texture(SIZE["n"]).astype(np.float64)
    uv = inputs.texture_points(SIZE["points"]).astype(np.float64)
    target, texture, loss = lookup(truth, uv), np.full_like(truth, 0.5), 0.0
    for _ in range(SIZE["iters"]):
        error = lookup(texture, uv) - target
        loss = float(np.square(error).mean())
        texture -= 40_000 * adjoint(truth.shape, uv, error * (2 / error.size))
    psnr = -10 * np.log10(np.square(texture - truth).mean())
    assert 10 < psnr < 30
    # Positions are float32 there: 256 texels leave 16 bits of fraction, 1e-5 of a texel's slope.
    assert row["quality"] == pytest.approx({"last_loss": loss, "psnr": psnr}, rel=1e-4)

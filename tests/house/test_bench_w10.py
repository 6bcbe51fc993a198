"""The benchmark of the principled model does the work that it says: the model in double agrees."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from photograd.bsdf import principled, registry

from support.tree import ROOT

BENCH = ROOT / "bench"

pytestmark = pytest.mark.usefixtures("core")


@pytest.mark.parametrize("kind", ["scalar", "texture"])
def test_w10_computes_the_workload(monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    command = [
        sys.executable,
        str(BENCH / "w10_bsdf.py"),
        "--evals",
        "2000",
        "--texels",
        "20",
        "--params",
        kind,
        "--reps",
        "1",
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert (row["workload"], row["peer"]) == ("W10", "photograd")
    assert row["size"] == {
        "evals": 2000,
        "params": kind,
        "texels": 20 if kind == "texture" else None,
    }
    assert row["inputs"]["agree"]
    assert row["seconds_fwdbwd"] > row["bound"]["seconds_fwdbwd"] > 0

    monkeypatch.syspath_prepend(str(BENCH))
    inputs = import_module("_inputs")
    first, second, w = (a.astype(np.float64) for a in inputs.bsdf_pairs(2000))
    rows = principled.rows(*inputs.bsdf_parameters(kind, 20)).astype(np.float64)
    taken = np.arange(2000) % len(rows)
    core = registry()["principled"].core
    values = core.f(rows[taken], first, second) * second[:, 2:]
    single = core.f_backward(
        rows[taken], first, second, w * second[:, 2:] / 2000, np.zeros((2000, 5))
    )
    gradient = np.zeros_like(rows)
    np.add.at(gradient, taken, single)
    expected = {
        "weighted_mean": (values * w).sum() / 2000,
        "mean": values.mean(),
        "grad_norm_base_color": np.linalg.norm(gradient[:, :3]),
        "grad_norm_metallic": np.linalg.norm(gradient[:, 3]),
        "grad_norm_roughness": np.linalg.norm(gradient[:, 4]),
    }
    assert min(expected.values()) > 0
    # float32 arithmetic; the figures differ by about 1e-6.
    assert row["quality"] == pytest.approx(expected, rel=2e-5)

"""The sparse-harmonics benchmark does the work that it says: NumPy in double precision agrees."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from photograd import sh

from support.tree import ROOT

BENCH = ROOT / "bench"
SIZE = {"n": 32, "res": 16, "views": 1}

pytestmark = pytest.mark.usefixtures("core")


def image(occupied: Any, values: Any, origins: Any, directions: Any) -> Any:
    """(R, 3): every ray, sample by sample, on the grid as the inputs have it, [z, y, x]."""
    n = len(occupied)
    row = np.full(occupied.shape, -1)
    row[occupied] = np.arange(len(values))
    dt = np.float32(1 / n)
    colors = []
    for o, d in zip(origins, directions, strict=True):
        with np.errstate(divide="ignore"):
            ends = (np.array([[-1], [1]], np.float32) - o) / d
        near, far = np.maximum(ends.min(axis=0).max(), 0), ends.max(axis=0).min()
        t = near + (np.arange(max(int(np.floor((far - near) / dt)), 0)) + 0.5) * dt
        q = np.clip((o + t[:, None] * d + 1) * (n / 2) - 0.5, 0, n - 1.0)
        base = np.minimum(q.astype(int), n - 2)
        f = q - base
        Y = sh.basis(d[None].astype(float), 3)[0]
        density, color, hit = np.zeros(len(t)), np.full((len(t), 3), 0.5), np.zeros(len(t), bool)
        for c in np.ndindex(2, 2, 2):
            w = np.prod(np.where(c, f, 1 - f), axis=1)
            x, y, z = (base + c).T
            r = row[z, y, x]
            w = np.where(r >= 0, w, 0)
            hit |= r >= 0
            density += w * values[r, 0]
            color += w[:, None] * (values[r, 1:].reshape(-1, 3, 16) @ Y)
        tau = np.where(hit, np.maximum(density, 0), 0) * (1 / n)
        front = np.exp(-(np.cumsum(tau) - tau))
        colors.append((front * tau) @ np.maximum(color, 0))
    return np.array(colors)


def test_w6b_computes_the_workload(monkeypatch: pytest.MonkeyPatch) -> None:
    words = [word for name, value in SIZE.items() for word in (f"--{name}", str(value))]
    command = [sys.executable, str(BENCH / "w6b_plenoxel.py"), *words, "--reps", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert (row["workload"], row["peer"]) == ("W6b", "photograd")
    assert row["inputs"]["agree"]
    assert row["seconds_fwd"] > 0
    assert row["seconds_fwdbwd"] > 0

    monkeypatch.syspath_prepend(str(BENCH))
    inputs = import_module("_inputs")
    rays = inputs.orbit_rays(SIZE["res"], SIZE["views"])
    made, target = (
        image(*(np.asarray(a, float) if a.dtype != bool else a for a in shell), *rays)
        for shell in (inputs.sparse_shell(32, 0.0), inputs.sparse_shell(32, 0.6))
    )
    assert made.mean() > 0.05
    # float32 positions: 5e-6 of the image, and twice that in the square of a difference.
    quality = row["quality"]
    assert quality["image_mean"] == pytest.approx(made.mean(), rel=1e-4)
    assert quality["loss"] == pytest.approx(np.square(made - target).mean(), rel=1e-3)
    # The gradient's size by one finite difference of the loss along itself is the adjoint's affair,
    # proved elsewhere; here only that there is one.
    assert min(quality["grad_norm_density"], quality["grad_norm_sh"]) > 0

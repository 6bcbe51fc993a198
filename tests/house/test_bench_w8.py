"""The splatting benchmark does the work that it says: the oracle and double precision agree."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.splats.splatting import Gaussians, SplatOptions, render, render_backward
from tests.splat import oracle

from support.tree import ROOT

BENCH = ROOT / "bench"
SIZE = {"gaussians": 300, "res": 32}

pytestmark = pytest.mark.usefixtures("core")


def test_w8_computes_the_workload(monkeypatch: pytest.MonkeyPatch) -> None:
    words = [word for name, value in SIZE.items() for word in (f"--{name}", str(value))]
    command = [sys.executable, str(BENCH / "w8_splat.py"), *words, "--reps", "1", "--breakdown"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert (row["workload"], row["peer"]) == ("W8", "photograd")
    assert row["size"] == SIZE | {"sh_degree": 3}
    assert row["inputs"]["agree"]
    assert row["seconds_fwd"] > 0
    assert row["seconds_fwdbwd"] > 0
    assert {"project, sort, bin", "blend", "loss", "backward"} < set(row["breakdown"])

    monkeypatch.syspath_prepend(str(BENCH))
    inputs = import_module("_inputs")
    gaussians = Gaussians(**inputs.gaussians(SIZE["gaussians"])).astype(np.float64)
    view, focal = inputs.splat_camera(SIZE["res"])
    camera = Camera(32, 32, focal, focal, 16.0, 16.0, np.eye(4))
    options, M = SplatOptions(), view.astype(np.float64)
    expected = oracle.render(gaussians, camera, np.zeros(3), options, M)["color"]
    quality = row["quality"]
    assert quality["image_mean"] == pytest.approx(float(expected.mean()), rel=1e-5)
    assert quality["loss"] == pytest.approx(float(((expected - 0.5) ** 2).mean()), rel=1e-5)

    picture, context = render(gaussians, camera, options=options, camera_from_world=M)
    np.testing.assert_allclose(picture.color, expected, atol=1e-12)
    d_color = 2 * (picture.color - 0.5) / picture.color.size
    found = render_backward(context, d_color).gaussians
    norms = {name: float(np.linalg.norm(array)) for name, array in found.items()}
    assert quality["grad_norm_sh"] == pytest.approx(norms.pop("sh"), rel=1e-4)
    assert row["grad_norms"] == pytest.approx(norms, rel=1e-4)

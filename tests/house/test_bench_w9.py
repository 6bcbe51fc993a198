"""The silhouette benchmark does the work that it says: its gradient is that of its loss."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest

from support.tree import ROOT

SIZE = {"nv": 24, "res": 64}

pytestmark = pytest.mark.usefixtures("core")


@pytest.mark.parametrize("words", [[], ["--ids"]], ids=["silhouettes", "ids"])
def test_w9_computes_the_workload(words: list[str]) -> None:
    sizes = [word for name, value in SIZE.items() for word in (f"--{name}", str(value))]
    command = [sys.executable, str(ROOT / "bench/w9_raster.py"), *sizes, *words, "--reps", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert (row["workload"], row["peer"]) == ("W9-forward" if words else "W9", "photograd")
    assert row["size"] == {"triangles": 2 * 48 * 23, "res": 64}
    assert row["seconds_fwd"] > 0
    quality = row["quality"]
    if words:
        assert quality["coverage_mean"] == pytest.approx(0.52, abs=0.01)
        return
    assert row["seconds_fwdbwd"] > 0
    assert quality["image_mean"] == pytest.approx(0.52, abs=0.01)
    found, expected = quality["translation_grad"], quality["translation_differences"]
    assert np.linalg.norm(expected) > 0.3
    np.testing.assert_allclose(found[:2], expected, atol=0.05)

"""What the picture of a dusty hall claims in its caption."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

import numpy as np
import pytest

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_fog as fog

pytestmark = pytest.mark.usefixtures("core")


@cache
def found() -> dict[str, Any]:
    return fog.computed(size=48, voxel=0.25)


def around(layer: Any) -> Any:
    """The largest value among each cell of (X, Y) and its eight neighbors."""
    wide = np.pad(layer, 1)
    x, y = layer.shape
    return np.max([wide[i : i + x, j : j + y] for i, j in np.ndindex(3, 3)], axis=0)


def test_the_shafts_scatter_towards_the_camera() -> None:
    scattered, clear, dusty = (
        found()[name].mean(axis=2) for name in ("scattered", "clear", "dusty")
    )
    assert scattered.max() > 10 * fog.DIM
    assert 0.03 < (scattered > 5 * fog.DIM).mean() < 0.3  # shafts, not fog everywhere
    assert ((dusty > 3 * clear) & (clear < 2 * fog.DIM)).mean() > 0.1


def test_dust_in_a_shaft_brightens_and_dust_in_the_dark_dims() -> None:
    light, derivative = found()["light"], found()["derivative"]
    shaft, dark = light > 0.2, around(light) == 0
    assert shaft.sum() > 50
    assert dark.sum() > 50
    assert (derivative[shaft] > 0).mean() > 0.95
    # Float32 leaves 2e-8 of the largest derivative where nothing should be.
    assert derivative[dark].max() < 1e-6 * derivative.max()
    assert derivative[dark].min() < -0.01 * derivative.max()
    assert derivative[shaft].max() > -derivative.min()

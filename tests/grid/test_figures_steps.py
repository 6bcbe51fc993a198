"""What the caption of the row of gradients claims."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_steps as steps
from figures_octree import BALLS


@pytest.mark.usefixtures("core")
def test_circles_ask_for_matter_first_and_say_nothing_in_the_end() -> None:
    found = steps.gradients((0, 120))
    at = (np.arange(steps.RESOLUTION) + 0.5) * 2 / steps.RESOLUTION - 1
    x, y = np.meshgrid(at, at, indexing="ij")
    inside = np.zeros(x.shape, bool)
    for center, radius, _ in BALLS:
        inside |= np.hypot(x - center[0], y - center[1]) < 0.8 * radius
    assert inside.sum() > 200
    assert (found[0][inside] < 0).mean() > 0.95
    for gradient in found.values():
        limit = steps.limit_of(gradient)
        assert abs((np.abs(gradient) <= limit).mean() - steps.SHOWN) < 1e-3  # of 2304 voxels
    last, limit = found[120], steps.limit_of(found[120])
    assert np.median(np.abs(last[inside])) < 0.005 * limit  # 0.0008
    assert np.abs(last).max() > 20 * limit  # 67: the voxel that would own the scale

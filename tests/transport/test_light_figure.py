"""What the caption of docs/images/path_lights.png says."""

from __future__ import annotations

import sys

import numpy as np
from photograd.transport.builtin import SUN

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_path_lights as figure


def test_the_loss_wants_the_sun_elsewhere() -> None:
    target, picture, gradient = figure.sky_gradient(24, 96)
    assert np.abs(target - picture).mean() > 0.05
    summed = gradient.sum(axis=2)
    assert summed[figure.texel_towards(SUN)] < 0
    assert summed[figure.texel_towards(figure.WRONG)] > 0
    # What lies below the horizon says little: 0.003 of what lies above.
    below = np.abs(summed[figure.HEIGHT // 2 + 2 :]).mean()
    assert below < 0.02 * np.abs(summed[: figure.HEIGHT // 2]).mean()

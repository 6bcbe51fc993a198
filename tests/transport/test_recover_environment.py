"""What the caption of docs/images/recover_environment.png says, under an evening sky."""

from __future__ import annotations

import sys

import numpy as np
from photograd.transport import RecoveryOptions
from photograd.transport.builtin import evening_map, map_directions

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import recover_environment as environment


def test_light_is_asked_for_where_lamps_are_and_not_behind_the_ball() -> None:
    truth = evening_map(8, np.array([0.3, 0.5, 0.8]))
    options = RecoveryOptions(steps=1, spp=32, path=environment.PATH)
    job = environment.search(truth, 1, options, 24, 128)
    gradient = environment.first_gradient(job)
    row, column = np.unravel_index(int(truth.sum(axis=2).argmax()), truth.shape[:2])
    assert gradient[row, column] < 0
    dark = map_directions(8)[..., 1] < -0.5  # the ground, in front: darker than the start
    dark &= map_directions(8)[..., 2] > 0
    assert truth[dark].max() < environment.START
    assert gradient[dark].sum() > 0
    shown = environment.sensitivity(job)
    behind, *_, front = (shown[band].mean() for band in environment.bands(8))
    assert behind < 0.01 * front  # 6e-5

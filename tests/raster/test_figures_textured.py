"""What the caption of docs/images/textured_gradients.png says."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

import numpy as np
from PIL import Image

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_textured as figure


@cache
def gradients(painted: bool = True, turn: float = figure.TURN) -> Any:
    return figure.gradients(painted=painted, turn=turn)


def test_silhouettes_of_a_ball_that_is_too_small_point_outward() -> None:
    for painted in (True, False):
        outward, _ = figure.ways(gradients(painted), "silhouettes")
        strong = np.abs(outward) > 0.02 * np.abs(outward).max()
        assert strong.sum() > 20
        assert (outward[strong] > 0).all()


def test_only_a_pattern_asks_for_anything_inside_of_faces() -> None:
    plain, painted = gradients(False), gradients()
    assert np.abs(plain.interior).max() < 1e-12 * np.abs(plain.silhouettes).max()
    assert np.abs(painted.interior).max() > 0.1 * np.abs(painted.silhouettes).max()


def test_a_pattern_that_is_turned_is_asked_back_and_the_other_way_alike() -> None:
    totals = {}
    for sign in (1, -1):
        _, right = figure.ways(gradients(turn=sign * figure.TURN), "interior")
        assert abs(right.sum()) > 0.25 * np.abs(right).sum()
        totals[sign] = right.sum()
    assert totals[1] * totals[-1] < 0
    assert 0.5 < -totals[1] / totals[-1] < 2


def test_the_picture_is_there_and_large_enough() -> None:
    with Image.open(figure.PICTURE) as picture:
        assert picture.width >= 960

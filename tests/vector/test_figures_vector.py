"""What the caption of docs/images/vector.png says."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from PIL import Image

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_vector as figure


def test_lower_loss_takes_the_digit_to_the_target_and_makes_it_bolder() -> None:
    found = figure.digit_gradient()
    assert found["d_width"] < 0
    right, down = -found["d_points"].sum(axis=0)
    assert right > 0
    assert down < 0


def test_widths_are_recovered() -> None:
    for widths in figure.recovered_widths().values():
        assert widths[-1] == pytest.approx(figure.BOLD, rel=0.02)


def test_errors_fall_with_the_square() -> None:
    for errors in figure.polyline_errors().values():
        orders = np.log2(errors[1:-1] / errors[2:])
        np.testing.assert_allclose(orders, 2, atol=0.2)


def test_the_picture_is_there_and_large_enough() -> None:
    with Image.open(figure.PICTURE) as picture:
        assert picture.width >= 960

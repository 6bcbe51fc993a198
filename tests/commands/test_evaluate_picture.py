"""Which held-out views the picture of `photograd evaluate` shows."""

from __future__ import annotations

import pytest
from photograd.commands.evaluate import picked_views


@pytest.mark.parametrize(
    ("psnr", "picked"),
    [
        ([20.0], [0]),
        ([21.0, 20.0], [1, 0]),
        ([21.0, 20.0, 22.0], [1, 0, 2]),
        ([25.0, 21.0, 20.0, 22.0, 23.0], [2, 3, 0]),
    ],
)
def test_no_view_is_shown_twice_and_worst_comes_first(psnr: list[float], picked: list[int]) -> None:
    assert picked_views(psnr) == picked

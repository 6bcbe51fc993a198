"""The shares are weighed by mass, judged only where a sign is claimed, and refuse to be vacuous."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.viz import sign_report

SHAPE = (1, 2, 4)
OCCUPIED = np.array([[[1, 1, 0, 0], [0, 0, 0, 0]]], dtype=bool)
BACKGROUND = np.array([[[0, 0, 1, 1], [0, 0, 0, 0]]], dtype=bool)
GRADIENT = np.array([[[-9.0, 1.0, 3.0, -1.0], [-50.0, 50.0, 0.0, 0.0]]])


def test_shares_by_mass_worked_by_hand() -> None:
    report = sign_report(GRADIENT, occupied=OCCUPIED, background_only=BACKGROUND)
    assert report.occupied_fraction == 0.9  # 9 of 10, though only one voxel of two
    assert report.background_fraction == 0.75  # 3 of 4
    assert (report.occupied_mass, report.background_mass, report.other_mass) == (10.0, 4.0, 100.0)
    assert (report.occupied_voxels, report.background_voxels, report.other_voxels) == (2, 2, 4)
    assert report.holds(0.75)
    assert not report.holds()


def test_a_negated_gradient_is_wrong_everywhere_and_others_do_not_count(field: Any) -> None:
    background = ~field.occupied
    report = sign_report(field.values, occupied=field.occupied, background_only=background)
    assert report.occupied_mass > 0.0
    assert (report.occupied_fraction, report.background_fraction) == (1.0, 1.0)
    assert report.holds()
    wrong = sign_report(-field.values, occupied=field.occupied, background_only=background)
    assert (wrong.occupied_fraction, wrong.background_fraction) == (0.0, 0.0)
    assert not wrong.holds(1e-9)
    changed = GRADIENT.copy()
    changed[0, 1] = 7.0
    same = sign_report(changed, occupied=OCCUPIED, background_only=BACKGROUND)
    assert same.occupied_fraction == 0.9


def test_caption_says_what_is_shown_but_not_asserted() -> None:
    text = sign_report(GRADIENT, occupied=OCCUPIED, background_only=BACKGROUND).caption()
    for part in ("90.0%", "75.0%", "4 empty voxels are shown, not asserted"):
        assert part in text


@pytest.mark.parametrize(
    ("change", "kind", "part"),
    [
        ({"occupied": OCCUPIED.astype(float)}, DtypeError, "occupied: expected a boolean"),
        ({"occupied": OCCUPIED[0]}, ShapeError, "occupied: expected shape"),
        ({"background_only": OCCUPIED}, RangeError, "no voxel that is occupied too, got 2"),
        ({"occupied": np.zeros(SHAPE, dtype=bool)}, RangeError, "at least one True"),
        ({"d_sigma_t": np.zeros(SHAPE)}, RangeError, "a gradient that is not zero"),
        ({"d_sigma_t": GRADIENT * np.nan}, RangeError, "finite"),
    ],
)
def test_nothing_to_judge_is_an_error(
    change: dict[str, Any], kind: type[Exception], part: str
) -> None:
    good = {"d_sigma_t": GRADIENT, "occupied": OCCUPIED, "background_only": BACKGROUND}
    with pytest.raises(kind, match=part):
        sign_report(**(good | change))

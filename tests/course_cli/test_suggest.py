"""A near miss is named; what is far from everything gets the whole list."""

from __future__ import annotations

import pytest
from photograd_course.suggest import choose_from, nearest

KNOWN = ["dense_grid", "texture", "gaussians", "brick_field"]


@pytest.mark.parametrize(
    ("name", "found"),
    [("dense_gird", "dense_grid"), ("Texture", "texture"), ("gaussian", "gaussians"), ("zz", None)],
)
def test_nearest(name: str, found: str | None) -> None:
    assert nearest(name, KNOWN) == found


def test_remedies() -> None:
    assert choose_from("densegrid", KNOWN) == "did you mean 'dense_grid'?"
    assert choose_from("zz", KNOWN) == "choose from brick_field, dense_grid, gaussians, texture"
    assert choose_from("zz", []) == "none is available"

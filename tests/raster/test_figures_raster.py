"""What the caption of docs/images/raster.png says."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

import numpy as np
import pytest
from PIL import Image

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_raster as figure


@cache
def gradients(shaded: bool) -> dict[str, Any]:
    return figure.sphere_gradients(shaded=shaded)


def test_a_sample_jumps_and_coverage_has_a_derivative() -> None:
    shifts = np.linspace(0.0025, 0.9975, 40)
    found = figure.moving_edge(shifts)
    np.testing.assert_allclose(found["coverage"], shifts)
    np.testing.assert_allclose(found["d_coverage"], 1)
    assert not found["d_sample"].any()
    assert sorted(set(np.diff(found["sample"]))) == [0, 1]


@pytest.mark.parametrize("shaded", [False, True])
def test_silhouettes_of_a_sphere_that_should_grow_point_outward(shaded: bool) -> None:
    found = gradients(shaded)
    outward = (-found["silhouette"] * (found["pixels"] - found["center"])).sum(axis=1)
    assert (outward > -1e-9).all()
    assert (outward > 0.01 * outward.max()).sum() > 10


def test_a_constant_color_has_no_gradient_inside_of_faces() -> None:
    plain, shaded = gradients(False), gradients(True)
    assert np.abs(plain["interior"]).max() < 1e-12 * np.abs(plain["silhouette"]).max()
    assert np.abs(shaded["interior"]).max() > 1e-3 * np.abs(shaded["silhouette"]).max()


def test_five_methods_for_one_derivative() -> None:
    found = figure.translation()
    assert found["interior"] == 0
    assert found["antialias"] == pytest.approx(found["exact"], rel=0.02)
    assert found["edge sampling"] == pytest.approx(found["exact"], rel=0.002)
    assert found["soft"] > 1.3 * found["exact"]


def test_the_picture_is_there_and_large_enough() -> None:
    with Image.open(figure.PICTURE) as picture:
        assert picture.width >= 960

"""What the picture of a photograph out of networks claims in its caption."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest
from photograd.fitting import ImageFitOptions, fit_image

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_neural_image as figure
from figures_gaussians_2d import drawing

pytestmark = pytest.mark.usefixtures("core")
OPTIONS = ImageFitOptions(steps=100, points=1 << 11, learning_rate=5e-3)


def test_the_hash_grid_does_better_than_frequencies_and_those_than_none() -> None:
    found = figure.computed(drawing(64).astype(np.float32), OPTIONS)
    psnr = [found[name].psnr for name in ("no encoding", "frequencies", "hash grid")]
    assert psnr[2] > psnr[1] + 6
    assert psnr[1] > psnr[0] + 1


def test_a_coarse_corner_gets_more_than_a_fine_one_and_fine_ones_share() -> None:
    picture = drawing(figure.SIZE).astype(np.float32)
    early = fit_image(picture, figure.HASH, replace(OPTIONS, steps=figure.EARLY, final_rate=1.0))
    residual, planes = figure.gradient(early.field, picture)
    assert residual.shape == planes[0].shape == picture.shape[:2]
    largest = [np.abs(planes[level]).max() for level in figure.SHOWN]
    assert largest[0] > 4 * largest[1] > 16 * largest[2] > 0
    level = early.field.encoding.levels[figure.SHOWN[-1]]  # type: ignore[union-attr]
    assert (level.resolution + 1) ** 2 / level.rows == pytest.approx(16, abs=0.5)

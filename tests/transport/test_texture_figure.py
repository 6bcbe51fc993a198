"""What the caption of docs/images/texture_maps.png says."""

from __future__ import annotations

import sys

import numpy as np

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_texture_maps as figure


def test_maps_show_what_is_traced() -> None:
    floor, looked_up, traced, mapped = figure.occlusion_pictures(24, 48, 1024)
    assert mapped.mean() > 0.4
    assert floor.min() < 0.05
    assert floor.max() > 0.5
    error = np.abs(looked_up - traced)[mapped]
    assert error.mean() < 0.016  # the noise of 1024 rays a pixel
    assert (looked_up[~mapped] < traced[~mapped]).mean() > 0.8  # boxes have no map, and are black


def test_one_filtered_sample_is_gray_where_many_would_be() -> None:
    one, filtered, truth = figure.floor_pictures(32, 256)
    far = slice(9, 17)
    plain, mip = (float(np.std((found - truth)[far])) for found in (one, filtered))
    assert mip < 0.5 * plain  # 0.37

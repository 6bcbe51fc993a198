"""What the pictures of sparse structures claim in their captions."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd.fitting.voxel_gradients import density_gradient

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_bricks as bricks
import figures_octree as octree
import figures_sh as harmonics


@cache
def gradient() -> tuple[Any, Any]:
    """What the model holds to be full, and dL/dsigma_t."""
    field, full = octree.model_without_the_last_ball()
    pixels = octree.photographs(48)
    return full, density_gradient(field, pixels, seed=0, rays=1 << 16).d_sigma_t


def in_lacking_ball(cells: Any, count: int, *, share: float = 1.0) -> Any:
    """Which cells (M, 3) of `count` a side have their middle in the ball that the model lacks."""
    center, radius, _ = octree.BALLS[-1]
    middle = (cells + 0.5) * 2.0 / count - 1.0
    return ((middle - np.array(center)) ** 2).sum(axis=1) < (share * radius) ** 2


def test_the_wish_for_matter_reaches_no_brick() -> None:
    full, d_sigma_t = gradient()
    kept = bricks.active_bricks(full)
    count = octree.RESOLUTION // bricks.BRICK
    voxels = np.argwhere(np.ones(d_sigma_t.shape, bool))
    wish = d_sigma_t[tuple(voxels[in_lacking_ball(voxels, octree.RESOLUTION)].T)]
    assert len(wish) > 1000
    assert (wish < 0).mean() > 0.9  # blue
    lacking = voxels[in_lacking_ball(voxels, octree.RESOLUTION)] // bricks.BRICK
    assert not kept[tuple(lacking.T)].any()
    assert kept.sum() < 0.2 * count**3  # and the rest is sparse indeed
    assert kept[tuple((np.argwhere(full) // bricks.BRICK).T)].all()


def test_the_hash_hears_it_first_and_locates_it_later() -> None:
    _, d_sigma_t = gradient()
    limit = float(np.quantile(np.abs(d_sigma_t), 0.98))
    shares = []
    for (cells, mean), count in zip(
        bricks.hash_levels(d_sigma_t, limit), bricks.LEVELS, strict=True
    ):
        near = in_lacking_ball(cells, count)
        assert mean[near].min() < 0
        assert mean[near].sum() < 0
        shares.append((len(cells) / count**3, mean.min()))
    assert shares[0][0] == 1.0  # the coarsest level holds everything
    assert shares[0][0] > shares[1][0] > shares[2][0]
    assert shares[0][1] > shares[1][1] > shares[2][1]  # the smaller the cell, the clearer the wish


def test_a_leaf_gets_the_sum_of_its_voxels() -> None:
    full, d_sigma_t = gradient()
    tree = octree.Octree.from_dense(full[..., None], octree.BOX)
    leaves = tree.expand_backward(d_sigma_t[..., None])[:, 0]
    assert leaves.sum() == pytest.approx(d_sigma_t.sum(), rel=1e-4)
    _, side = tree.leaf_boxes()
    center = np.array([octree.BALLS[-1][0]])
    (leaf,) = tree.leaf_at(center)
    assert side[leaf] > 1  # the model's tree is coarse there
    cell = np.abs(leaves[leaf]) / side[leaf] ** 3
    index = tuple(np.floor((center[0] + 1) / 2 * octree.RESOLUTION).astype(int))
    assert cell < np.abs(d_sigma_t[index])  # wishes of both signs cancel in it


def test_cells_ask_to_be_brighter_from_where_they_are_photographed_brighter() -> None:
    found = harmonics.wishes()
    biggest = np.abs(found.value).max()
    # Nothing is lacking there, but the left ball shines faintly through its edge: measured 0.018.
    assert np.abs(found.value[found.ball == 1]).max() < 0.03 * biggest < harmonics.LEAST * biggest
    left_ball = found.ball == 0
    from_right = found.value[left_ball][:, 0]
    from_left = found.value[left_ball][:, len(harmonics.ANGLES) // 2]
    x, y = (found.center[left_ball] - harmonics.BALLS[0][0][:2]).T
    seen = np.abs(found.value[left_ball]).max(axis=1) > harmonics.LEAST * biggest
    assert seen.sum() > 12
    right, left = seen & (x > 0.25), seen & (x < -0.25)
    assert (from_right[right] < 0).all()  # blue, towards the right
    assert (from_left[left] > 0).all()  # red, towards the left
    assert (np.abs(from_right[right]) > np.abs(from_left[right])).all()
    assert (np.abs(from_left[left]) > np.abs(from_right[left])).all()
    inside = np.hypot(x, y) < 0.2
    assert inside.any()
    assert not seen[inside].any()  # no ray arrives

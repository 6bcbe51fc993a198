"""dL/dsigma_t of every representation that has voxels or leaves, as the pictures draw it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.fields import DenseGrid, DenseSh, OctreeSh, SparseSh
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.voxel_field import VoxelField
from photograd.fitting.data import TrainingPixels
from photograd.fitting.voxel_gradients import density_gradient, voxel_masks
from photograd_course.gradcheck import check_gradient
from PIL import Image

from tests.fit.test_density_gradient import BOX, ball, start


def sparse(mask: Any) -> SparseSh:
    """A grid of the capture's box with these voxels (X, X, X)."""
    full = SparseSh.full(BOX, len(mask), degree=1, dtype=np.float64)
    active = ActiveVoxels(mask)
    color = np.full((len(active), 4, 3), 0.3)
    return SparseSh(active, np.zeros(len(active)), color, full.policy)


def octree() -> OctreeSh:
    """Leaves of three sizes, a third of them empty, in the box of the capture."""
    field = OctreeSh.example(seed=3)
    field.tree.bounds[...] = BOX
    return field


FIELDS: dict[str, Any] = {
    "dense_grid": lambda: start(6, np.float64),
    "dense_sh": lambda: DenseSh.full(BOX, 6, degree=1, dtype=np.float64),
    "sparse_sh": lambda: sparse(np.random.default_rng(1).random((7, 7, 7)) > 0.3),
    "octree_sh": octree,
}


def rows_of(field: VoxelField, voxels: Any) -> Any:
    """The number (N,) that an array (X, Y, Z) has at each voxel, in the first cell of a leaf."""
    if isinstance(field, DenseGrid):
        return voxels.ravel()
    if isinstance(field, OctreeSh):
        lower, _ = field.tree.leaf_boxes()
        leaf = np.argsort(field.row)[-len(field.params["density"]) :]
        return voxels[tuple(lower[leaf].T)]
    return voxels[tuple(field.active.voxels.T)]


@pytest.mark.parametrize("name", FIELDS)
def test_what_is_drawn_is_the_gradient(name: str) -> None:
    field = FIELDS[name]()
    pixels = TrainingPixels(ball().train, "display")
    raw = field.density_rows(field.params)
    scale = field.policy.density_scale
    sigma_t = np.random.default_rng(1).uniform(0.1, 2.0, len(raw))

    def evaluate(p: dict[str, Any]) -> Any:
        changed = np.log(np.expm1(p["sigma_t"] / scale))
        if isinstance(field, DenseGrid):
            field.density[...] = changed.reshape(field.density.shape)
        else:
            field.params["density"][...] = changed
        return density_gradient(field, pixels, seed=3, rays=300)

    found = evaluate({"sigma_t": sigma_t})
    assert np.abs(rows_of(field, found.d_sigma_t)).max() > 1e-5
    assert not found.d_sigma_t[~found.active].any()
    report = check_gradient(
        lambda p: evaluate(p).loss,
        lambda p, d: {"sigma_t": d * rows_of(field, evaluate(p).d_sigma_t).astype(np.float64)},
        {"sigma_t": sigma_t},
        seed=1,
        directions=3,
        coordinates=8,
    )
    assert report, str(report)


@pytest.mark.parametrize("name", FIELDS)
def test_rows_come_to_their_voxels(name: str) -> None:
    field = FIELDS[name]()
    rows = 1.0 + np.arange(len(field.density_rows(field.params)))
    voxels, active = field.to_voxels(rows), field.active_voxels
    assert voxels.shape == active.shape == field.voxel_shape
    assert np.array_equal(active, voxels > 0)
    assert np.array_equal(rows_of(field, voxels), rows)
    assert active.all() == (name in ("dense_grid", "dense_sh"))


def test_all_cells_of_a_leaf_show_its_number() -> None:
    field = octree()
    found = density_gradient(field, TrainingPixels(ball().train, "display"), seed=1, rays=3000)
    sides = set()
    for corner, side, row in zip(*field.tree.leaf_boxes(), field.row, strict=True):
        cells = tuple(slice(at, at + side) for at in corner)
        assert (found.d_sigma_t[cells] == found.d_sigma_t[tuple(corner)]).all()
        assert (found.active[cells] == (row >= 0)).all()
        sides.add(int(side))
    assert sides == {1, 2, 4}


def test_a_voxel_that_is_not_there_is_known_to_be_nothing() -> None:
    mask = np.ones((16, 16, 16), np.bool_)
    whole = voxel_masks(sparse(mask), ball())
    mask[8:] = False
    half = voxel_masks(sparse(mask), ball())
    for name in ("occupied", "background_only"):
        assert np.array_equal(getattr(half, name)[:8], getattr(whole, name)[:8])
        assert getattr(whole, name)[8:].any()
        assert not getattr(half, name)[8:].any()


def test_masked_pixels_are_no_background(tmp_path: Path) -> None:
    Image.new("L", (64, 64)).save(tmp_path / "nothing.png")
    hidden = tuple(replace(view, mask_file=tmp_path / "nothing.png") for view in ball().train)
    assert voxel_masks(start(16), ball()).background_only.any()
    masks = voxel_masks(start(16), replace(ball(), train=hidden))
    assert not masks.background_only.any()
    assert not masks.occupied.any()

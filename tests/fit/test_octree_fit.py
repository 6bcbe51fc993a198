"""An octree cut from a grid that was fitted, and its leaves refined from the photographs."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from photograd.capture.capture import Capture
from photograd.errors import RangeError, ShapeError
from photograd.fields import OctreeSh, SparseSh
from photograd.fitting.compare import parse_candidates, source_of
from photograd.fitting.evaluate import evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.steps import RowAdam
from photograd.grids.octree import Octree, tree_of_leaves

from tests.fit import scene
from tests.fit.test_resume import assert_same, run

GRID = {"resolution": 16, "steps": 150, "rays": 1024, "degree": 1}
LEAVES = {"representation": "octree_sh", "steps": 60, "rays": 1024, "degree": 1}


@pytest.fixture(scope="module")
def capture() -> Capture:
    return scene.capture()


@pytest.fixture(scope="module", params=["sparse_sh", "dense_grid"])
def grid(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Model:
    folder = tmp_path_factory.mktemp(request.param)
    options = scene.options(**GRID, representation=request.param)
    run(Fit.start(scene.capture(), options), folder)
    return load_model(folder)


def model_of(fit: Fit) -> Model:
    return Model(fit.model, None, fit.options, {}, np.zeros((0, 3)))


def test_what_tabulating_loses_partly_comes_back(
    grid: Model, capture: Capture, tmp_path: Path
) -> None:
    fit = Fit.start(capture, scene.options(**LEAVES), start_from=grid)
    assert isinstance(fit.model, OctreeSh)
    assert isinstance(fit.optimizer, RowAdam)
    before = fit.model.state()
    whole, cut = (evaluate(model, capture.test).psnr for model in (grid, model_of(fit)))
    run(fit, tmp_path)
    loaded = load_model(tmp_path)
    refined = evaluate(loaded, capture.test).psnr
    # Measured, sparse: 34.6, 27.2, 30.2 dB; dense: 36.1, 27.4, 30.4. Cells are as large as pixels.
    assert cut < whole - 3
    assert refined > cut + 2
    after = loaded.field.state()
    assert all(np.array_equal(before[name], after[name]) for name in before)
    shorter = {**after, "row": after["row"][1:]}
    with pytest.raises(ShapeError, match="OctreeSh: row"):
        OctreeSh.restored(loaded.field.params, shorter, asdict(fit.model.policy), loaded.options)


def test_a_stopped_fit_ends_with_the_same_bits(
    grid: Model, capture: Capture, tmp_path: Path
) -> None:
    options = scene.options(**{**LEAVES, "steps": 12, "rays": 128})
    run(Fit.start(capture, options, start_from=grid), tmp_path / "straight")
    run(Fit.start(capture, options, start_from=grid), tmp_path / "stopped", until=5)
    run(Fit.resume(capture, tmp_path / "stopped"), tmp_path / "stopped")
    assert_same(tmp_path / "straight", tmp_path / "stopped")


def test_a_learned_background_is_kept(capture: Capture) -> None:
    options = scene.options(**{**GRID, "steps": 1, "background": "learned"})
    start = Fit.start(capture, options)
    start.step()
    first = Model(start.model, np.array([0.2, 0.3, 0.9]), options, {}, np.zeros((0, 3)))
    leaves = scene.options(**{**LEAVES, "background": "learned"})
    fit = Fit.start(capture, leaves, start_from=first)
    assert fit.background is not None
    np.testing.assert_allclose(1 / (1 + np.exp(-fit.background)), [0.2, 0.3, 0.9], rtol=1e-6)


def test_it_has_to_be_cut_from_voxels(grid: Model, capture: Capture) -> None:
    with pytest.raises(RangeError, match=r"'octree_sh' starts from, got none \(fit a dense_"):
        Fit.start(capture, scene.options(**LEAVES))
    leaves = Fit.start(capture, scene.options(**LEAVES), start_from=grid)
    with pytest.raises(RangeError, match="a model of dense_grid or sparse_sh or dense_sh"):
        Fit.start(capture, scene.options(**LEAVES), start_from=model_of(leaves))
    with pytest.raises(
        RangeError,
        match="none, or 'gaussian_codes' or 'gaussians' or 'leaf_codes' or 'leaf_mlps' or 'mesh'",
    ):
        Fit.start(capture, scene.options(**GRID), start_from=grid)


def test_harmonics_are_added_or_left_out() -> None:
    field = SparseSh.example(seed=2)
    own = OctreeSh.from_sparse_sh(field)
    more, fewer = (OctreeSh.from_sparse_sh(field, degree=n) for n in (3, 0))
    assert [f.params["sh"].shape[1] for f in (own, more, fewer)] == [9, 16, 1]
    np.testing.assert_array_equal(more.params["sh"][:, :9], own.params["sh"])
    np.testing.assert_array_equal(fewer.params["sh"], own.params["sh"][:, :1])
    assert not more.params["sh"][:, 9:].any()
    assert np.abs(own.params["sh"][:, 1:]).max() > 0


def test_a_tree_is_rebuilt_from_its_leaves() -> None:
    chance = np.random.default_rng(4).random((4, 4, 4)) < 0.4
    cells = chance.repeat(2, 0).repeat(2, 1).repeat(2, 2)[:7, :8, :5, None]
    tree = Octree.from_dense(cells, [[0, 0, 0], [7, 8, 5]])
    lower, side = tree.leaf_boxes()
    order = np.random.default_rng(5).permutation(len(side))
    again = tree_of_leaves(lower[order], side[order], tree.bounds, (7, 8, 5))
    number = again.values[:, 0].astype(int)
    assert len(side) > 50
    np.testing.assert_array_equal(again.leaf_boxes()[0], lower[order][number])
    points = np.random.default_rng(6).random((1000, 3)) * [7, 8, 5]
    there = order[number[again.leaf_at(points)]]
    np.testing.assert_array_equal(there, tree.leaf_at(points))


def test_leaves_that_are_no_tree_are_refused() -> None:
    lower, side = Octree.from_dense(np.ones((2, 2, 2, 1), bool)).leaf_boxes()
    bounds = [[0, 0, 0], [2, 2, 2]]
    with pytest.raises(ShapeError, match="tree_of_leaves"):
        tree_of_leaves(lower[:, :2], side, bounds, (2, 2, 2))
    with pytest.raises(RangeError):
        tree_of_leaves(np.array([[0, 0, 0], [1, 0, 0]]), np.array([1, 1]), bounds, (2, 2, 2))
    overlapping = np.zeros((2, 3), int), np.array([2, 1])
    with pytest.raises(RangeError, match="2 cubes that fill one"):
        tree_of_leaves(*overlapping, bounds, (2, 2, 2))


def test_compare_cuts_from_the_grid_before() -> None:
    listed = parse_candidates("sparse_sh:16,dense_grid:16,dense_grid:32,octree_sh:16")
    assert source_of(listed[3], listed) == listed[1]
    assert source_of(listed[0], listed) is None
    with pytest.raises(RangeError, match=r"octree_sh:32 starts from before it.*with 32 \(fit a"):
        parse_candidates("dense_grid:16,octree_sh:32,dense_grid:32")

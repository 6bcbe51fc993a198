"""A field of networks, tabulated and refined: `plenoctree`, from a fit to a checkpoint."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.capture.capture import Capture
from photograd.errors import RangeError
from photograd.fields import PlenOctree, plenoctree
from photograd.fitting.compare import parse_candidates, source_of
from photograd.fitting.evaluate import evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model

from tests.fit import scene
from tests.fit.test_octree_fit import model_of
from tests.fit.test_resume import assert_same, run

LEAVES = {"representation": "plenoctree", "resolution": 24, "rays": 512, "degree": 1}


@pytest.fixture(scope="module")
def capture() -> Capture:
    return scene.capture()


@pytest.fixture(scope="module")
def networks(capture: Capture, tmp_path_factory: pytest.TempPathFactory) -> Model:
    folder = tmp_path_factory.mktemp("networks")
    options = scene.options(representation="hash_grid", resolution=32, rays=256, steps=60)
    run(Fit.start(capture, options), folder)
    return load_model(folder)


def test_refining_the_leaves_brings_back_what_tabulating_lost(
    networks: Model, capture: Capture, tmp_path: Path
) -> None:
    fit = Fit.start(capture, scene.options(**LEAVES, steps=60), start_from=networks)
    assert isinstance(fit.model, PlenOctree)
    assert "leaves hold matter, in a tree of 24³ cells" in fit.start_rule
    before = fit.model.state()
    whole, cut = (evaluate(model, capture.test).psnr for model in (networks, model_of(fit)))
    run(fit, tmp_path)
    loaded = load_model(tmp_path)
    refined = evaluate(loaded, capture.test).psnr
    assert cut > whole - 6
    assert refined > cut + 1
    after = loaded.field.state()
    assert all(np.array_equal(before[name], after[name]) for name in before)


def test_a_stopped_fit_ends_with_the_same_bits(
    networks: Model, capture: Capture, tmp_path: Path
) -> None:
    options = scene.options(**LEAVES | {"resolution": 12, "rays": 64}, steps=8)
    run(Fit.start(capture, options, start_from=networks), tmp_path / "straight")
    run(Fit.start(capture, options, start_from=networks), tmp_path / "stopped", until=3)
    run(Fit.resume(capture, tmp_path / "stopped"), tmp_path / "stopped")
    assert_same(tmp_path / "straight", tmp_path / "stopped")


def test_leaves_that_weigh_little_in_every_view_are_dropped(
    networks: Model, capture: Capture
) -> None:
    sizes = [
        PlenOctree.from_field(networks.field, 12, capture, degree=0, prune=prune).shape[0]
        for prune in (0.0, 0.3, 0.6)
    ]
    assert sizes == sorted(sizes, reverse=True)
    assert 0 < sizes[2] < sizes[0]


def test_leaves_smaller_than_a_pixel_are_looked_for_in_every_pixel(
    networks: Model, capture: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    pixels = sum(view.camera.width * view.camera.height for view in capture.train)
    assert sum(len(batch.pixel) for batch in plenoctree._training_rays(capture)) == pixels
    leaves = [PlenOctree.from_field(networks.field, 48, capture, degree=0).shape[0]]
    monkeypatch.setattr(plenoctree, "VISIBILITY_RAYS", pixels // 8)
    leaves.append(PlenOctree.from_field(networks.field, 48, capture, degree=0).shape[0])
    assert 0 < leaves[1] < 0.5 * leaves[0]  # measured: 0.18


def test_it_starts_from_networks_alone(capture: Capture) -> None:
    with pytest.raises(RangeError, match=r"'plenoctree' starts from, got none \(fit a hash_grid"):
        Fit.start(capture, scene.options(**LEAVES))
    grid = model_of(Fit.start(capture, scene.options()))
    with pytest.raises(RangeError, match="a model of hash_grid or nerf, got 'dense_grid'"):
        Fit.start(capture, scene.options(**LEAVES), start_from=grid)
    listed = parse_candidates("hash_grid:512,plenoctree:128,sparse_sh:64,leaf_codes:64")
    assert [source_of(one, listed) for one in listed] == [None, listed[0], None, listed[2]]

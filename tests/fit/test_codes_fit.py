"""Networks a cell and codes of Gaussians, from a fit to a checkpoint."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.capture.capture import Capture
from photograd.errors import RangeError
from photograd.fitting.compare import parse_candidates, source_of
from photograd.fitting.evaluate import evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model

from tests.fit import scene
from tests.fit.test_octree_fit import model_of
from tests.fit.test_resume import assert_same, run

FIRST = {
    "leaf_mlps": {"representation": "hash_grid", "resolution": 32, "rays": 256, "steps": 60},
    "gaussian_codes": {"representation": "gaussians", "gaussians": 300, "steps": 60},
}
NEXT = {
    "leaf_mlps": {"representation": "leaf_mlps", "resolution": 24, "rays": 512},
    "gaussian_codes": {"representation": "gaussian_codes"},
}


@pytest.fixture(scope="module")
def capture() -> Capture:
    return scene.capture()


@pytest.fixture(scope="module", params=sorted(FIRST))
def first(
    request: pytest.FixtureRequest, capture: Capture, tmp_path_factory: pytest.TempPathFactory
) -> tuple[str, Model]:
    folder = tmp_path_factory.mktemp("first")
    run(Fit.start(capture, scene.options(**FIRST[request.param])), folder)
    return request.param, load_model(folder)


def test_it_starts_near_the_first_model_and_improves_with_the_same_structure(
    first: tuple[str, Model], capture: Capture, tmp_path: Path
) -> None:
    name, model = first
    fit = Fit.start(capture, scene.options(**NEXT[name], steps=40), start_from=model)
    before, known = fit.model.state(), evaluate(model, capture.test).psnr
    at_start = evaluate(model_of(fit), capture.test).psnr
    run(fit, tmp_path)
    loaded = load_model(tmp_path)
    assert at_start > known - 6
    assert evaluate(loaded, capture.test).psnr > at_start + 0.3
    assert all(np.array_equal(before[key], loaded.field.state()[key]) for key in before)


def test_a_stopped_fit_ends_with_the_same_bits(
    first: tuple[str, Model], capture: Capture, tmp_path: Path
) -> None:
    name, model = first
    options = scene.options(**NEXT[name], steps=6)
    run(Fit.start(capture, options, start_from=model), tmp_path / "whole")
    halved = Fit.start(capture, options, start_from=model)
    halved.run(tmp_path / "parts", should_stop=lambda: halved.step_number >= 3)
    run(Fit.resume(capture, tmp_path / "parts"), tmp_path / "parts")
    assert_same(tmp_path / "whole", tmp_path / "parts")


def test_they_start_from_nothing_else(first: tuple[str, Model], capture: Capture) -> None:
    name, model = first
    (other,) = set(NEXT) - {name}
    with pytest.raises(RangeError, match=f"'{name}' starts from, got none"):
        Fit.start(capture, scene.options(**NEXT[name], steps=2))
    with pytest.raises(RangeError, match="a model of"):
        Fit.start(capture, scene.options(**NEXT[other], steps=2), start_from=model)


def test_a_comparison_takes_them_after_what_they_start_from() -> None:
    listed = parse_candidates("hash_grid:512,leaf_mlps:64,gaussians:900,gaussian_codes:900")
    assert source_of(listed[1], listed) == listed[0]
    assert source_of(listed[3], listed) == listed[2]
    with pytest.raises(RangeError, match="gaussian_codes:64 starts from before it"):
        parse_candidates("gaussians:900,gaussian_codes:64")

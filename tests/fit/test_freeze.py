"""Learn, freeze, refine: one driver, two scored moments, whatever the structure is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.capture.capture import Capture
from photograd.errors import IoError, RangeError
from photograd.fields import HashGrid
from photograd.fitting.freeze import FROZEN, learn_freeze_refine
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model

from tests.fit import scene

GRID = {"representation": "sparse_sh", "resolution": 16, "steps": 60, "rays": 512, "degree": 0}


@pytest.fixture(scope="module")
def capture() -> Capture:
    return scene.capture()


@pytest.fixture(scope="module")
def grid(capture: Capture, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("grid")
    found = learn_freeze_refine(Fit.start(capture, scene.options(**GRID)), folder)
    assert found is not None
    assert (found.frozen.step, found.refined.step) == (31, 60)
    assert found.refined.psnr > found.frozen.psnr
    assert found.refined.bytes == found.frozen.bytes > 1000
    assert found.refined.frame_ms > 0
    return folder


@pytest.mark.parametrize("name", ["octree_sh", "leaf_codes"])
def test_what_is_cut_from_a_model_is_frozen_from_the_start(
    name: str, grid: Path, capture: Capture, tmp_path: Path
) -> None:
    options = scene.options(representation=name, steps=30, rays=512, degree=0)
    fit = Fit.start(capture, options, start_from=load_model(grid))
    before = fit.model.state()
    found = learn_freeze_refine(fit, tmp_path)
    assert found is not None
    assert found.frozen.step == 0
    assert found.refined.psnr > found.frozen.psnr + 0.5
    after = load_model(tmp_path).field.state()
    assert all(np.array_equal(before[key], after[key]) for key in before)


def test_networks_keep_their_occupancy(capture: Capture, tmp_path: Path) -> None:
    options = scene.options(representation="hash_grid", resolution=16, steps=66, rays=16)
    fit = Fit.start(capture, options)
    assert isinstance(fit.model, HashGrid)
    held: list[object] = []

    def run(job: Fit, folder: Path, enough: object) -> object:
        result = job.run(folder, should_stop=enough)  # type: ignore[arg-type]
        assert isinstance(job.model, HashGrid)
        held.append(None if job.model.reached is None else job.model.reached.copy())
        return result

    assert learn_freeze_refine(fit, tmp_path, run=run) is not None  # type: ignore[arg-type]
    assert held[0] is not None
    np.testing.assert_array_equal(held[0], held[1])  # type: ignore[arg-type]


def test_a_stopped_fit_goes_on_and_keeps_its_first_moment(capture: Capture, tmp_path: Path) -> None:
    fit = Fit.start(capture, scene.options(**GRID | {"steps": 20}))

    def until(step: int) -> object:
        return lambda job, folder, enough: job.run(
            folder, should_stop=lambda: job.step_number >= step or enough()
        )

    assert learn_freeze_refine(fit, tmp_path, run=until(5)) is None  # type: ignore[arg-type]
    assert not (tmp_path / FROZEN).exists()
    fit = Fit.resume(capture, tmp_path)
    assert learn_freeze_refine(fit, tmp_path, run=until(14)) is None  # type: ignore[arg-type]
    kept = (tmp_path / FROZEN).read_text()
    found = learn_freeze_refine(Fit.resume(capture, tmp_path), tmp_path)
    assert found is not None
    assert (found.frozen.step, found.refined.step) == (11, 20)
    assert (tmp_path / FROZEN).read_text() == kept


def test_what_has_no_structure_and_what_passed_it_are_refused(
    capture: Capture, tmp_path: Path
) -> None:
    dense = Fit.start(capture, scene.options(resolution=8, steps=4, rays=64))
    with pytest.raises(RangeError, match=r"whose structure is discrete, got 'dense_grid'"):
        learn_freeze_refine(dense, tmp_path)
    late = Fit.start(capture, scene.options(**GRID | {"steps": 8, "rays": 64}))
    late.run(tmp_path, should_stop=lambda: late.step_number >= 7)
    with pytest.raises(RangeError, match=r"a fit before step 5, got one at step 7 \(begin it"):
        learn_freeze_refine(late, tmp_path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "valid JSON"),
        ("[1]", "expected an object"),
        ('{"step": 3, "psnr": 20.0}', "missing or unknown bytes, frame_ms, seconds"),
        ('{"step": 3, "psnr": "high", "bytes": 1, "frame_ms": 1.0, "seconds": 1.0}', "psnr"),
    ],
)
def test_a_damaged_first_moment_is_named(
    text: str, words: str, capture: Capture, tmp_path: Path
) -> None:
    fit = Fit.start(capture, scene.options(**GRID | {"steps": 4, "rays": 64}))
    (tmp_path / FROZEN).write_text(text)
    fit.run(tmp_path)
    with pytest.raises(IoError, match=rf"{FROZEN}: expected what .*{words}.*in another folder"):
        learn_freeze_refine(fit, tmp_path)

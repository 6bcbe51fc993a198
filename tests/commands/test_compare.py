"""`photograd compare` on a tiny capture and a tiny built-in scene."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd._checkpoint import load_checkpoint
from photograd.capture.load import load_capture
from photograd.errors import RangeError
from photograd.fitting.compare import Candidate, Score, markdown, parse_candidates
from photograd.fitting.evaluate import evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model
from photograd.images.read import read_image

from tests.commands.conftest import Photograd

FEW = ("--steps", 15, "--rays", 256, "--seed", 1)
PAIR = "dense_grid:8,dense_grid:16"


def test_two_candidates_are_fitted_scored_and_drawn(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    words = ("compare", capture_folder, "--candidates", PAIR, "--out", tmp_path, *FEW, "--json")
    done = photograd(*words)
    assert done.code == 0, done.err
    coarse, fine = done.result()["scores"]
    assert [coarse["candidate"], fine["candidate"]] == PAIR.split(",")
    for score, resolution in ((coarse, 8), (fine, 16)):
        folder = tmp_path / capture_folder.name / f"dense_grid_{resolution}"
        shape = load_checkpoint(folder).params["values"].shape
        assert max(shape) == resolution
        assert score["parameter_bytes"] == 4 * np.prod(shape)
        assert 5 < score["psnr"] < 60
        assert score["train_seconds"] > 0
        assert score["frame_ms"] > 0
    assert "held-out views" in done.result()["protocols"][0]
    table = (tmp_path / "table.md").read_text(encoding="utf-8")
    assert table.count("dense_grid") == 2
    assert f"**{max(coarse['psnr'], fine['psnr']):.2f}**" in table
    pictures = [Path(name) for name in done.result()["pictures"]]
    assert [path.name for path in pictures] == [f"{capture_folder.name}.png", "quality.png"]
    for picture in pictures:
        assert read_image(picture)[..., :3].std() > 0.05

    again = photograd(*words)  # nothing is fitted twice, and nothing changes but the frame's time
    assert again.code == 0
    for before, after in zip((coarse, fine), again.result()["scores"], strict=True):
        assert {**after, "frame_ms": 0} == {**before, "frame_ms": 0}


def test_validation_scores_training_views_that_the_fit_did_not_see(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    whole = load_capture(capture_folder)
    split = whole.with_validation_split()
    names = [{view.name for view in part} for part in (split.train, split.test, whole.test)]
    assert names[0] | names[1] == {view.name for view in whole.train}
    assert all(names)
    assert not names[0] & names[1]
    assert not names[1] & names[2]
    words = ("compare", capture_folder, "--candidates", "dense_grid:8", "--out", tmp_path, *FEW)
    done = photograd(*words, "--validate", "--json")
    assert done.code == 0, done.err
    (score,) = done.result()["scores"]
    assert score["capture"] == f"{capture_folder.name}_validation"
    model = tmp_path / score["capture"] / "dense_grid_8"
    job = Fit.resume(split, model)
    assert score["psnr"] == pytest.approx(evaluate(load_model(model), split.test).psnr)
    assert job.step_number == 15


def test_a_folder_of_other_options_is_not_taken_for_these(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    words = ("compare", capture_folder, "--candidates", "dense_grid:8", "--out", tmp_path)
    assert photograd(*words, *FEW).code == 0
    other = photograd(*words, "--steps", 16, "--rays", 256, "--seed", 1)
    assert other.code == 1
    assert "a folder of the same options" in other.err


def test_a_built_in_scene_is_photographed_once(photograd: Photograd, tmp_path: Path) -> None:
    words = (
        "compare",
        "flat_walls",
        "--candidates",
        "dense_grid:8",
        "--out",
        tmp_path,
        *FEW,
        "--views",
        4,
        "--size",
        16,
        "--spp",
        1,
        "--json",
    )
    assert photograd(*words).code == 0
    (photographs,) = (tmp_path / "flat_walls").glob("capture_*/transforms_train.json")
    made = photographs.stat().st_mtime_ns
    assert photograd(*words).code == 0
    assert photographs.stat().st_mtime_ns == made


def test_a_dense_and_a_sparse_candidate(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    pair = "dense_grid:16,sparse_sh:16"
    words = ("compare", capture_folder, "--candidates", pair, "--out", tmp_path, *FEW, "--json")
    done = photograd(*words)
    assert done.code == 0, done.err
    dense, sparse = done.result()["scores"]
    assert [dense["candidate"], sparse["candidate"]] == pair.split(",")
    saved = load_checkpoint(tmp_path / capture_folder.name / "sparse_sh_16")
    assert sparse["parameter_bytes"] >= sum(a.nbytes for a in saved.params.values()) > 0
    assert 5 < sparse["psnr"] < 60


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("dense_grid", "NAME:RESOLUTION"),
        ("dense_grid:4", "a resolution of 8 or more"),
        ("dense_grid:x", "for example"),
        ("dense_grid:8, dense_grid:8", "each only once"),
        ("texture_2d:8", "2D canvas"),
        ("dens_grid:8", "did you mean 'dense_grid'"),
    ],
)
def test_candidates_that_cannot_be(text: str, words: str) -> None:
    with pytest.raises(RangeError, match=words):
        parse_candidates(text)


def test_candidates_are_read() -> None:
    assert parse_candidates("dense_grid:8, dense_grid:16") == [
        Candidate("dense_grid", 8),
        Candidate("dense_grid", 16),
    ]


def test_neither_folder_nor_scene(photograd: Photograd, tmp_path: Path) -> None:
    done = photograd("compare", "folage", "--out", tmp_path)
    assert done.code == 1
    assert "did you mean 'foliage'" in done.err


def test_the_best_of_each_capture_is_bold() -> None:
    def score(capture: str, candidate: str, psnr: float) -> Score:
        return Score(capture, candidate, psnr, 0.9, 1 << 20, 12.3, 45.6, 2, "8 held-out views")

    text = markdown([score("a", "x", 30.0), score("a", "y", 20.0), score("b", "x", 25.0)])
    assert "| a | x | **30.00** | 0.900 | 1.0 | 12 | 46 |" in text
    assert "| a | y | 20.00 |" in text
    assert "| b | x | **25.00** |" in text
    assert text.endswith("2 threads.\n8 held-out views.\n")


def test_gaussians_stand_beside_grids(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    words = ("--candidates", "dense_grid:8,gaussians:120", "--out", tmp_path, *FEW, "--json")
    done = photograd("compare", capture_folder, *words)
    assert done.code == 0, done.err
    score = done.result()["scores"][1]
    assert score["candidate"] == "gaussians:120"
    assert score["parameter_bytes"] == 4 * 120 * (3 + 3 + 4 + 1 + 3 * 16)
    assert 5 < score["psnr"] < 60

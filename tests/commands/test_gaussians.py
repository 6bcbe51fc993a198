"""A scene of Gaussians through every command that a model goes through."""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd.commands.fit import PLY_NAME
from photograd.data.gaussian_ply import read_gaussian_ply
from photograd.data.images import read_image
from photograd_course.cli.entry import run

from tests.commands.conftest import Photograd

FIT = ("--representation", "gaussians", "--gaussians", 300, "--steps", 60)


@pytest.fixture(scope="module")
def model(capture_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Fitted once; tests only read it."""
    out = tmp_path_factory.mktemp("gaussians")
    assert run(["fit", str(capture_folder), "--out", str(out), *map(str, FIT)]) == 0
    return out


def test_the_fit_leaves_a_file_for_other_viewers(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    done = photograd("fit", capture_folder, "--out", tmp_path, *FIT, "--json")
    assert done.code == 0, done.err
    assert done.result()["finished"] is True
    assert done.result()["gaussians"] == str(tmp_path / PLY_NAME)
    for words in ("Gaussians: 300 random points in the silhouettes of all views", "Gaussians 300"):
        assert words in done.err
    gaussians = read_gaussian_ply(tmp_path / PLY_NAME)
    assert len(gaussians) == 300
    assert gaussians.degree == 3


def test_a_model_is_described(photograd: Photograd, model: Path) -> None:
    told = photograd("info", model, "--json").result()
    assert told["representation"] == "gaussians"
    assert told["shape"] == [300]
    assert told["step"] == 60


def test_a_model_is_scored_and_drawn(
    photograd: Photograd, model: Path, capture_folder: Path, tmp_path: Path
) -> None:
    strips, turn = tmp_path / "strips.png", tmp_path / "turn.gif"
    scored = photograd("evaluate", model, capture_folder, "--out", strips, "--json").result()
    assert scored["psnr"] > 12
    assert strips.stat().st_size > 1000
    drawn = photograd("render", model, "--orbit", 2, "--size", 32, "--out", turn, "--json")
    assert drawn.result()["frames"] == 2


def test_the_gradient_is_drawn(
    photograd: Photograd, model: Path, capture_folder: Path, tmp_path: Path
) -> None:
    done = photograd("gradients", model, capture_folder, "--out", tmp_path, "--json").result()
    assert done["steps"] == [0, 6, 60]
    for name in ("gaussian_gradients", "curves"):
        picture = read_image(Path(done[name]))
        assert picture[..., :3].std() > 0.05


def test_a_fit_goes_on_with_its_own_options(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    first = photograd("fit", capture_folder, "--out", tmp_path, *FIT, "--steps", 20)
    assert first.code == 0
    again = photograd("fit", capture_folder, "--out", tmp_path, "--resume", "--gaussians", 77)
    assert again.code == 1
    assert "--gaussians: expected 300, which the checkpoint was started with" in again.err

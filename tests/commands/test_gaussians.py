"""A scene of Gaussians through every command that a model goes through."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.capture.orbit import orbit_cameras
from photograd.commands.fit import exported
from photograd.fitting.evaluate import display_image
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model
from photograd.fitting.options import options_for
from photograd.images.read import read_image
from photograd.splats.frames import Presentation, half_turn
from photograd.splats.model import GaussianScene
from photograd.splats.orbit import orbit_splats
from photograd.splats.ply_files import read_gaussian_ply
from photograd.types import Array
from photograd_course.cli.entry import run
from PIL import Image

from tests.commands.conftest import Photograd
from tests.fit import scene

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
    assert done.result()["gaussians"] == str(tmp_path / GaussianScene.exported_as)
    start = "Gaussians: 300 random points in the silhouettes of all views"
    for words in (start, "Gaussians 300", "gaussians.ply: -y is up"):
        assert words in done.err
    gaussians = read_gaussian_ply(tmp_path / GaussianScene.exported_as)
    assert len(gaussians) == 300
    assert gaussians.degree == 3


CIRCLE = {"size": 48, "elevation": 10}


def frame(photograd: Photograd, model: Path, out: Path, *words: object) -> Array:
    """The first picture of an orbit, in 8 bits."""
    options = [word for name, value in CIRCLE.items() for word in (f"--{name}", value)]
    done = photograd("render", model, "--frames", 1, *options, "--out", out, *words)
    assert done.code == 0, done.err
    return np.asarray(Image.open(out), np.int64)


@pytest.fixture(scope="module")
def walled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A model of opaque photographs in front of a wall, whose color is learned, and its file."""
    out = tmp_path_factory.mktemp("walled")
    options = options_for("gaussians", steps=60, gaussians=300, degree=2, seed=1)
    job = Fit.start(scene.capture(wall=(0.2, 0.4, 0.7)), options)
    job.run(out)
    assert exported(job, out) == {"gaussians": str(out / GaussianScene.exported_as)}
    return out


def test_the_file_shows_what_the_model_shows(
    photograd: Photograd, walled: Path, tmp_path: Path
) -> None:
    shown = frame(photograd, walled, tmp_path / "model.png")
    from_file = frame(photograd, walled / GaussianScene.exported_as, tmp_path / "file.png")
    assert shown[0, 0, 2] > shown[0, 0, 0] + 30  # the wall, not white
    assert np.ptp(shown) > 100
    model = load_model(walled)
    (camera,) = orbit_cameras(model.field.box, 1, **CIRCLE)
    own = np.rint(255 * display_image(model, camera)).astype(np.int64)
    for picture in (shown, from_file):
        # Measured: no difference. A value between two levels may be rounded to either.
        assert np.abs(picture - own).max() <= 1
        assert (picture == own).mean() > 0.99
    turned = frame(
        photograd, walled / GaussianScene.exported_as, tmp_path / "turned.png", "--up", "+y"
    )
    assert np.abs(turned - own).max() > 50


@pytest.mark.parametrize(("name", "degree", "notes"), [("a.spz", 2, 2), ("a.splat", 0, 3)])
def test_other_formats_show_it_upright_and_name_what_they_drop(
    photograd: Photograd, walled: Path, tmp_path: Path, name: str, degree: int, notes: int
) -> None:
    done = photograd("convert", walled / GaussianScene.exported_as, tmp_path / name, "--json")
    dropped = [row["note"] for row in done.result()["notes"] if "dropped" in row["note"]]
    assert sum("background 0." in line for line in dropped) == 1
    assert len(dropped) == notes  # how it was antialiased; harmonics
    assert photograd("convert", tmp_path / name, tmp_path / "back.ply").code == 0
    g = half_turn(read_gaussian_ply(walled / GaussianScene.exported_as))
    kept = replace(g, sh=g.sh[:, : (degree + 1) ** 2])
    (expected,) = orbit_splats(kept, 1, presentation=Presentation("+y"), **CIRCLE)
    for file in (name, "back.ply"):
        picture = frame(photograd, tmp_path / file, tmp_path / "other.png")
        assert tuple(picture[0, 0]) == (255, 255, 255)
        # Measured: 2 at most. Upside down: 7 in the mean.
        assert np.abs(picture - 255 * expected).max() < 4
    assert np.abs(picture[::-1] - 255 * expected).mean() > 4


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
    drawn = photograd("render", model, "--frames", 2, "--size", 32, "--out", turn, "--json")
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

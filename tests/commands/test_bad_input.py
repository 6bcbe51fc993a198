"""Bad input through the command line: one line, a non-zero exit, no traceback, nothing lost."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.commands.conftest import Outcome, Photograd
from tests.fit import scene

FEW = ("--steps", "4", "--resolution", "8", "--rays", "64")


def assert_one_line(done: Outcome, *words: str) -> None:
    """An error in one line on stderr that says all of `words`; nothing on stdout."""
    assert done.code == 1
    assert done.out == ""
    assert "Traceback" not in done.err
    errors = [line for line in done.err.splitlines() if line.startswith("error: ")]
    assert len(errors) == 1
    assert done.err.splitlines()[-1] == errors[0]
    assert "expected" in errors[0]
    assert ", got " in errors[0]
    for word in words:
        assert word in errors[0]


def edit_transforms(folder: Path, change: Callable[[Any], None], split: str = "train") -> None:
    file = folder / f"transforms_{split}.json"
    content = json.loads(file.read_text())
    change(content)
    file.write_text(json.dumps(content))


def no_image(folder: Path) -> None:
    (folder / "train" / "train_3.png").unlink()


def half_an_image(folder: Path) -> None:
    file = folder / "train" / "train_3.png"
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def another_size(folder: Path) -> None:
    Image.fromarray(np.zeros((7, 9, 4), np.uint8)).save(folder / "train" / "train_3.png")


def matrix(place: tuple[int, int], value: float) -> Callable[[Path], None]:
    def change(content: Any) -> None:
        content["frames"][3]["transform_matrix"][place[0]][place[1]] = value

    return lambda folder: edit_transforms(folder, change)


def no_frames(folder: Path) -> None:
    for split in ("train", "test"):
        edit_transforms(folder, lambda content: content.update(frames=[]), split)


def far_box(folder: Path) -> None:
    box = [[90.0, 90.0, 90.0], [91.0, 91.0, 91.0]]
    for split in ("train", "test"):
        edit_transforms(folder, lambda content: content.update(aabb=box), split)


def turned_away(folder: Path) -> None:
    """About the vertical of the camera: columns of +X and +Z change their sign."""

    def change(content: Any) -> None:
        m = content["frames"][3]["transform_matrix"]
        for row in range(3):
            m[row][0], m[row][2] = -m[row][0], -m[row][2]

    edit_transforms(folder, change)


def no_json(folder: Path) -> None:
    file = folder / "transforms_train.json"
    file.write_text(file.read_text()[:100])


def all_gone(folder: Path) -> None:
    shutil.rmtree(folder)


CAPTURES: dict[str, tuple[Callable[[Path], None], tuple[str, ...]]] = {
    "missing image": (no_image, ("train_3",)),
    "truncated image": (half_an_image, ("train_3.png",)),
    "image of another size": (another_size, ("train_3", "9")),
    "pose with NaN": (matrix((0, 3), math.nan), ("frames[3]", "got nan")),
    "pose that is not rigid": (matrix((0, 0), 5.0), ("train_3",)),
    "empty capture": (no_frames, ("transforms_train.json",)),
    "box that no camera sees": (far_box, ("16 of 16", "train/train_0")),
    "camera that does not see the box": (turned_away, ("1 of 12", "train/train_3")),
    "broken JSON": (no_json, ("transforms_train.json",)),
    "no folder": (all_gone, ("no such folder",)),
}


@pytest.mark.parametrize("name", CAPTURES)
def test_a_bad_capture(
    photograd: Photograd, capture_folder: Path, tmp_path: Path, name: str
) -> None:
    spoil, words = CAPTURES[name]
    folder = shutil.copytree(capture_folder, tmp_path / "capture")
    spoil(folder)
    done = photograd("fit", folder, "--out", tmp_path / "model", *FEW)
    assert_one_line(done, *words)
    assert not (tmp_path / "model" / "model.npz").exists()
    with_trace = photograd("fit", folder, "--out", tmp_path / "model", *FEW, "--debug")
    assert with_trace.code == 1
    assert "Traceback (most recent call last)" in with_trace.err


def test_blind_cameras_may_be_allowed(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    folder = shutil.copytree(capture_folder, tmp_path / "capture")
    turned_away(folder)
    words = ("fit", folder, "--out", tmp_path / "model", *FEW)
    assert photograd(*words, "--allow-blind").code == 0


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("dense_gird", ("did you mean 'dense_grid'?",)),
        ("gaussian", ("did you mean 'gaussians'?",)),
        ("texture_2d", ("2D canvas", "'dense_grid'")),
        ("tiny_network", ("a capture can start",)),
    ],
)
def test_a_representation_that_cannot_be_fitted(
    photograd: Photograd, capture_folder: Path, tmp_path: Path, name: str, words: tuple[str, ...]
) -> None:
    done = photograd(
        "fit", capture_folder, "--out", tmp_path / "model", "--representation", name, *FEW
    )
    assert_one_line(done, name, *words)
    assert "toy_blobs" not in done.err  # only what a fit can start is listed
    assert done.err.count("\n") == 1  # said before the photographs are read
    assert not (tmp_path / "model").exists()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--background", "gray"), "background: expected one of"),
        (("--learning-rate", "-1"), "learning_rate: expected a finite number above 0, got -1.0"),
        (("--downscale", "100"), "100"),
    ],
)
def test_a_bad_option(
    photograd: Photograd, capture_folder: Path, tmp_path: Path, words: tuple[str, ...], says: str
) -> None:
    assert_one_line(photograd("fit", capture_folder, "--out", tmp_path / "m", *FEW, *words), says)


@pytest.mark.parametrize(
    "words",
    [("--steps", "0"), ("--resolution", "7"), ("--rays", "x"), ("--seed", "-1"), ("--stepz", "4")],
)
def test_words_that_the_parser_refuses(
    photograd: Photograd, capture_folder: Path, tmp_path: Path, words: tuple[str, ...]
) -> None:
    done = photograd("fit", capture_folder, "--out", tmp_path / "m", *words)
    assert done.code == 2
    assert "see photograd fit --help" in done.err
    assert "Traceback" not in done.err


def test_a_fit_that_diverges(photograd: Photograd, capture_folder: Path, tmp_path: Path) -> None:
    # Steps this large overflow float32 at once; whether it shows at a snapshot, a checkpoint or the
    # next rendering, nothing that is not finite is written.
    for seconds in (0, 30):
        out = tmp_path / f"{seconds}"
        done = photograd(
            "fit",
            capture_folder,
            "--out",
            out,
            *FEW,
            "--learning-rate",
            "1e39",
            "--checkpoint-seconds",
            seconds,
        )
        assert_one_line(done, "finite values", "lower the learning rate")
        assert not (out / "model.npz").exists()
        assert [path.name for path in (out / "snapshots").iterdir()] == ["step_000000.npz"]


def test_a_model_is_not_overwritten(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    assert photograd("fit", capture_folder, "--out", tmp_path, *FEW).code == 0
    before = (tmp_path / "model.npz").read_bytes()
    done = photograd("fit", capture_folder, "--out", tmp_path, *FEW)
    assert_one_line(done, "--out", "--resume")
    assert (tmp_path / "model.npz").read_bytes() == before


def test_resuming_with_other_options(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    assert photograd("fit", capture_folder, "--out", tmp_path, *FEW).code == 0
    before = (tmp_path / "model.npz").read_bytes()
    for words, says in (
        (("--steps", 9), "--steps: expected 4, which the checkpoint was started with, got 9"),
        (("--seed", 3), "--seed: expected 0"),
        (("--learning-rate", 0.5), "--learning-rate: expected 1.0"),
    ):
        done = photograd("fit", capture_folder, "--out", tmp_path, "--resume", *words)
        assert_one_line(done, says, "leave it out with --resume")
    assert (tmp_path / "model.npz").read_bytes() == before
    # The same options again are no contradiction.
    assert photograd("fit", capture_folder, "--out", tmp_path, "--resume", *FEW).code == 0


def test_resuming_what_is_not_there(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    done = photograd("fit", capture_folder, "--out", tmp_path / "nothing", "--resume")
    assert_one_line(done, "expected a model", "run 'photograd fit' first")
    assert not (tmp_path / "nothing").exists()


def test_resuming_on_another_capture(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    assert photograd("fit", capture_folder, "--out", tmp_path / "model", *FEW).code == 0
    other = scene.write(tmp_path / "other", train=6)
    done = photograd("fit", other, "--out", tmp_path / "model", "--resume")
    assert_one_line(done, "Fit.resume: capture")
    done = photograd(
        "fit", capture_folder, "--downscale", 2, "--out", tmp_path / "model", "--resume"
    )
    assert_one_line(done, "Fit.resume: capture", "--downscale")


@pytest.mark.parametrize("command", ["render", "evaluate", "gradients", "info", "fit --resume"])
@pytest.mark.parametrize("damage", ["truncated", "text"])
def test_a_corrupt_checkpoint(
    photograd: Photograd,
    capture_folder: Path,
    model_folder: Path,
    tmp_path: Path,
    command: str,
    damage: str,
) -> None:
    content = (model_folder / "model.npz").read_bytes()
    broken = content[: len(content) // 2] if damage == "truncated" else b"no archive at all"
    model = tmp_path / "model"
    model.mkdir()
    (model / "model.npz").write_bytes(broken)
    words = {
        "render": ("render", model, "--out", tmp_path / "turn.gif"),
        "evaluate": ("evaluate", model, capture_folder),
        "gradients": ("gradients", model, capture_folder, "--out", tmp_path / "pictures"),
        "info": ("info", model),
        "fit --resume": ("fit", capture_folder, "--out", model, "--resume"),
    }[command]
    assert_one_line(photograd(*words), "model.npz", "a photograd checkpoint", "damaged")
    assert (model / "model.npz").read_bytes() == broken
    assert {path.name for path in tmp_path.iterdir()} == {"model"}


def test_nothing_is_held_out(photograd: Photograd, model_folder: Path, tmp_path: Path) -> None:
    alone = scene.write(tmp_path / "alone", train=1, test=0)
    done = photograd("evaluate", model_folder, alone)
    assert_one_line(done, "evaluate: CAPTURE: expected held-out views")


@pytest.mark.parametrize("command", ["render", "evaluate", "gradients"])
def test_a_place_that_cannot_be_written(
    photograd: Photograd, capture_folder: Path, model_folder: Path, tmp_path: Path, command: str
) -> None:
    (tmp_path / "file").write_text("in the way")
    out = tmp_path / "file" / "result.gif"
    words = {
        "render": ("render", model_folder, "--frames", 1, "--size", 16),
        "evaluate": ("evaluate", model_folder, capture_folder),
        "gradients": ("gradients", model_folder, capture_folder, "--rays", 100),
    }[command]
    done = photograd(*words, "--out", out)
    assert_one_line(done, "file")
    assert (tmp_path / "file").read_text() == "in the way"


def test_info_on_neither(photograd: Photograd, tmp_path: Path) -> None:
    assert_one_line(photograd("info", tmp_path), "load_capture")
    assert_one_line(photograd("info", tmp_path / "no.npz"), "load_checkpoint")

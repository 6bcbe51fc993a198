"""`photograd recover`: found values and pictures, going on, and mistakes that are named."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from photograd.images.write import write_exr
from PIL import Image

from tests.commands.conftest import Photograd
from tests.commands.test_trace import SCENE

WORDS = ("--parameter", "materials.gray.albedo=0.2", "--spp", 4, "--learning-rate", 0.3)


@pytest.fixture
def taken(photograd: Photograd, tmp_path: Path) -> tuple[Path, Path]:
    """A scene file and a picture of it."""
    scene, target = tmp_path / "s.toml", tmp_path / "s.exr"
    scene.write_text(SCENE, encoding="utf-8")
    assert photograd("trace", scene, "--spp", 64, "--out", target).code == 0
    return scene, target


def test_a_color_is_found_and_resumed(
    photograd: Photograd, taken: tuple[Path, Path], tmp_path: Path
) -> None:
    scene, target = taken
    out = tmp_path / "found"
    words = ("recover", scene, "--target", target, *WORDS, "--steps", 60, "--out", out)
    done = photograd(*words, "--camera-from", scene, "--json")
    assert done.code == 0, done.err
    found = json.loads((out / "found.json").read_text(encoding="utf-8"))
    np.testing.assert_allclose(found["found"]["materials.gray.albedo"], 0.5, atol=0.03)
    assert done.result()["step"] == 60
    for name in ("comparison.png", "curves.png"):
        assert np.ptp(np.asarray(Image.open(out / name))) > 100
    again = photograd(*words)
    assert again.code == 1
    assert "a folder without recovery.npz" in " ".join(again.err.split())
    more = photograd(*words, "--camera-from", scene, "--resume")
    assert more.code == 0, more.err
    assert "resumed at step 60 of 60" in more.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--parameter", "materials.grya.albedo"), "did you mean 'materials.gray.albedo'"),
        (("--parameter", "materials.gray.albedo=red"), "NAME=NUMBER"),
        (
            (*WORDS, "--camera-from", "none.toml", "--camera-from", "none.toml"),
            "one for each of 1 targets",
        ),
        ((*WORDS, "--loss", "hope"), "loss: expected"),
        ((*WORDS, "--resume"), "expected a recovery"),
    ],
)
def test_mistakes_are_named(
    photograd: Photograd,
    taken: tuple[Path, Path],
    tmp_path: Path,
    words: tuple[object, ...],
    said: str,
) -> None:
    scene, target = taken
    done = photograd("recover", scene, "--target", target, "--out", tmp_path / "x", *words)
    assert done.code in (1, 2)
    assert said in " ".join(done.err.split())


def test_what_has_an_incomplete_derivative_is_refused_before_any_tracing(
    photograd: Photograd, tmp_path: Path
) -> None:
    target, out = tmp_path / "black.exr", tmp_path / "found"
    write_exr(target, np.zeros((8, 8, 3), np.float32))
    unknown = ("--parameter", "materials.glass.eta=1.35", "--steps", 10**6)
    done = photograd("recover", "cornell-spheres", "--target", target, *unknown, "--out", out)
    assert done.code == 1
    said = " ".join(done.err.split())
    assert "it turns the refracted rays of smooth glass, and paths are held fixed" in said
    assert "(model rough_dielectric" in said
    assert not out.exists()


def test_photographs_of_8_bits_are_refused(photograd: Photograd, tmp_path: Path) -> None:
    done = photograd(
        "recover", "cornell-box", "--target", tmp_path / "a.png", *WORDS, "--out", tmp_path
    )
    assert done.code == 1
    assert "expected a linear .exr" in " ".join(done.err.split())

"""`photograd trace`: pictures, resumed sums, and mistakes that are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.data.exr import read_exr
from PIL import Image

from tests.commands.conftest import Photograd

SCENE = """\
[camera]
position = [0, 1, 4]
look_at = [0, 0.5, 0]
field_of_view = 40
size = [8, 6]
[environment]
radiance = 0.5
[materials.grey]
model = "lambert"
albedo = [0.5, 0.5, 0.5]
[[shapes]]
kind = "sphere"
center = [0, 0.5, 0]
radius = 0.5
material = "grey"
"""


def test_a_built_in_scene_becomes_pictures(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "c.exr"
    done = photograd("trace", "cornell-box", "--size", 16, "--spp", 24, "--out", out, "--json")
    assert done.code == 0, done.err
    assert done.result()["spp"] == 24
    assert float(done.result()["noise"].split()[0]) > 0
    image = read_exr(out)
    assert image.shape == (16, 16, 4)
    assert image[..., 0].max() > 5  # the lamp
    preview = np.asarray(Image.open(out.with_suffix(".png")))
    assert preview.shape == (16, 16, 3)
    assert preview.max() == 255


def test_a_resumed_picture_has_the_same_bits(photograd: Photograd, tmp_path: Path) -> None:
    scene = tmp_path / "s.toml"
    scene.write_text(SCENE, encoding="utf-8")
    whole, parts = tmp_path / "whole.exr", tmp_path / "parts.exr"
    assert photograd("trace", scene, "--spp", 32, "--out", whole).code == 0
    assert photograd("trace", scene, "--spp", 16, "--out", parts).code == 0
    again = photograd("trace", scene, "--spp", 32, "--out", parts, "--resume")
    assert again.code == 0, again.err
    assert "resumed at 16 of 32" in again.err
    np.testing.assert_array_equal(read_exr(whole), read_exr(parts))
    other = photograd("trace", scene, "--spp", 32, "--out", parts, "--resume", "--seed", 1)
    assert other.code == 1
    assert "seed differ" in " ".join(other.err.split())


@pytest.mark.parametrize("integrator", ["direct", "occlusion"])
def test_other_integrators(photograd: Photograd, tmp_path: Path, integrator: str) -> None:
    out = tmp_path / "c.png"
    words = ("--size", 8, "--spp", 16, "--integrator", integrator, "--out", out)
    assert photograd("trace", "cornell-box", *words).code == 0
    assert 0 < np.asarray(Image.open(out)).mean() < 255
    assert not out.with_suffix(".exr").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("nowhere",), "nowhere"),
        (("cornel-box",), "did you mean 'cornell-box'"),
        (("none.toml",), "expected a file, got none"),
        (("cornell-box", "--integrator", "magic"), "--integrator"),
        (("cornell-box", "--strategy", "hope"), "strategy"),
        (("cornell-box", "--out", "a.jpg"), ".exr or .png"),
        (("cornell-box", "--out", "none.exr", "--resume"), "interrupted rendering"),
    ],
)
def test_mistakes_are_named(
    photograd: Photograd, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...], said: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    done = photograd("trace", *words)
    assert done.code in (1, 2)
    assert said in " ".join(done.err.replace("│", " ").split())


def test_a_mistake_in_a_file_is_named_with_its_line(photograd: Photograd, tmp_path: Path) -> None:
    scene = tmp_path / "s.toml"
    scene.write_text(SCENE.replace("radius = 0.5", "radius = true"), encoding="utf-8")
    done = photograd("trace", scene, "--out", tmp_path / "x.exr")
    assert done.code != 0
    assert "line 14: shapes.0.radius" in " ".join(done.err.split())

"""`photograd trace`: pictures, resumed sums, and mistakes that are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.images.exr import read_exr
from photograd.images.read import read_image
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
[materials.gray]
model = "lambert"
albedo = [0.5, 0.5, 0.5]
[[shapes]]
kind = "sphere"
center = [0, 0.5, 0]
radius = 0.5
material = "gray"
"""


def test_a_built_in_scene_becomes_pictures(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "c.exr"
    done = photograd("trace", "cornell-box", "--size", 16, "--spp", 24, "--out", out, "--json")
    assert done.code == 0, done.err
    assert done.result()["spp"] == 24
    assert float(done.result()["noise"].split()[0]) > 0
    image = read_exr(out)
    assert image.shape == (16, 16, 4)
    assert image[..., 0].max() > 5  # the light
    preview = np.asarray(Image.open(out.with_suffix(".png")))
    assert preview.shape == (16, 16, 3)
    assert preview.max() == 255


@pytest.mark.parametrize(
    ("suffix", "relative"), [(".exr", 1e-7), (".pfm", 1e-7), (".hdr", 1 / 256)]
)
def test_radiance_of_ten_thousand_survives_to_the_end(
    photograd: Photograd, tmp_path: Path, suffix: str, relative: float
) -> None:
    scene, out = tmp_path / "s.toml", tmp_path / f"a{suffix}"
    bright = SCENE.replace('material = "gray"', 'material = "gray"\nemission = [10000, 1, 0.01]')
    bright = bright.replace("radiance = 0.5", "radiance = 0").replace(
        "radius = 0.5", "radius = 1.2"
    )
    scene.write_text(bright, encoding="utf-8")
    assert photograd("trace", scene, "--spp", 4, "--out", out).code == 0
    image = read_image(out)[..., :3]
    np.testing.assert_allclose(image[3, 4, 0], 1e4, rtol=relative)
    # The other channels are off by a step of the largest one where they share its exponent.
    np.testing.assert_allclose(image[3, 4], [1e4, 1, 0.01], rtol=relative, atol=relative * 1e4)
    assert (image[0, 0] == 0).all()
    assert (image <= 1e4 * (1 + relative)).all()
    preview = np.asarray(Image.open(out.with_suffix(".png")))
    assert tuple(preview[3, 4][:2]) == (255, 255)


def test_signed_pictures_have_no_place_in_rgbe(photograd: Photograd, tmp_path: Path) -> None:
    words = ("trace", "cornell-box", "--size", 4, "--derivative", "materials.red.albedo", "--spp")
    done = photograd(*words, 1, "--out", tmp_path / "a.hdr")
    assert done.code == 1
    assert "--out: expected a name that ends in .exr, .pfm or .png" in done.err
    done = photograd(*words, 1, "--out", tmp_path / "a.pfm")
    assert done.code == 0, done.err
    assert read_image(tmp_path / "a.pfm").shape == (4, 4, 4)


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
        (("cornell-box", "--out", "a.jpg"), ".exr, .hdr, .pfm or .png"),
        (("cornell-box", "--out", "none.exr", "--resume"), "interrupted rendering"),
    ],
)
def test_mistakes_are_named(
    photograd: Photograd,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...],
    said: str,
) -> None:
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


def test_one_sample_says_nothing_of_the_noise(photograd: Photograd, tmp_path: Path) -> None:
    words = ("trace", "cornell-box", "--size", 8, "--spp", 1, "--out", tmp_path / "a.png")
    done = photograd(*words)
    assert done.code == 0
    assert "nan" not in done.out + done.err
    assert "noise unknown" in done.err

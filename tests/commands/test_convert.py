"""Files of Gaussians: converted and looked at, from every format."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.splats.files import read_gaussians, write_gaussians
from photograd.splats.frames import Presentation
from photograd.splats.orbit import orbit_splats
from PIL import Image

from tests.commands.conftest import Photograd
from tests.splat import oracle


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    write_gaussians(tmp_path / "a.ply", oracle.cloud(60, 1).astype(np.float32))
    return tmp_path / "a.ply"


def test_a_conversion_says_what_it_changed(photograd: Photograd, scene: Path) -> None:
    done = photograd("convert", scene, scene.with_suffix(".splat"), "--json")
    assert done.code == 0, done.err
    result = done.result()
    assert (result["gaussians"], result["degree"], result["bytes_out"]) == (60, 0, 60 * 32)
    changes = {row["attribute"]: row for row in result["changes"]}
    assert changes["means"]["largest_change"] == 0
    for row in changes.values():
        assert row["largest_change"] <= row["format_allows"], row
    assert changes["rotation"]["largest_change"] > 0.5
    notes = [row["note"] for row in result["notes"]]
    assert "harmonics of degree 1 to 3 are dropped" in notes
    assert "scales and opacities stored after activation" in notes
    assert read_gaussians(scene.with_suffix(".splat")).gaussians.degree == 0


def test_what_was_clamped_counts_as_a_change(photograd: Photograd, scene: Path) -> None:
    g = read_gaussians(scene).gaussians
    g.log_scales[3, 1] = -17.5
    write_gaussians(scene, g)
    done = photograd("convert", scene, scene.with_suffix(".spz"), "--json")
    row = next(r for r in done.result()["changes"] if r["attribute"] == "log_scales")
    assert (row["largest_change"], row["clamped"]) == (7.5, 1)
    assert row["format_allows"] < 0.04


def test_an_axis_that_the_header_names_stays_up(photograd: Photograd, tmp_path: Path) -> None:
    g, told = oracle.cloud(60, 1).astype(np.float32), Presentation("+z", (0.0, 0.5, 1.0), True)
    write_gaussians(tmp_path / "a.ply", g, presentation=told)
    (expected,) = orbit_splats(g, 1, size=32, presentation=told)
    for name, rotated in (("b.ply", False), ("c.spz", True)):
        done = photograd("convert", tmp_path / "a.ply", tmp_path / name, "--json")
        notes = " ".join(row["note"] for row in done.result()["notes"])
        assert ("rotated from +z up to -y up" in notes) == rotated
        assert ("the background 0.000 0.500 1.000 (display values) is dropped" in notes) == rotated
        found = read_gaussians(tmp_path / name)
        assert (found.presentation == told) != rotated
        shown = replace(found.presentation, background=told.background)
        (picture,) = orbit_splats(found.gaussians, 1, size=32, presentation=shown)
        # Measured: 0 and, of the rounded one, 2/255.
        assert np.abs(picture - expected).max() < (4 / 255 if rotated else 1e-9)
    words = ("--frames", 1, "--size", 32, "--out", tmp_path / "a.png")
    assert photograd("render", tmp_path / "a.ply", *words).code == 0
    drawn = np.asarray(Image.open(tmp_path / "a.png"))
    assert drawn[0, 0].tolist() == [0, 128, 255]
    assert np.abs(drawn / 255 - expected).max() < 1e-6


def test_versions_and_frames_are_named(photograd: Photograd, scene: Path) -> None:
    for version in (2, 3, 4):
        target = scene.with_name(f"v{version}.spz")
        done = photograd("convert", scene, target, "--spz-version", version, "--json")
        assert done.code == 0, done.err
        notes = " ".join(row["note"] for row in done.result()["notes"])
        assert f"version {version}" in notes
        assert "half a turn about x" in notes
        assert "right-handed both" in notes
    back = photograd("convert", target, scene.with_name("back.ply"))
    assert back.code == 0
    assert "clamped" in back.out


def test_every_format_is_rendered(photograd: Photograd, scene: Path, shared_data: Path) -> None:
    pictures = {}
    for name in ("a.ply", "a.splat", "a.spz"):
        if name != "a.ply":
            assert photograd("convert", scene, scene.with_name(name)).code == 0
        out = scene.with_name(f"pictures of {name}".replace(".", " "))
        words = ("--frames", 1, "--size", 32, "--out", out)
        assert photograd("render", scene.with_name(name), *words).code == 0
        pictures[name] = np.asarray(Image.open(out / "frame_0000.png"), np.float64) / 255
    assert pictures["a.ply"].min() < 0.8
    # Of 1: without harmonics 0.063 at most; rounded, 0.012.
    assert np.abs(pictures["a.spz"] - pictures["a.ply"]).max() < 0.03
    assert 0.01 < np.abs(pictures["a.splat"] - pictures["a.ply"]).max() < 0.2
    garden = shared_data / "splats/test_garden.npz"
    out = scene.with_name("garden")
    words = ("--frames", 1, "--size", 24, "--up=+z", "--out", out)
    assert photograd("render", garden, *words).code == 0
    assert np.asarray(Image.open(out / "frame_0000.png")).min() < 150


def test_bad_conversions_end_in_one_line(photograd: Photograd, scene: Path) -> None:
    for words, says in [
        ((scene, scene), "another file than IN"),
        ((scene, scene.with_name("a.zip")), "a name that ends in one of"),
        ((scene.with_name("none.ply"), scene.with_name("b.spz")), "expected a file, got none"),
        ((scene, scene.with_name("b.ply"), "--spz-version", 2), "a file .spz to write"),
    ]:
        done = photograd("convert", *words)
        assert done.code == 1
        assert says in done.err
        assert done.err.count("\n") == 1
    assert photograd("convert", scene, scene.with_name("b.spz"), "--spz-version", 5).code == 2

"""`photograd recover` of heights: a lens from a scene file, its files, and mistakes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.images.read import read_radiance
from photograd.images.write import write_exr
from photograd.transport.mesh_files import read_model
from PIL import Image

from tests.caustics.test_transport_start import spots
from tests.commands.conftest import Photograd

SCENE = """
[camera]
size = [8, 8]
position = [0.5, 0.3, 0.6]
look_at = [0, 0.2, 0]
field_of_view = 40

[materials.clear]
model = "glass"
eta = 1.5
tint = [1, 1, 1]

[materials.wall]
model = "lambert"
albedo = [0.8, 0.8, 0.8]

[[shapes]]
kind = "box"
name = "lens"
center = [0, 0.35, 0]
size = [0.1, 0.02, 0.1]
material = "clear"

[[shapes]]
kind = "rectangle"
name = "table"
corner = [-0.05, 0, 0.05]
edge_u = [0.1, 0, 0]
edge_v = [0, 0, -0.1]
material = "wall"

[[lights]]
kind = "directional"
direction = [0, 1, 0]
irradiance = [1000, 1000, 1000]
"""
AMBIENT = 'kind = "ambient"\nradiance = 1\n[[lights]]\nkind = "directional"'
WORDS = ("--parameter", "shapes.lens.heights", "--receiver", "table", "--steps", 12)


@pytest.fixture
def given(tmp_path: Path) -> tuple[Path, Path]:
    """A scene file and a target of 32 x 32."""
    scene, target = tmp_path / "s.toml", tmp_path / "t.exr"
    scene.write_text(SCENE, encoding="utf-8")
    write_exr(target, np.repeat(spots()[..., None], 3, axis=2).astype(np.float32))
    return scene, target


def test_a_lens_is_found_printed_and_resumed(
    photograd: Photograd, given: tuple[Path, Path], tmp_path: Path
) -> None:
    scene, target = given
    out = tmp_path / "found"
    words = ("recover", scene, "--target", target, *WORDS, "--out", out)
    done = photograd(*words, "--json")
    assert done.code == 0, done.err
    found = json.loads((out / "found.json").read_text(encoding="utf-8"))
    assert found["correlation"] > 0.95
    assert found["emitted"] == pytest.approx(10.0)
    assert found["received"] == pytest.approx(found["emitted"] * 0.96**2, rel=0.01)
    assert done.result()["step"] == 12
    shape: Any = read_model(out / "lens.stl").shapes[0]
    heights = read_radiance(out / "heights.exr")
    assert heights.shape[:2] == (65, 65)
    depth = np.ptp(shape.vertices[:, 1])  # millimeters; light goes downwards
    assert depth == pytest.approx(20 + 1000 * float(heights.max()), abs=1e-2)
    assert np.ptp(np.asarray(Image.open(out / "comparison.png"))) > 100
    assert "a folder without caustic.npz" in " ".join(photograd(*words).err.split())
    more = photograd(*words, "--resume")
    assert more.code == 0, more.err
    assert "resumed at step 12 of 12" in more.err


@pytest.mark.parametrize(
    ("old", "new", "words", "said"),
    [
        ("", "", ("--receiver", "tabel"), "did you mean 'table'"),
        ("", "", ("--receiver", "lens"), "expected a rectangle"),
        ("", "", ("--start", "sphere"), "--start"),
        ("", "", ("--parameter", "materials.wall.albedo"), "heights of one shape"),
        ('model = "glass"', 'model = "thin_glass"', (), "expected model glass"),
        ("tint = [1, 1, 1]", "tint = [1, 0.5, 1]", (), "clear glass"),
        ("direction = [0, 1, 0]", "direction = [0, -1, 0]", (), "before the lens's front"),
        ('kind = "directional"', AMBIENT, (), "one light, directional or point"),
    ],
)
def test_mistakes_are_named(
    photograd: Photograd,
    given: tuple[Path, Path],
    tmp_path: Path,
    old: str,
    new: str,
    words: tuple[str, ...],
    said: str,
) -> None:
    scene, target = given
    scene.write_text(SCENE.replace(old, new) if old else SCENE, encoding="utf-8")
    out = tmp_path / "x"
    done = photograd("recover", scene, "--target", target, *WORDS, *words, "--out", out)
    assert done.code == 1
    assert said in " ".join(done.err.split())


def test_a_target_without_light(
    photograd: Photograd, given: tuple[Path, Path], tmp_path: Path
) -> None:
    scene, target = given
    write_exr(target, np.zeros((8, 8, 3), np.float32))
    done = photograd("recover", scene, "--target", target, *WORDS, "--out", tmp_path / "x")
    assert done.code == 1
    assert "a picture with light" in " ".join(done.err.split())
    alone = ("recover", scene, "--target", target, "--parameter", "shapes.lens.heights")
    assert "--receiver NAME" in " ".join(photograd(*alone, "--out", tmp_path / "y").err.split())

"""`photograd trace --derivative` and `--integrator photon`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.images.exr import read_exr
from PIL import Image

from tests.commands.conftest import Photograd

SMALL = ("--size", 8, "--spp", 16)


def test_a_derivative_has_signs(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "d.exr"
    words = ("--derivative", "materials.copper.roughness", "--out", out)
    done = photograd("trace", "cornell-spheres", *SMALL, *words, "--json")
    assert done.code == 0, done.err
    assert float(done.result()["noise"].split()[0]) > 0
    slope = read_exr(out)[..., :3]
    assert slope.min() < 0 < slope.max()
    colors = np.asarray(Image.open(out.with_suffix(".png"))).astype(int)
    strongest = np.unravel_index(np.argmax(np.abs(slope.sum(axis=2))), (8, 8))
    red, _, blue = colors[strongest]
    assert (red > blue) == (slope.sum(axis=2)[strongest] > 0)
    # The sums of a derivative are no picture's, and go on like those.
    more = photograd("trace", "cornell-spheres", "--size", 8, "--spp", 24, *words, "--resume")
    assert more.code == 0, more.err
    assert "resumed at 16 of 24" in more.err
    other = photograd("trace", "cornell-spheres", *SMALL, "--out", out, "--resume")
    assert other.code == 1
    assert "derivative differ" in " ".join(other.err.split())


def test_photons_make_a_picture(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "p.exr"
    words = ("--integrator", "photon", "--photons", 20_000, "--radius", 0.2, "--out", out)
    done = photograd("trace", "cornell-box", *SMALL, *words)
    assert done.code == 0, done.err
    assert read_exr(out)[..., :3].mean() > 0.05


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("--derivative", "materials.coper.roughness"), "materials.copper.roughness"),
        (("--derivative", "materials.glass.eta"), "(model rough_dielectric"),
        (("--derivative", "shapes.0.center"), "where things are has no derivative here"),
        (("--derivative", "emission.lamp", "--integrator", "occlusion"), "path or direct"),
        (("--integrator", "photon"), "--radius"),
        (("--integrator", "phton"), "photon"),
    ],
)
def test_mistakes_are_named(
    photograd: Photograd, tmp_path: Path, words: tuple[str, ...], text: str
) -> None:
    out = tmp_path / "x.exr"
    done = photograd("trace", "cornell-spheres", *SMALL, *words, "--out", out)
    assert done.code == 1
    assert text in " ".join(done.err.split())
    assert not out.exists()

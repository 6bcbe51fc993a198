"""`photograd bake-ao`: a texture, and mistakes that are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.images.exr import read_exr
from photograd.transport import bake_ambient_occlusion, builtin_scene, read_texture
from PIL import Image

from tests.commands.conftest import Photograd


def test_a_floor_becomes_a_texture(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "ao.exr"
    words = ("--shape", "floor", "--texels", 16, "--spp", 40, "--seed", 3, "--out", out, "--json")
    done = photograd("bake-ao", "cornell-box", *words)
    assert done.code == 0, done.err
    result = done.result()
    assert (result["spp"], result["covered"]) == (40, "100.0 %")
    assert result["bytes"] == out.stat().st_size
    expected = bake_ambient_occlusion(builtin_scene("cornell-box", 16), "floor", 16, spp=40, seed=3)
    found = read_exr(out)
    for channel in range(3):
        np.testing.assert_array_equal(found[..., channel], expected.values[..., 0])
    assert result["mean"] == pytest.approx(expected.values.mean(), abs=1e-4)
    assert found[..., 0].min() == 0  # under the boxes
    assert 0.3 < found[..., 0].max() < 0.9
    preview = np.asarray(Image.open(out.with_suffix(".png")))[..., 0]
    assert np.abs(preview / 255 - expected.values[..., 0]).max() < 0.003  # linear, as it is used
    again = read_texture(out.with_suffix(".png"), "linear")
    assert np.abs(again.values[..., :1] - expected.values).max() < 0.003


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "name one of them"),
        (("--shape", "flor"), "did you mean 'floor'"),
        (("--shape", "floor", "--radius", "0"), "above 0 m"),
        (("--shape", "floor", "--out", "ao.jpg"), ".exr, .hdr, .pfm or .png"),
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
    done = photograd("bake-ao", "cornell-box", "--texels", 2, "--spp", 1, *words)
    assert done.code in (1, 2)
    assert said in " ".join(done.err.replace("│", " ").split())
    assert not list(tmp_path.iterdir())

"""`photograd frame`: a picture, its buffers and the traced truth beside it, and mistakes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.frame.panels import PANELS
from photograd.images.exr import read_exr
from PIL import Image

from tests.commands.conftest import Photograd

FAST = ("--size", 24, "--shadow-size", 64, "--surface-points", 2, "--json")


def test_a_frame_its_buffers_and_the_truth(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "frame.exr"
    words = ("--show", "all", "--against", "path", "--spp", 16, "--tone-curve", "agx")
    done = photograd(
        "frame", "cornell-box", *FAST, *words, "--bloom", 0.2, "--supersampling", 2, "--out", out
    )
    assert done.code == 0, done.err
    result = done.result()
    assert result["triangles"] == 36
    assert {"shadows ms", "direct ms", "tone map ms"} <= result.keys()
    assert 0 < result["direct light rms"] < result["all light rms"] < 0.3
    radiance = read_exr(out)[..., :3]
    assert radiance.shape == (24, 24, 3)
    assert radiance.max() > 1  # what emits: nothing is clipped before the tone curve
    assert np.asarray(Image.open(out.with_suffix(".png"))).shape[:2] == (24, 24)
    for name in PANELS:
        sheet = np.asarray(Image.open(tmp_path / f"frame.{name}.png"))
        assert sheet.shape[0] in (24, 48, 64)  # pixels, samples, texels
    assert np.asarray(Image.open(tmp_path / "frame.graph.png")).std() > 10
    assert np.asarray(Image.open(tmp_path / "frame.against.png")).shape[:2] == (48, 72)


def test_forward_shading_makes_the_same_picture(photograd: Photograd, tmp_path: Path) -> None:
    pictures = []
    for shading in ("deferred", "forward"):
        out = tmp_path / f"{shading}.exr"
        done = photograd("frame", "cornell-box", *FAST, "--shading", shading, "--out", out)
        assert done.code == 0, done.err
        pictures.append(read_exr(out))
    np.testing.assert_allclose(pictures[0], pictures[1], atol=1e-5)


def test_fog_and_gathered_light_are_asked_for(photograd: Photograd, tmp_path: Path) -> None:
    pictures = []
    for words in ((), ("--gather", 2), ("--fog", 0.2, "--fog-color", "0,0,0")):
        out = tmp_path / f"{len(pictures)}.exr"
        done = photograd("frame", "cornell-box", *FAST, *words, "--out", out)
        assert done.code == 0, done.err
        pictures.append(read_exr(out)[..., :3])
    assert pictures[1].mean() > 1.02 * pictures[0].mean()  # walls light one another
    assert pictures[2].mean() < 0.9 * pictures[0].mean()


def test_what_is_not_drawn_changes_little(photograd: Photograd, tmp_path: Path) -> None:
    pictures = []
    for words in ((), ("--culling", "none"), ("--detail", 0.5), ("--dither", "--seed", 3)):
        out = tmp_path / f"{len(pictures)}.png"
        done = photograd("frame", "cornell-box", *FAST, *words, "--out", out)
        assert done.code == 0, done.err
        pictures.append(np.asarray(Image.open(out)).astype(int))
    np.testing.assert_array_equal(pictures[0], pictures[1])
    np.testing.assert_array_equal(pictures[0], pictures[2])  # nothing has enough triangles
    assert 0 < np.abs(pictures[0] - pictures[3]).max() <= 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--show", "gbufer"), "--show: expected all, graph, or one of visibility"),
        (("--against", "photons"), "--against: expected 'path'"),
        (("--tone-curve", "filmic"), "--tone-curve: expected one of reinhard, aces, agx"),
        (("--shading", "later"), "--shading: expected one of deferred, forward"),
        (("--sky-visibility", "rays"), "--sky-visibility: expected one of occlusion, horizon"),
        (("--transparency", "no"), "--transparency: expected one of peeled, sorted, weighted"),
        (("--fog-color", "red"), "--fog-color: expected three numbers R,G,B"),
        (("--out", "frame.jpg"), "frame.jpg"),
    ],
)
def test_mistakes_are_named(
    photograd: Photograd, tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    given = ("--out", tmp_path / "f.png") if words[0] != "--out" else ()
    done = photograd("frame", "cornell-box", *FAST, *given, *words)
    assert done.code in {1, 2}
    assert said in done.err


def test_what_it_leaves_out_is_said(photograd: Photograd, tmp_path: Path) -> None:
    done = photograd("frame", "cornell-spheres", *FAST, "--out", tmp_path / "f.png")
    assert done.code == 0, done.err
    assert "light passes through are left out" in done.err
    done = photograd("frame", "carved", *FAST, "--out", tmp_path / "g.png")
    assert done.code != 0
    assert "a signed distance function" in done.err

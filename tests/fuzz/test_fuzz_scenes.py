"""Damaged scene files: taken or refused with a typed error that names a line, nothing else."""

from __future__ import annotations

import os
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from photograd.errors import IoError, SceneError
from photograd.images.exr import encode_exr
from photograd.transport import Scene, read_scene
from PIL import Image
from tests.transport import test_light_files as lights
from tests.transport import test_media_files as media
from tests.transport import test_scene_meshes as meshes
from tests.transport import test_sdf_files as bodies
from tests.transport.gltf_samples import core, square
from tests.transport.test_scene_files import TEXT

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))
EXAMPLES_A_ROUND = 50
WORDS = (
    "nan",
    "-1",
    "1e308",
    "9" * 5000,
    "[]",
    "{}",
    "[[",
    "true",
    '"x"',
    "\n[camera]\n",
    "[" * 500,
    "é",
    "1979-05-27",
    "0",
    "=",
    '"""',
)

TEXTS = {
    "shapes": TEXT,
    "lights": lights.TEXT + lights.LIGHTS,
    "meshes and textures": meshes.TEXT,
    "media": 'world_medium = "smoke"\n' + TEXT + media.MEDIA,
    "bodies": bodies.TEXT,
}


def files_beside(folder: Path) -> None:
    """What those texts name."""
    (folder / "sky.exr").write_bytes(encode_exr(np.ones((4, 8, 3), np.float32), half=False))
    np.save(folder / "smoke.npy", np.linspace(0, 1, 24).reshape(2, 3, 4))
    pixels = np.full((2, 2, 3), 128, np.uint8)
    for name in ("paint", "bumps"):
        Image.fromarray(pixels).save(folder / f"{name}.png")
    (folder / "square.glb").write_bytes(square(**core(baseColorFactor=[1, 0, 0, 1])).bytes())


@st.composite
def damage(draw: st.DrawFn, text: str) -> bytes:
    """A number, a key or a piece of the scene replaced by something else, up to three times."""
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(text)))
        length = draw(st.sampled_from([0, 1, 2, 5, 30]))
        word = draw(st.sampled_from(WORDS) | st.text(max_size=4))
        text = text[:start] + word + text[start + length :]
    data = text.encode("utf-8", "surrogatepass")
    return data[: draw(st.integers(0, len(data)))] if draw(st.integers(0, 7)) == 0 else data


@pytest.mark.parametrize("case", TEXTS)
def test_damaged_scenes(tmp_path: Path, case: str) -> None:
    path = tmp_path / "scene.toml"
    files_beside(tmp_path)
    path.write_text(TEXTS[case], encoding="utf-8")
    assert isinstance(read_scene(path), Scene)  # undamaged it is a scene
    answers: set[str] = set()
    end = time.monotonic() + SECONDS / 2  # of five cases
    rounds = 0
    while time.monotonic() < end or rounds == 0:

        @seed(rounds)
        @settings(
            max_examples=EXAMPLES_A_ROUND,
            deadline=None,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(damage(TEXTS[case]))
        def survive(bad: bytes) -> None:
            path.write_bytes(bad)
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # dropped triangles
                    scene = read_scene(path)
            except (IoError, SceneError) as refusal:
                answers.add("refused" if "read_scene" in str(refusal) else f"{refusal}")
                return
            answers.add("taken")
            assert isinstance(scene, Scene)

        survive()
        rounds += 1
    # Whether damage can be harmless depends on how many examples there was time for.
    assert answers - {"taken"} == {"refused"}

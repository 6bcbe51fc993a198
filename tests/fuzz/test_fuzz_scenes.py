"""Damaged scene files: taken or refused with a typed error that names a line, nothing else."""

from __future__ import annotations

import os
import time
import warnings
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from photograd.errors import IoError, SceneError
from photograd.transport import Scene, read_scene
from tests.transport.test_scene_files import TEXT

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))
EXAMPLES_A_ROUND = 50
WORDS = (
    "nan", "-1", "1e308", "9" * 5000, "[]", "{}", "[[", "true", '"x"', "\n[camera]\n", "[" * 500,
    "é", "1979-05-27", "0", "=", '"""',
)  # fmt: skip


@st.composite
def damage(draw: st.DrawFn) -> bytes:
    """A number, a key or a piece of the scene replaced by something else, up to three times."""
    text = TEXT
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(text)))
        length = draw(st.sampled_from([0, 1, 2, 5, 30]))
        word = draw(st.sampled_from(WORDS) | st.text(max_size=4))
        text = text[:start] + word + text[start + length :]
    data = text.encode("utf-8", "surrogatepass")
    return data[: draw(st.integers(0, len(data)))] if draw(st.integers(0, 7)) == 0 else data


def test_damaged_scenes(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    answers: set[str] = set()
    end = time.monotonic() + SECONDS
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
        @given(damage())
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
    assert answers == {"refused", "taken"}

"""`photograd trace --set`: parameters of built-in scenes and of files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.commands.trace_settings import traced
from photograd.errors import RangeError, ShapeError
from photograd.images.exr import read_exr
from photograd.transport import builtin_scene

from tests.commands.conftest import Photograd
from tests.commands.test_trace import SCENE

pytestmark = pytest.mark.usefixtures("core")


def picture(photograd: Photograd, scene: object, out: Path, *words: object) -> np.ndarray:
    done = photograd("trace", scene, "--size", 8, "--spp", 8, "--out", out, *words)
    assert done.code == 0, done.err
    return read_exr(out)


def test_a_scene_file_with_another_color_is_the_file_that_says_so(
    photograd: Photograd, tmp_path: Path
) -> None:
    ours, theirs = tmp_path / "a.toml", tmp_path / "b.toml"
    ours.write_text(SCENE, encoding="utf-8")
    theirs.write_text(SCENE.replace("[0.5, 0.5, 0.5]", "[0.2, 0.3, 0.4]"), encoding="utf-8")
    changed = picture(
        photograd, ours, tmp_path / "a.exr", "--set", "materials.gray.albedo=0.2,0.3,0.4"
    )
    np.testing.assert_array_equal(changed, picture(photograd, theirs, tmp_path / "b.exr"))


def test_several_settings_of_a_built_in_scene(photograd: Photograd, tmp_path: Path) -> None:
    words = ["--set", "materials.red.albedo=0", "--set", "materials.green.albedo=0"]
    dark = picture(photograd, "cornell-box", tmp_path / "a.exr", *words)
    assert (
        dark[..., :3].sum() < picture(photograd, "cornell-box", tmp_path / "b.exr")[..., :3].sum()
    )


def test_sums_of_other_settings_are_not_resumed(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "a.exr"
    picture(photograd, "cornell-box", out)
    words = ["--resume", "--set", "materials.red.albedo=0.5"]
    done = photograd("trace", "cornell-box", "--size", 8, "--spp", 16, "--out", out, *words)
    assert done.code == 1


def test_media_can_be_set() -> None:
    scene = builtin_scene("wax", 8)
    names = [name for name in traced(scene, []).params if name.startswith("media.")]
    assert names
    tracer = traced(scene, [f"{names[0]}=0.25"])
    assert (tracer.params[names[0]] == 0.25).all()


@pytest.mark.parametrize(
    ("setting", "error", "text"),
    [
        ("materials.red.albdo=0.5", RangeError, "materials.red.albedo"),
        ("materials.red.albedo", RangeError, "NAME=NUMBER"),
        ("materials.red.albedo=red", RangeError, "NAME=NUMBER"),
        ("materials.red.albedo=nan", RangeError, "NAME=NUMBER"),
        ("materials.red.albedo=1,2", ShapeError, "1 or 3 numbers"),
        ("materials.red.albedo=2", RangeError, "albedo"),
    ],
)
def test_mistakes_are_named(setting: str, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        traced(builtin_scene("cornell-box", 8), [setting])


def test_a_parameter_is_set_once() -> None:
    with pytest.raises(RangeError, match="twice"):
        traced(builtin_scene("cornell-box", 8), ["materials.red.albedo=0"] * 2)

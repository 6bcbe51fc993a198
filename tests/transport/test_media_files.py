"""Media in scene files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.transport import PathTracer, builtin_scene, read_scene

from tests.transport.test_scene_files import TEXT

MEDIA = """
[media.milk]
sigma_t = [9, 10, 11]
albedo = 0.9
phase = "cornette_shanks"
g = 0.2

[media.ink]
sigma_a = [1, 2, 3]
sigma_s = 0

[media.smoke]
sigma_a = 2
sigma_s = [2, 4, 6]
density = "smoke.npy"
corner = [-1, 0, -2]
size = [2, 3, 4]
majorant = 2

[[shapes]]
kind = "sphere"
center = [0.5, 1.5, 0]
radius = 0.4
material = "boundary"
interior = "milk"
"""


def written(tmp_path: Path, text: str, *, world: str = 'world_medium = "smoke"\n') -> Path:
    np.save(tmp_path / "smoke.npy", np.linspace(0, 1, 24).reshape(2, 3, 4))
    path = tmp_path / "scene.toml"
    path.write_text(world + TEXT + text, encoding="utf-8")
    return path


def test_what_a_file_says_is_what_the_scene_has(tmp_path: Path) -> None:
    scene = read_scene(written(tmp_path, MEDIA))
    assert list(scene.media) == ["milk", "ink", "smoke"]
    assert scene.world == "smoke"
    assert scene.shapes[-1].interior == "milk"
    assert scene.shapes[-1].material == "boundary"
    milk, ink, smoke = scene.media.values()
    np.testing.assert_array_equal(milk.sigma_t, [9, 10, 11])
    assert (milk.phase, milk.values["g"]) == ("cornette_shanks", 0.2)
    assert ink.phase_name == ""
    np.testing.assert_array_equal(ink.sigma_t, [1, 2, 3])
    np.testing.assert_allclose(smoke.albedo, [1 / 2, 2 / 3, 3 / 4])
    assert smoke.density is not None
    assert smoke.density.values.shape == (2, 3, 4)
    assert smoke.density.majorant == 2
    corner = smoke.density.world_from_box @ [1, 1, 1, 1]
    np.testing.assert_array_equal(corner[:3], [1, 3, 2])
    assert PathTracer(scene).render(spp=4, seed=1).mean.mean() > 0.01


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("albedo = 0.9", "albedo = 1.9", "media.milk: Medium: albedo: expected finite numbers in"),
        ("albedo = 0.9", "albedo = 0.9\nh = 1", "media.milk.h: expected a key that is known"),
        ("sigma_t = [9, 10, 11]", "", "media.milk.sigma_t: expected a value"),
        ("sigma_t = [9, 10, 11]", "sigma_t = [-9, 10, 11]", "media.milk.*expected finite numbers"),
        ("cornette_shanks", "cornet", "media.milk.phase: expected one of"),
        ('interior = "milk"', 'interior = "mlik"', "interior: expected one of milk, ink"),
        ('"smoke.npy"', '"fog.npy"', "fog.npy: expected a file, got none"),
        ("size = [2, 3, 4]", "size = [2, 3, 0]", "a box with a volume"),
        ('material = "boundary"', 'material = "gray"', "expected a surface that lets light in"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, old: str, new: str, text: str) -> None:
    assert MEDIA.count(old) == 1
    with pytest.raises(SceneError, match=text):
        read_scene(written(tmp_path, MEDIA.replace(old, new)))


def test_a_world_that_does_not_exist(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="world_medium: expected one of milk, ink, smoke"):
        read_scene(written(tmp_path, MEDIA, world='world_medium = "fog"\n'))


def test_the_built_in_scene_has_all_kinds() -> None:
    scene = builtin_scene("wax", 12)
    wax, amber, smoke = scene.media.values()
    assert wax.phase_name
    assert not amber.phase_name
    assert smoke.density is not None
    mean = PathTracer(scene).render(spp=8, seed=1).mean
    assert mean.mean() > 0.1

"""Each built-in scene: reproducible, inside its box, closed, colorful, sensibly lit."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from photograd.scenes import DEFAULT_SCENE, SceneDescription, scene, scenes
from photograd.scenes.parts import BRIGHTEST, DARKEST
from photograd.scenes.surface import Surface
from photograd.scenes.terrain_clouds import cloud_layer
from photograd_course.errors import DtypeError, RangeError, SceneError

from tests.scenes.solids import open_edges, volume

NAMES = list(scenes())


@cache
def built(name: str, seed: int = 0) -> SceneDescription:
    return scene(name, seed=seed)


def surfaces(described: SceneDescription) -> list[Surface]:
    return [
        Surface(mesh.vertices.astype(np.float64), mesh.faces.astype(np.int64), np.zeros((1, 2)))
        for mesh in described.meshes
    ]


@pytest.mark.parametrize("name", NAMES)
def test_a_seed_decides_every_bit(name: str) -> None:
    first, again, other = built(name), scene(name, seed=0), built(name, 1)
    assert first.name == name
    changed = len(first.meshes) != len(other.meshes)
    for one, two in zip(first.meshes, again.meshes, strict=True):
        np.testing.assert_array_equal(one.vertices, two.vertices)
        np.testing.assert_array_equal(one.faces, two.faces)
        np.testing.assert_array_equal(one.albedo, two.albedo)
    for one, two in zip(first.meshes, other.meshes, strict=False):
        changed |= not np.array_equal(one.vertices, two.vertices)
        changed |= not np.array_equal(one.albedo, two.albedo)
    assert changed


@pytest.mark.parametrize("name", NAMES)
def test_scenes_fit_where_the_demo_looks(name: str) -> None:
    described = built(name)
    assert np.abs(described.bounds).max() <= 0.7
    boxes = np.array([mesh.box for mesh in described.meshes])
    size = boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)
    assert size.min() > 0.5
    assert sum(len(mesh.faces) for mesh in described.meshes) < 500_000


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", [0, 1])
def test_every_mesh_is_closed_and_turned_outwards(name: str, seed: int) -> None:
    """Only the land is two meshes: its top, and its sides with the bottom."""
    solids = surfaces(built(name, seed))
    if name == "terrain_clouds":
        assert open_edges(solids[:2]) == 0
        solids = solids[2:]
    for index, solid in enumerate(solids):
        assert open_edges([solid]) == 0, f"mesh {index}"
        assert volume(solid) > 0.0, f"mesh {index}"


@pytest.mark.parametrize("name", NAMES)
def test_scenes_are_colorful(name: str) -> None:
    albedos = [mesh.albedo.reshape(-1, 3).astype(np.float64) for mesh in built(name).meshes]
    for albedo in albedos:
        assert DARKEST - 1e-6 <= albedo.min() <= albedo.max() <= BRIGHTEST + 1e-6
    everything = np.concatenate([albedo[:: max(1, len(albedo) // 500)] for albedo in albedos])
    saturation = 1.0 - everything.min(axis=1) / everything.max(axis=1)
    assert np.median(saturation) > 0.3
    hues = everything.argmax(axis=1)
    # Red, green and blue each lead somewhere, in at least one sample of a hundred.
    assert np.bincount(hues, minlength=3).min() > 0.01 * len(hues)


@pytest.mark.parametrize("name", NAMES)
def test_white_in_the_sun_is_near_display_white(name: str) -> None:
    """A white surface facing the sun, open to half the sky: sun irradiance / pi and half a sky."""
    described = built(name)
    sun = described.sun
    assert sun.direction[1] > 0.3
    assert 0.02 < sun.angular_radius < 0.1
    direct = sun.radiance * np.sin(sun.angular_radius) ** 2
    ambient = 0.5 * (described.sky.zenith + described.sky.horizon)
    assert 0.7 < direct.max() < 0.9
    assert 1.0 < (direct + ambient).max() < 1.6
    assert direct[0] > direct[2], "a warm sun"
    assert described.sky.zenith[2] > described.sky.zenith[0], "a blue sky"


def test_only_the_terrain_has_clouds() -> None:
    assert [name for name in NAMES if built(name).density is not None] == ["terrain_clouds"]


def test_clouds_are_inside_the_bounds_and_above_the_land() -> None:
    described = built("terrain_clouds")
    low, high = described.bounds
    points = np.random.default_rng(0).uniform(low - 0.2, high + 0.2, (40_000, 3))
    assert described.density is not None
    sigma_t = described.density(points)
    assert sigma_t.shape == (40_000,)
    assert sigma_t.min() == 0.0
    assert sigma_t.max() > 30.0
    inside = np.all((points > low) & (points < high), axis=1)
    assert (sigma_t[~inside] == 0.0).all()
    assert (sigma_t[points[:, 1] < 0.2] == 0.0).all()
    layer = inside & (points[:, 1] > 0.25) & (points[:, 1] < 0.35)
    assert 0.1 < (sigma_t[layer] > 0.0).mean() < 0.8
    np.testing.assert_array_equal(sigma_t, described.density(points))


def test_clouds_are_continuous() -> None:
    box = np.array([[0.0, 0, 0], [1.0, 0.4, 1.0]])
    density = cloud_layer(box, seed=2)
    line = np.stack([np.linspace(-0.1, 1.1, 20_001)] + 2 * [np.full(20_001, 0.2)], axis=-1)
    sigma_t = density(line)
    assert sigma_t.max() > 10.0
    # Slope of the noise (some 4 per unit) / feature size 0.3 * factor 4 * sigma_t 60 * step 6e-5.
    assert np.abs(np.diff(sigma_t)).max() < 0.3


def test_the_registry() -> None:
    assert len(NAMES) >= 4
    assert NAMES[0] == DEFAULT_SCENE
    with pytest.raises(SceneError, match="did you mean 'toy_table'"):
        scene("toytable", seed=0)
    with pytest.raises(SceneError, match="choose from flat_walls, foliage, fur"):
        scene("zzz", seed=0)
    with pytest.raises(RangeError, match="seed"):
        scene(seed=-1)
    with pytest.raises(DtypeError, match="seed"):
        scene(seed=0.5)  # type: ignore[arg-type]

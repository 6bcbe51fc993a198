"""Occlusion maps: kept by glTF files, looked at by ambient light, and by nothing else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.lights.dfg import DfgTable
from photograd.lights.environment import DirectionMap
from photograd.lights.prefilter import PrefilteredLight, SpecularMap, shade
from photograd.transport import (
    Environment,
    Material,
    ModelFile,
    OcclusionMap,
    PathOptions,
    PathTracer,
    bake_ambient_occlusion,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box

from tests.transport.gltf_samples import square
from tests.transport.test_gltf_materials import PIXELS, only
from tests.transport.test_gltf_save import at_half, json_of, written
from tests.transport.test_mesh_files import read
from tests.transport.test_occlusion_map import facing_a_wall

pytestmark = pytest.mark.usefixtures("core")
SKY = 2.0


def even_sky() -> PrefilteredLight:
    """The tables of an even sky of radiance `SKY`, without reflections."""
    turn = np.eye(3)
    irradiance = DirectionMap(np.full((4, 8, 3), SKY * np.pi), turn)
    dark = SpecularMap((0.5, 1.0), (DirectionMap(np.zeros((4, 8, 3)), turn),) * 2)
    return PrefilteredLight(irradiance, dark, DfgTable(np.zeros((2, 2, 2))))


def test_a_file_keeps_its_map(tmp_path: Path) -> None:
    glb = square()
    glb.json["materials"][0]["occlusionTexture"] = {"index": glb.image(PIXELS), "strength": 0.5}
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    found = only(model).occlusion
    assert found is not None
    assert found.strength == 0.5
    np.testing.assert_allclose(found.values[..., 0], PIXELS[..., 0] / 255, atol=1e-7)
    glb.json["materials"][0]["occlusionTexture"]["strength"] = 3
    _, told = read(tmp_path, glb.bytes())
    assert "occlusionTexture: strength: 3.0 is taken as 1" in told[0]


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_it_is_written_and_read_again(tmp_path: Path, suffix: str) -> None:
    values = PIXELS[..., :1] / np.float32(255)
    map_ = OcclusionMap(values, 0.75, ("clamp", "mirror"))
    material = replace(at_half("gltf"), occlusion=map_)
    model = ModelFile((box("cube", [0, 0, 0], [1, 1, 1], "m"),), {"m": material})
    after, said = written(model, tmp_path / f"m{suffix}")
    assert said == []
    found = after.materials["m"].occlusion
    assert found is not None
    np.testing.assert_array_equal(found.values, values)
    assert (found.strength, found.wrap) == (0.75, ("clamp", "mirror"))
    if suffix == ".glb":
        assert json_of(tmp_path / "m.glb")["materials"][0]["occlusionTexture"]["strength"] == 0.75
    rough = replace(material, occlusion=OcclusionMap(np.full((2, 2, 1), 0.3)))
    _, said = written(replace(model, materials={"m": rough}), tmp_path / f"m{suffix}")
    assert "occlusion map: rounded to eight bits, by at most 0.00" in said[0]


def test_lookups() -> None:
    ramp = OcclusionMap(np.linspace(0, 1, 4)[None, :, None], 0.5, ("repeat", "clamp"))
    u = np.array([0.125, 0.375, 0.875, 1.125, -0.625])
    found = ramp.at(np.stack([u, np.zeros(5)], axis=1))
    np.testing.assert_allclose(found, 0.5 + 0.5 * np.array([0, 1 / 3, 1, 0, 1 / 3]), atol=1e-6)
    mirrored = replace(ramp, wrap=("mirror", "clamp"))
    both = np.array([[1.125, 0], [0.875, 0], [-0.125, 0], [0.125, 0]])
    np.testing.assert_allclose(mirrored.at(both[::2]), mirrored.at(both[1::2]), atol=1e-6)
    with pytest.raises(RangeError, match="OcclusionMap: strength: expected a finite number"):
        OcclusionMap(np.ones((1, 1, 1)), 2)
    with pytest.raises(RangeError, match="OcclusionMap: wrap"):
        OcclusionMap(np.ones((1, 1, 1)), wrap=("repeat", "around"))
    with pytest.raises(ShapeError, match="OcclusionMap"):
        OcclusionMap(np.ones((1, 1, 3)))
    with pytest.raises(DtypeError, match="OcclusionMap"):
        OcclusionMap(np.ones((1, 1, 1), int))


def test_ambient_light_under_a_baked_map_is_what_rays_find(tmp_path: Path) -> None:
    scene = replace(facing_a_wall(0.5), environment=Environment.constant(SKY))
    albedo = [0.8, 0.4, 0.2]
    baked = bake_ambient_occlusion(scene, "floor", 32, spp=4096, seed=6)
    # Through a file: eight bits a texel.
    floor = next(shape for shape in scene.shapes if shape.name == "floor")
    dull = replace(at_half("gltf"), occlusion=OcclusionMap(baked.values, 1.0, baked.wrap))
    model = ModelFile((replace(floor, material="m"),), {"m": dull})
    after, _ = written(model, tmp_path / "m.glb")
    found = after.materials["m"].occlusion
    assert found is not None
    # The strip: u along x from -0.5, v along z.
    scene = replace(
        scene, materials=scene.materials | {"gray": Material("lambert", {"albedo": albedo})}
    )
    up = np.array([[0.0, 1.0, 0.0]])
    for z in (0.2, 0.5, 0.8):
        camera = camera_at([0, 3, z + 0.01], [0, 0, z], 0.01, 1, 1)
        options = PathOptions(max_depth=2)
        rays = PathTracer(replace(scene, camera=camera)).render(
            spp=1 << 16, seed=7, options=options
        )
        occlusion = found.at(np.array([[0.5, z]]))
        shaded = shade(
            even_sky(), up, up, base_color=albedo, metalness=0.0, roughness=1.0, occlusion=occlusion
        )
        assert 0.5 < occlusion[0] < 0.99
        np.testing.assert_allclose(shaded[0], rays.mean[0, 0], rtol=0.01)


def test_paths_do_not_look_at_it() -> None:
    scene = replace(facing_a_wall(0.5), environment=Environment.constant(SKY))
    dark = replace(scene.materials["gray"], occlusion=OcclusionMap(np.zeros((1, 1, 1))))
    pictures = [
        PathTracer(s).render(spp=2, seed=1).mean
        for s in (scene, replace(scene, materials=scene.materials | {"gray": dark}))
    ]
    assert pictures[0].mean() > 0.1
    np.testing.assert_array_equal(*pictures)

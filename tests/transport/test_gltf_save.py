"""Scenes written as glTF and read again: nothing changes, or it is said."""

from __future__ import annotations

import json
import struct
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from photograd.errors import IoError, SceneError
from photograd.transport import (
    BOUNDARY,
    DensityGrid,
    Material,
    Medium,
    MeshShape,
    ModelFile,
    NormalMap,
    PathTracer,
    SphereShape,
    Texture,
    TextureUse,
    builtin_scene,
    default_scene,
    read_model,
    save_gltf,
)
from photograd.transport.material import MODELS
from photograd.transport.mesh_files.gltf_material_writer import WRITTEN
from photograd.transport.mesh_files.gltf_texture_writer import normals_as_bytes
from photograd.transport.shapes import box

from support.tree import ROOT
from tests.transport.gltf_models import models, same

pytestmark = pytest.mark.usefixtures("core")
DATA = ROOT.parent / "shared" / "data" / "meshes"
CONSERVING = {name for name in WRITTEN if name.endswith("_conserving")}
READ_AS_THEMSELVES = sorted(set(WRITTEN) - {"ggx_metal", "clearcoat"} - CONSERVING)
EXAMPLES = 5  # of each model and kind of file


def written(model: Any, path: Path) -> tuple[ModelFile, list[str]]:
    """What is read back, and what was said on writing."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        save_gltf(model, path)
        said = [str(warning.message) for warning in caught]
        return read_model(path), said


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
@pytest.mark.parametrize("model", READ_AS_THEMSELVES)
def test_what_is_written_is_read_again(tmp_path: Path, model: str, suffix: str) -> None:
    path = tmp_path / f"m{suffix}"

    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        database=None,
        derandomize=True,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(models(model))
    def check(before: ModelFile) -> None:
        after, said = written(before, path)
        assert said == []
        same(before, after)
        again, _ = written(after, path)
        same(after, again)

    check()


def json_of(path: Path) -> Any:
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


def square(material: Material, **more: Any) -> ModelFile:
    shape = replace(box("cube", [0, 0, 0], [1, 1, 1], "m"), **more)
    return ModelFile((shape,), {"m": material})


def at_half(model: str) -> Material:
    values: dict[str, Any] = {}
    for p in MODELS[model].parameters:
        values[p.name] = [0.5 * (p.lo + p.hi)] * p.size if p.size > 1 else 0.5 * (p.lo + p.hi)
    return Material(model, values)


def test_a_file_says_what_it_uses(tmp_path: Path) -> None:
    used = {}
    for model in sorted(WRITTEN):
        written(square(at_half(model), emission=[3.0, 2.0, 1.0]), tmp_path / "m.glb")
        root = json_of(tmp_path / "m.glb")
        named = [name.removeprefix("KHR_materials_") for name in root["extensionsUsed"]]
        used[model] = set(named) - {"emissive_strength"}
        assert "emissive_strength" in named
        positions = root["accessors"][0]
        assert positions["min"] == [-0.5] * 3
        assert positions["max"] == [0.5] * 3
    assert used["glass"] == {"transmission", "ior", "volume"}
    assert used["dispersive_glass"] == {"transmission", "ior", "volume", "dispersion"}
    assert used["lambert"] == {"specular"}
    assert set().union(*used.values()) == {
        "clearcoat",
        "sheen",
        "anisotropy",
        "iridescence",
        "transmission",
        "volume",
        "dispersion",
        "specular",
        "ior",
    }


def test_special_cases_of_other_models_are_named(tmp_path: Path) -> None:
    for material, words in (
        (
            Material(
                "gltf_specular",
                {**at_half("gltf_specular").values, "specular_factor": 0, "metalness": 0},
            ),
            "'gltf_specular' is read back as 'lambert'",
        ),
        (
            at_half("gltf_layered_conserving"),
            "'gltf_layered_conserving' is read back as 'gltf_layered'",
        ),
        (at_half("clearcoat"), "'clearcoat' is read back as 'gltf_layered'"),
        (at_half("ggx_metal"), "'ggx_metal' is read back as 'gltf'"),
        (Material("glass", {"eta": 1.5, "tint": [1, 1, 1]}), None),
        (
            Material("dispersive_glass", {"eta": 1.5, "tint": [1, 1, 1], "dispersion": 0.0}),
            "'dispersive_glass' is read back as 'glass'",
        ),
        (
            Material("gltf_sheen", {**at_half("gltf_sheen").values, "sheen_color_factor": [0] * 3}),
            "'gltf_sheen' is read back as 'gltf'",
        ),
        (Material("gltf", {**at_half("gltf").values, "alpha": 1.0}), "alpha: 1.0 is read back as"),
        (Material("glass", {"eta": 3.0, "tint": [1, 1, 1]}), "is read back as 2.5"),
    ):
        _, said = written(square(material), tmp_path / "m.glb")
        text = "\n".join(said)
        assert words is not None or not said, text
        assert words is None or f"m.glb: material 'm': {words}" in text or words in text


def test_rounding_is_named(tmp_path: Path) -> None:
    g = np.random.default_rng(3)
    uv = g.random((24, 2)).astype(np.float32)
    fine = Texture(g.random((2, 2, 3)))
    material = replace(at_half("gltf"), textures={"base_color": TextureUse("t")})
    cube = box("cube", [0, 0, 0], [1, 1, 1], "m")
    model = ModelFile((replace(cube, uv=uv[: len(cube.vertices)]),), {"m": material}, {"t": fine})
    _, said = written(model, tmp_path / "m.glb")
    assert len(said) == 1
    assert "material 'm': base_color: texture: rounded to eight bits, by at most 0.00" in said[0]
    eighths = {"t": Texture(np.full((2, 2, 3), 1.0), filter="mip")}
    _, said = written(replace(model, textures=eighths), tmp_path / "m.glb")
    assert said == []
    one_place = replace(cube, instances=(np.diag([2.0, 2.0, 2.0, 1.0]),))
    _, said = written(ModelFile((one_place,), {"m": at_half("gltf")}), tmp_path / "m.glb")
    assert [text.split(": ", 1)[1] for text in said] == [
        "shape 'cube': vertices changed",
        "shape 'cube': instances changed",
    ]


def test_a_film_keeps_its_least_thickness(tmp_path: Path) -> None:
    g = np.random.default_rng(4)
    cube = box("cube", [0, 0, 0], [1, 1, 1], "m")
    shape = replace(cube, uv=g.random((len(cube.vertices), 2)).astype(np.float32))
    material = replace(
        at_half("gltf_iridescence"), textures={"iridescence_thickness": TextureUse("t", 1)}
    )
    levels = g.integers(0, 256, (3, 3, 3)) / 255
    for least in (0.25, 0.1, 0.0):
        film = {"t": Texture(np.asarray(least + (1 - least) * levels, np.float32))}
        _, said = written(ModelFile((shape,), {"m": material}, film), tmp_path / "m.glb")
        assert said == []
        node = json_of(tmp_path / "m.glb")["materials"][0]["extensions"][
            "KHR_materials_iridescence"
        ]
        assert node["iridescenceThicknessMinimum"] == pytest.approx(500 * least, rel=1e-4)
    _, said = written(
        ModelFile((shape,), {"m": material}, {"t": Texture(g.random((3, 3, 3)))}),
        tmp_path / "m.glb",
    )
    assert "iridescence_thickness: texture: rounded to eight bits" in said[0]


def test_surroundings_and_unused_materials_are_named(tmp_path: Path) -> None:
    scene = builtin_scene("cornell-box", 16)
    scene = replace(scene, materials={**scene.materials, "spare": at_half("gltf")})
    model, said = written(scene, tmp_path / "m.glb")
    assert said == ["m.glb: material 'spare': no shape has it, left out"]
    assert [s.name for s in model.shapes] == [s.name for s in scene.shapes]
    # The file has the camera and the light, and the walls are as matt as before.
    read = default_scene(model, "box", 16)
    assert len(read.shapes) == len(scene.shapes)
    found, expected = (PathTracer(s).render(spp=2, seed=1).mean for s in (read, scene))
    assert expected.mean() > 0.1
    np.testing.assert_allclose(found, expected, rtol=1e-5)  # measured: the same bits


def test_what_gltf_cannot_say_is_refused_by_name(tmp_path: Path) -> None:
    cube = box("cube", [0, 0, 0], [1, 1, 1], "m")
    glass, hair = at_half("glass"), at_half("phong")
    fog = Medium(1.0, albedo=0.5)
    smoke = Medium(1.0, density=DensityGrid(np.ones((2, 2, 2))))
    ball = SphereShape("ball", np.zeros(3), 1.0, "m")
    for shapes, materials_, media, words in (
        ((ball,), {"m": glass}, {}, "shape 'ball' is no mesh"),
        ((cube,), {"m": hair}, {}, "material 'm' of the model 'phong'"),
        ((replace(cube, material=BOUNDARY, interior="f"),), {}, {"f": fog}, "is a boundary"),
        ((replace(cube, interior="f"),), {"m": glass}, {"f": fog}, "medium 'f' does more"),
        ((replace(cube, interior="f"),), {"m": glass}, {"f": smoke}, "medium 'f' does more"),
        (
            (replace(cube, interior="f"),),
            {"m": at_half("gltf")},
            {"f": Medium(1.0)},
            "shape 'cube' of 'gltf' has an interior",
        ),
    ):
        with pytest.raises(SceneError, match=f"save_gltf: model: .*{words}"):
            save_gltf(ModelFile(shapes, materials_, {}, media), tmp_path / "m.glb")  # type: ignore[arg-type]
    textured = replace(at_half("gltf_specular"), textures={"eta": TextureUse("t")})
    texture = {"t": Texture(np.ones((1, 1, 3)))}
    with pytest.raises(SceneError, match="material 'm' with a texture of eta"):
        save_gltf(ModelFile((cube,), {"m": textured}, texture), tmp_path / "m.glb")
    two = {"a": Texture(np.ones((1, 1, 3))), "b": Texture(np.ones((2, 1, 3)))}
    uses = {"metalness": TextureUse("a"), "roughness": TextureUse("b")}
    with pytest.raises(
        SceneError, match="textures a, b: expected one size, wrap and filter for metallic"
    ):
        save_gltf(
            ModelFile((cube,), {"m": replace(at_half("gltf"), textures=uses)}, two),
            tmp_path / "m.glb",
        )
    with pytest.raises(IoError, match=r"save_gltf: path: expected a name that ends in .glb"):
        save_gltf(square(glass), tmp_path / "m.obj")
    assert list(tmp_path.iterdir()) == []


def test_normals_keep_their_scale() -> None:
    g = np.random.default_rng(5)
    image = g.integers(0, 256, (7, 5, 3)) / np.float32(255)
    for scale in (1.0, 0.37, 1.9):
        bent = NormalMap.from_image(np.asarray(image, np.float32), scale).values
        pixels, found = normals_as_bytes(bent)
        np.testing.assert_array_equal(pixels, np.rint(255 * image))
        assert found == np.float32(scale)
    rough = np.asarray(g.uniform(-1, 1, (7, 5, 3)), np.float32)
    pixels, found = normals_as_bytes(rough)
    assert np.abs(2.0 * pixels / 255 - 1 - rough).max() <= 1.001 / 255
    assert found == 1


@pytest.mark.parametrize(
    "name",
    [
        "ClearCoatTest",
        "SpecularTest",
        "AttenuationTest",
        "dispersion-test",
        "SunglassesKhronos",
        "low-poly-tree",
        "AnisotropyStrengthTest",
    ],
)
def test_sample_files(tmp_path: Path, name: str) -> None:
    path = DATA / "gltf" / f"{name}.glb"
    if not path.is_file():
        pytest.skip(f"no {path.name}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        before = read_model(path)
    after, said = written(before, tmp_path / "m.glb")
    assert said == []
    same(before, after)


def test_a_scene_around_a_model(tmp_path: Path) -> None:
    scene = default_scene(square(at_half("clearcoat")), "cube", 16)
    lamp = next(s for s in scene.shapes if isinstance(s, MeshShape) and s.emission.any())
    found, said = written(scene, tmp_path / "m.gltf")
    assert said[0] == "m.gltf: not written: environment"
    by_name = {shape.name: shape for shape in found.shapes}
    np.testing.assert_array_equal(by_name[lamp.name].emission, lamp.emission)

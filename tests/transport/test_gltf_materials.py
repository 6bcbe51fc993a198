"""Materials of glTF files: the model each becomes, and that nothing is dropped in silence."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.transport import Material, MeshShape, ModelFile
from photograd.transport.texture import TextureUse, decode

from tests.transport.gltf_samples import UV, core, extension, png, square
from tests.transport.test_mesh_files import read

PIXELS = np.array([[[255, 0, 0], [0, 128, 0]], [[0, 0, 64], [200, 100, 50]]], np.uint8)


VOLUME = {"thicknessFactor": 1}


def clear(factor: float = 1, **more: Any) -> dict[str, Any]:
    """A material with KHR_materials_transmission, and perhaps others."""
    return layers(transmission={"transmissionFactor": factor}, **more)


def layers(**entries: Any) -> dict[str, Any]:
    """A material with these extensions."""
    return {"extensions": {f"KHR_materials_{name}": entry for name, entry in entries.items()}}


def only(model: ModelFile) -> Material:
    (material,) = model.materials.values()
    return material


def made(folder: Path, **material: Any) -> tuple[Material, list[str]]:
    model, told = read(folder, square(**material).bytes())
    return only(model), told


@pytest.mark.parametrize(
    ("entries", "model", "values"),
    [
        ({}, "gltf", {"base_color": [1, 1, 1], "metalness": 1, "roughness": 1}),
        (
            core(baseColorFactor=[0.1, 0.2, 0.3, 1], metallicFactor=0.25, roughnessFactor=0.5),
            "gltf",
            {"base_color": [0.1, 0.2, 0.3], "metalness": 0.25, "roughness": 0.5},
        ),
        (
            extension("clearcoat", clearcoatFactor=0.75, clearcoatRoughnessFactor=0.25),
            "gltf_layered",
            {"coat": 0.75, "coat_roughness": 0.25, "metalness": 1},
        ),
        (
            extension("anisotropy", anisotropyStrength=0.5, anisotropyRotation=0.25),
            "ggx_anisotropic",
            {"f0": [1, 1, 1], "anisotropy": 0.5, "rotation": 0.25, "roughness": 1},
        ),
        (
            core(roughnessFactor=0.75)
            | extension("sheen", sheenColorFactor=[1, 0.5, 0], sheenRoughnessFactor=0.5),
            "gltf_sheen",
            {"sheen_color_factor": [1, 0.5, 0], "sheen_roughness_factor": 0.5, "roughness": 0.75},
        ),
        (extension("sheen"), "gltf", {"base_color": [1, 1, 1]}),
        (
            extension("iridescence", iridescenceFactor=0.5, iridescenceThicknessMaximum=550),
            "gltf_iridescence",
            {"iridescence_factor": 0.5, "iridescence_ior": 1.3, "iridescence_thickness": 550},
        ),
        (
            extension("specular", specularFactor=0.25, specularColorFactor=[1, 0.5, 0]),
            "gltf_specular",
            {"specular_factor": 0.25, "specular_color_factor": [1, 0.5, 0], "eta": 1.5},
        ),
        (
            core(baseColorFactor=[0.5, 0.25, 1, 1], metallicFactor=0)
            | extension("specular", specularFactor=0),
            "lambert",
            {"albedo": [0.5, 0.25, 1]},
        ),
        (extension("specular", specularFactor=0), "gltf_specular", {"specular_factor": 0}),
        (extension("ior", ior=1.25), "gltf_specular", {"eta": 1.25}),
        (
            core(roughnessFactor=0, metallicFactor=0) | clear(),
            "thin_glass",
            {"eta": 1.5, "tint": [1] * 3},
        ),
        (
            core(roughnessFactor=0.4, metallicFactor=0) | clear(volume=VOLUME, ior={"ior": 1.4}),
            "rough_dielectric",
            {"eta": 1.4, "roughness": 0.4},
        ),
        (
            core(roughnessFactor=0, metallicFactor=0, baseColorFactor=[0.5, 1, 1, 1])
            | clear(volume=VOLUME, ior={"ior": 2.0}),
            "glass",
            {"eta": 2.0, "tint": [0.5, 1, 1]},
        ),
        # A metal lets nothing through; so does a factor of 0.
        (clear(volume=VOLUME, dispersion={"dispersion": 1}), "gltf", {"metalness": 1}),
        (core(metallicFactor=0) | clear(0, volume=VOLUME), "gltf", {"metalness": 0}),
        (
            core(roughnessFactor=0.4, metallicFactor=0.25, baseColorFactor=[0.5, 1, 0.75, 1])
            | clear(0.75, ior={"ior": 1.25}),
            "gltf_transmission",
            {
                "transmission": 0.75,
                "eta": 1.25,
                "roughness": 0.4,
                "metalness": 0.25,
                "base_color": [0.5, 1, 0.75],
            },
        ),
        (
            core(roughnessFactor=0.4, metallicFactor=0, baseColorFactor=[0.5, 1, 0.75, 1])
            | clear(volume=VOLUME),
            "gltf_refraction",
            {"transmission": 1, "eta": 1.5, "roughness": 0.4, "base_color": [0.5, 1, 0.75]},
        ),
        # Crown glass has Abbe's number 59; a sheet spreads no colors.
        (
            core(roughnessFactor=0, metallicFactor=0)
            | clear(volume=VOLUME, dispersion={"dispersion": 20 / 59}),
            "dispersive_glass",
            {"eta": 1.5, "dispersion": 20 / 59, "tint": [1, 1, 1]},
        ),
        (
            core(roughnessFactor=0.25, metallicFactor=0)
            | clear(volume=VOLUME, dispersion={"dispersion": 1.5}),
            "dispersive_dielectric",
            {"eta": 1.5, "dispersion": 1.5, "roughness": 0.25},
        ),
        (
            core(roughnessFactor=0, metallicFactor=0) | clear(dispersion={"dispersion": 1}),
            "thin_glass",
            {"eta": 1.5},
        ),
    ],
)
def test_which_model_a_material_becomes(
    tmp_path: Path, entries: dict[str, Any], model: str, values: dict[str, Any]
) -> None:
    material, told = made(tmp_path, **entries)
    assert told == []
    assert material.model == model
    for name, value in values.items():
        np.testing.assert_allclose(material.values[name], value, rtol=1e-12, err_msg=name)


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        (extension("sheen", sheenColorFactor=[1, 1, 1]), "sheen_roughness_factor: 0.0 is taken as"),
        (
            layers(clearcoat={"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0}}),
            "KHR_materials_clearcoat: clearcoatNormalTexture: not supported",
        ),
        (extension("unlit"), "KHR_materials_unlit: not supported"),
        (extension("specular", specularColorFactor=[9, 0, 0]), "is taken as [2. 0. 0.]"),
        (
            core(metallicFactor=0, roughnessFactor=0)
            | clear(volume=VOLUME, clearcoat={"clearcoatFactor": 1}),
            "roughness 0 is drawn as 0.1: clear glass with other layers is a little frosted",
        ),
        (
            core(metallicFactor=0) | clear(0.5, volume=VOLUME, ior={"ior": 1.0}),
            "gltf_refraction.eta: 1.0 is taken as 1.2",
        ),
        (extension("ior", ior=8.0), "gltf_specular.eta: 8.0 is taken as 2.5"),
        (extension("ior", ior=0.0), "ior 0, which mirrors everything: taken as 2.5"),
        ({"alphaMode": "HASHED"}, "alphaMode HASHED: unknown, drawn opaque"),
        (
            core(baseColorFactor=[1, 1, 1, 0.5])
            | {"alphaMode": "BLEND", "emissiveFactor": [1] * 3},
            "alphaMode BLEND: what shines is drawn opaque",
        ),
    ],
)
def test_what_is_not_supported_is_named(
    tmp_path: Path, entries: dict[str, Any], words: str
) -> None:
    _, told = made(tmp_path, **entries)
    text = "\n".join(told)
    assert "m.glb: materials[0]" in text
    assert words in text, text


def test_light_of_surfaces(tmp_path: Path) -> None:
    bright = {"emissiveFactor": [1, 0.5, 0]} | extension("emissive_strength", emissiveStrength=8)
    model, told = read(tmp_path, square(**bright).bytes())
    assert told == []
    np.testing.assert_array_equal(model.shapes[0].emission, [8, 4, 0])
    glb = square()
    glb.json["materials"][0] |= {
        "emissiveFactor": [1, 1, 1],
        "emissiveTexture": {"index": glb.image(PIXELS)},
    }
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    shape = model.shapes[0]
    assert isinstance(shape, MeshShape)
    assert shape.emission_texture is not None
    np.testing.assert_array_equal(shape.emission, [1, 1, 1])
    painted = model.textures[shape.emission_texture.texture].values
    np.testing.assert_allclose(painted, decode(PIXELS / 255), rtol=1e-6)


def test_textures_scale_parameters(tmp_path: Path) -> None:
    glb = square()
    color, rough = glb.image(PIXELS), glb.image(PIXELS)
    glb.json["samplers"] = [{"wrapS": 33071, "wrapT": 33648}]
    glb.json["textures"][color]["sampler"] = 0
    glb.json["materials"][0] |= core(
        baseColorTexture={"index": color}, metallicRoughnessTexture={"index": rough}
    )
    glb.json["materials"][0]["normalTexture"] = {"index": rough, "scale": 0.5}
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    material = only(model)
    assert set(material.textures) == {"base_color", "metalness", "roughness"}
    painted = model.textures[material.textures["base_color"].texture]
    assert painted.wrap == ("clamp", "mirror")
    # IEC 61966-2-1: 128 is 0.2158605, 64 is 0.0512695; 0 and 255 are themselves.
    np.testing.assert_allclose(painted.values[0, 1], [0, 0.2158605, 0], atol=1e-6)
    np.testing.assert_allclose(painted.values[1, 0], [0, 0, 0.0512695], atol=1e-6)
    numbers = material.textures["roughness"]
    assert numbers == TextureUse(material.textures["metalness"].texture, 1)
    assert material.textures["metalness"].channel == 2
    np.testing.assert_allclose(model.textures[numbers.texture].values, PIXELS / 255, atol=1e-7)
    assert material.normal_map is not None
    tilt = (2.0 * PIXELS / 255 - 1) * [0.5, 0.5, 1]
    np.testing.assert_allclose(material.normal_map.values, tilt, atol=1e-6)


def test_textures_that_are_missing_or_damaged_are_left_out_by_name(tmp_path: Path) -> None:
    for image, words in (
        ({"uri": "gone.png"}, "images[0]: uri: "),
        ({"uri": "m.bin"}, "images[0]: expected a PNG or JPEG image"),
        ({"uri": "../up.png"}, "expected a file in"),
    ):
        glb = square()
        glb.json["images"], glb.json["textures"] = [image], [{"source": 0}]
        glb.json["materials"][0] |= core(baseColorTexture={"index": 0}, metallicFactor=0)
        (tmp_path / "m.bin").write_bytes(png(PIXELS)[:50])
        model, told = read(tmp_path, glb.bytes())
        assert only(model).textures == {}
        assert "m.glb: images[0]: left out" in told[0]
        assert words in told[0]
    (tmp_path / "o.mtl").write_text("newmtl a\nKd 0.5 0.25 0.125\nmap_Kd gone.png\n")
    text = "mtllib o.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n"
    model, told = read(tmp_path, text, "o.obj")
    assert "gone.png" in told[0]
    assert only(model).values["albedo"] == pytest.approx([0.5, 0.25, 0.125], abs=0.003)


def test_coordinates_are_moved_and_chosen(tmp_path: Path) -> None:
    glb = square()
    second = glb.accessor(UV * np.float32(0.5))
    glb.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = second
    turn = {"offset": [0.25, 0.5], "rotation": np.pi / 2, "scale": [2, 1]}
    glb.json["materials"][0] |= core(
        baseColorTexture={
            "index": glb.image(PIXELS),
            "texCoord": 1,
            "extensions": {"KHR_texture_transform": turn},
        }
    )
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    # (u, v) = (1/2, 1/2) is scaled to (1, 1/2); a quarter turn, v downwards, makes (1/2, -1) of it.
    found = model.shapes[0].uv
    np.testing.assert_allclose(found[1], [0.25 + 0.5, 0.5 - 1.0], atol=1e-6)
    np.testing.assert_allclose(found[3], [0.25, 0.5], atol=1e-6)


def test_extensions_of_a_file_are_named(tmp_path: Path) -> None:
    glb = square()
    lamp = {"type": "directional", "intensity": 2.0}
    glb.json["extensions"] = {
        "KHR_lights_punctual": {"lights": [lamp]},
        "KHR_materials_variants": {"variants": []},
    }
    glb.json["extensionsRequired"] = ["KHR_lights_punctual"]
    model, told = read(tmp_path, glb.bytes())
    assert told == ["m.glb: extensions: KHR_materials_variants: not supported, left out"]
    assert model.lights == ()  # no node has it

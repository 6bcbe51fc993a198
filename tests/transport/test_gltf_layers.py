"""glTF materials with several extensions: one model has all of them, and their textures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry
from photograd.transport import Environment, PathTracer, Scene, TextureUse
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box

from tests.transport.gltf_samples import core, square
from tests.transport.test_gltf_materials import PIXELS, VOLUME, clear, layers, made, only
from tests.transport.test_mesh_files import read

BRUSH = {"anisotropyStrength": 0.5, "anisotropyRotation": 0.25}
CLOTH = {"sheenColorFactor": [1, 0.5, 0], "sheenRoughnessFactor": 0.5}
FILM = {"iridescenceFactor": 0.5, "iridescenceThicknessMaximum": 550}
COAT = {"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25}
TINT = {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 2]}


@pytest.mark.parametrize(
    ("entries", "model", "values"),
    [
        (
            core(metallicFactor=0.5, roughnessFactor=0.25)
            | layers(
                specular=TINT,
                ior={"ior": 1.25},
                anisotropy=BRUSH,
                sheen=CLOTH,
                iridescence=FILM,
                clearcoat=COAT,
            ),
            "gltf_layered",
            {
                "metalness": 0.5,
                "roughness": 0.25,
                "eta": 1.25,
                "specular_factor": 0.5,
                "specular_color_factor": [1, 0.5, 2],
                "anisotropy": 0.5,
                "rotation": 0.25,
                "anisotropy_x": 1,
                "anisotropy_y": 0,
                "iridescence_factor": 0.5,
                "iridescence_ior": 1.3,
                "iridescence_thickness": 550,
                "sheen_color_factor": [1, 0.5, 0],
                "sheen_roughness_factor": 0.5,
                "coat": 0.75,
                "coat_roughness": 0.25,
                "transmission": 0,
            },
        ),
        (
            core(metallicFactor=0) | layers(anisotropy=BRUSH),
            "gltf_layered",
            {"anisotropy": 0.5, "metalness": 0, "coat": 0, "sheen_color_factor": [0, 0, 0]},
        ),
        (layers(clearcoat=COAT, sheen={"sheenRoughnessFactor": 1}), "gltf_layered", {"coat": 0.75}),
        (
            core(metallicFactor=0) | clear(0.5, specular=TINT, dispersion={"dispersion": 1}),
            "gltf_layered",
            {"transmission": 0.5, "specular_factor": 0.5},
        ),
        (
            core(metallicFactor=0, roughnessFactor=0.5)
            | clear(0.5, volume=VOLUME, dispersion={"dispersion": 1}),
            "gltf_layered_volume",
            {"transmission": 0.5, "dispersion": 1, "eta": 1.5},
        ),
        (
            core(metallicFactor=0, baseColorFactor=[1, 0, 0, 1])
            | clear(volume=VOLUME, dispersion={"dispersion": 1}),
            "gltf_layered_volume",
            {"base_color": [1, 0, 0], "dispersion": 1},
        ),
        (
            core(metallicFactor=0) | clear(volume=VOLUME, clearcoat=COAT, ior={"ior": 1.25}),
            "gltf_layered_volume",
            {"coat": 0.75, "eta": 1.25, "dispersion": 0},
        ),
    ],
)
def test_which_model_several_layers_become(
    tmp_path: Path, entries: dict[str, Any], model: str, values: dict[str, Any]
) -> None:
    material, told = made(tmp_path, **entries)
    assert told == []
    assert material.model == model
    for name, value in values.items():
        np.testing.assert_allclose(material.values[name], value, rtol=1e-12, err_msg=name)


def test_a_texture_of_directions(tmp_path: Path) -> None:
    glb = square()
    glb.json["materials"][0] |= layers(
        anisotropy=BRUSH | {"anisotropyTexture": {"index": glb.image(PIXELS)}}
    )
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    material = only(model)
    assert material.model == "gltf_layered"
    assert set(material.textures) == {"anisotropy", "anisotropy_x", "anisotropy_y"}
    name = material.textures["anisotropy"].texture
    assert material.textures["anisotropy"] == TextureUse(name, 2)
    texels = model.textures[name].values
    np.testing.assert_allclose(texels[..., :2], 2.0 * PIXELS[..., :2] / 255 - 1, atol=1e-6)
    np.testing.assert_allclose(texels[..., 2], PIXELS[..., 2] / 255, atol=1e-6)
    assert (material.values["anisotropy_x"], material.values["anisotropy_y"]) == (1, 1)
    # A texture that is missing leaves the tangent.
    glb.json["images"] = [{"uri": "gone.png"}]
    model, told = read(tmp_path, glb.bytes())
    assert "gone.png" in told[0]
    assert only(model).textures == {}
    assert (only(model).values["anisotropy_x"], only(model).values["anisotropy_y"]) == (1, 0)


def test_a_film_is_as_thick_as_its_texture_blends(tmp_path: Path) -> None:
    green = PIXELS[..., 1] / 255
    for least, most in ((100, 400), (0, 400), (400, 100)):
        glb = square()
        film = {
            "iridescenceFactor": 1,
            "iridescenceThicknessMinimum": least,
            "iridescenceThicknessMaximum": most,
            "iridescenceThicknessTexture": {"index": glb.image(PIXELS)},
        }
        glb.json["materials"][0] |= layers(iridescence=film)
        model, told = read(tmp_path, glb.bytes())
        assert told == []
        material = only(model)
        use = material.textures["iridescence_thickness"]
        found = model.textures[use.texture].values[..., use.channel]
        thickness = material.values["iridescence_thickness"] * found
        np.testing.assert_allclose(thickness, least + (most - least) * green, rtol=1e-5, atol=1e-4)


def test_textures_of_all_layers(tmp_path: Path) -> None:
    glb = square()
    pixels = np.concatenate([PIXELS, np.full((2, 2, 1), 100, np.uint8)], axis=2)
    image = {"index": glb.image(pixels)}
    glb.json["materials"][0] |= core(
        baseColorTexture=image, metallicRoughnessTexture=image
    ) | layers(
        specular=TINT | {"specularTexture": image, "specularColorTexture": image},
        sheen=CLOTH | {"sheenColorTexture": image, "sheenRoughnessTexture": image},
        iridescence=FILM | {"iridescenceTexture": image, "iridescenceThicknessTexture": image},
        clearcoat=COAT | {"clearcoatTexture": image, "clearcoatRoughnessTexture": image},
        transmission={"transmissionFactor": 0.5, "transmissionTexture": image},
    )
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    material = only(model)
    unpainted = {parameter.name for parameter in material.parameters} - set(material.textures)
    assert unpainted == {
        "eta",
        "anisotropy",
        "anisotropy_x",
        "anisotropy_y",
        "rotation",
        "iridescence_ior",
    }
    rough = material.textures["sheen_roughness_factor"]
    np.testing.assert_allclose(model.textures[rough.texture].values, 100 / 255, rtol=1e-6)


def test_several_layers_are_traced(tmp_path: Path) -> None:
    # In an even sky of radiance 1 each hit returns the directional albedo, and the sheet's rest.
    material, _ = made(
        tmp_path, **core(metallicFactor=0) | clear(0.5, clearcoat=COAT, sheen=CLOTH, specular=TINT)
    )
    camera = camera_at([0, 0, 5], [0, 0, 0], 0.01, 1, 1)
    shape = box("cube", [0, 0, 0], [4, 4, 1e-3], "m")
    scene = Scene("s", (shape,), {"m": material}, camera, Environment.constant(1.0))
    found = PathTracer(scene, dtype=np.float64).render(spp=4096, seed=1)
    model = registry()[material.model]
    wo = np.array([[0.0, 0.0, 1.0]])
    u = np.mod(0.5 + np.arange(20_000)[:, None] * [0.7548776662466927, 0.5698402909980532], 1.0)
    wi = model.sample(material.values, np.repeat(wo, len(u), 0), u)
    pdf = model.pdf(material.values, np.repeat(wo, len(u), 0), wi)[:, None]
    value = model.f(material.values, np.repeat(wo, len(u), 0), wi) * np.abs(wi[:, 2:])
    weights = np.where(pdf > 0, value / np.where(pdf > 0, pdf, 1), 0)
    up = wi[:, 2] > 0
    mirrored, passed = weights[up].sum(axis=0) / len(u), weights[~up].sum(axis=0) / len(u)
    error = found.standard_error[0, 0]
    # Two sheets: at least what the first returns, and what passes both straight on.
    assert (found.mean[0, 0] > mirrored - 4 * error).all()
    assert (found.mean[0, 0] < mirrored + passed + 4 * error).all()
    assert (passed > 0.05).all()

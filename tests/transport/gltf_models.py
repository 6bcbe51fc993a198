"""Models for the proofs of writing glTF: drawn at random, and compared to the last bit."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import strategies as st
from photograd.transport import Material, Medium, ModelFile, NormalMap, Texture, TextureUse
from photograd.transport.material import MODELS
from photograd.transport.mesh_files.gltf_material_writer import BODIES
from photograd.transport.mesh_files.gltf_texture_writer import SLOTS
from photograd.transport.shapes import box
from photograd.transport.texture import FILTERS, decode

LOGS = 1e-12
"""Relative: sigma_t is a logarithm, a rotation an angle of a complex number."""
UNPAINTED = ("rough_dielectric", "dispersive_dielectric", "ggx_anisotropic")
"""With a texture of roughness they are read back as another model."""


def same(a: Any, b: Any, place: str = "") -> None:
    """Equal to the last bit, all the way down; names of textures may differ."""
    if isinstance(a, ModelFile):
        assert len(a.shapes) == len(b.shapes)
        for one, other in zip(a.shapes, b.shapes, strict=True):
            same(replace_glow(one, a), replace_glow(other, b), one.name)
        assert list(a.materials) == list(b.materials)
        for name, material in a.materials.items():
            same(with_texels(material, a), with_texels(b.materials[name], b), name)
        assert list(a.media) == list(b.media)
        for name, medium in a.media.items():
            np.testing.assert_allclose(b.media[name].sigma_t, medium.sigma_t, rtol=LOGS)
            assert b.media[name].albedo is None
    elif isinstance(a, dict):
        assert a.keys() == b.keys(), place
        for key in a:
            same(a[key], b[key], f"{place}.{key}")
    elif hasattr(a, "__dataclass_fields__"):
        assert type(a) is type(b)
        for field in fields(a):
            same(getattr(a, field.name), getattr(b, field.name), f"{place}.{field.name}")
    elif isinstance(a, tuple | list) and a and not isinstance(a[0], float | int):
        assert len(a) == len(b)
        for k, pair in enumerate(zip(a, b, strict=True)):
            same(*pair, f"{place}[{k}]")
    elif place.endswith(".rotation"):
        assert b == pytest.approx(a, rel=LOGS, abs=LOGS)
    else:
        np.testing.assert_array_equal(a, b, err_msg=place)
        assert getattr(a, "dtype", None) == getattr(b, "dtype", None) or place.count(".values")


def replace_glow(shape: Any, model: ModelFile) -> Any:
    """The shape as a dictionary, with the texture in the place of its name."""
    found = {field.name: getattr(shape, field.name) for field in fields(shape)}
    if shape.emission_texture is not None:
        found["emission_texture"] = (
            model.textures[shape.emission_texture.texture],
            shape.emission_texture.channel,
        )
    return found


def with_texels(material: Material, model: ModelFile) -> Any:
    found = {field.name: getattr(material, field.name) for field in fields(material)}
    found["values"] = dict(material.values)
    found["textures"] = {
        name: (model.textures[use.texture], use.channel) for name, use in material.textures.items()
    }
    return found


def numbers(draw: st.DrawFn, lo: float, hi: float) -> float:
    """A float32 strictly between the ends: those may be another model."""
    lo, hi = lo + 0.01 * (hi - lo), hi - 0.01 * (hi - lo)
    return float(draw(st.floats(np.float32(lo), np.float32(hi), width=32)))


@st.composite
def materials(draw: st.DrawFn, model: str) -> Material:
    """A model somewhere in its range."""
    values: dict[str, Any] = {}
    for p in MODELS[model].parameters:
        found = [numbers(draw, p.lo, p.hi) for _ in range(p.size)]
        values[p.name] = found if p.size > 1 else found[0]
    if "anisotropy_x" in values:
        values |= {"anisotropy_x": 1.0, "anisotropy_y": 0.0}
    if model == "gltf" and draw(st.booleans()):
        values["alpha"] = numbers(draw, 0, 1)
        cutoff = draw(st.sampled_from([None, 0.75]))
        if cutoff is not None:
            values["alpha"] = min(values["alpha"], 0.5)
        return Material(model, values, alpha_cutoff=cutoff)
    return Material(model, values)


def bytes_of(draw: st.DrawFn, height: int, width: int, channels: int) -> Any:
    count = height * width * channels
    data = draw(st.binary(min_size=count, max_size=count))
    pixels = np.frombuffer(data, np.uint8).reshape(height, width, channels)
    return pixels / np.float32(255)  # as a file is read


def texels_of(draw: st.DrawFn, encoding: str, height: int, width: int) -> Any:
    """What is read of an image drawn at random; alpha of 1 everywhere is none."""
    texels = bytes_of(draw, height, width, 1 if encoding == "alpha" else 3)
    if encoding == "alpha":
        return np.minimum(texels, np.float32(128) / np.float32(255))
    if encoding == "direction":
        texels[..., :2] = 2 * texels[..., :2] - 1
    return decode(texels) if encoding == "srgb" else texels


def with_whole_images(material: Material, uses: dict[str, TextureUse]) -> Material:
    """One image holds all of these: what has one of them comes back with the others."""
    names = {p.name for p in material.parameters}
    for group in ({"metalness", "roughness"}, {"anisotropy", "anisotropy_x", "anisotropy_y"}):
        if not group & uses.keys():
            continue
        name = next(uses[p].texture for p in sorted(group) if p in uses)
        uses |= {p: TextureUse(name, SLOTS[p][3]) for p in group & names}
        if "anisotropy_y" in group & names:
            material = replace(material, values={**material.values, "anisotropy_y": 1.0})
    return material


@st.composite
def models(draw: st.DrawFn, model: str) -> ModelFile:
    """A cube, bent and in several instances, of a material with all textures that it may have."""
    material = draw(materials(model))
    height, width = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    wrap = draw(st.sampled_from([("repeat", "repeat"), ("clamp", "mirror")]))
    looked_up = draw(st.sampled_from(FILTERS))
    slots: dict[Any, str] = {}
    textures, uses = {}, {}
    for p in material.parameters:
        if p.name not in SLOTS or model in UNPAINTED or not draw(st.booleans()):
            continue
        extension, key, encoding, channel = SLOTS[p.name]
        name = slots.setdefault((extension, key, encoding), f"t {p.name}")
        uses[p.name] = TextureUse(name, 0 if encoding == "alpha" else channel)
        if name not in textures:
            texels = texels_of(draw, encoding, height, width)
            # One sampler serves color and mask, and masks have no mip maps.
            masked = material.alpha_cutoff is not None and p.name in ("alpha", "base_color")
            textures[name] = Texture(texels, wrap, "bilinear" if masked else looked_up)
    material = with_whole_images(material, uses)
    if "alpha" in uses and "base_color" not in uses:
        del uses["alpha"]
    bent = None
    if draw(st.booleans()):
        scale = draw(st.sampled_from([1.0, 0.5, 0.3, 2.0]))
        bent = NormalMap.from_image(bytes_of(draw, height, width, 3), scale, wrap)
    material = replace(material, textures=uses, normal_map=bent)
    shape = box("cube", [0, 0, 0], [1, 1, 1], "m")
    g = np.random.default_rng(draw(st.integers(0, 1000)))
    count = len(shape.vertices)
    emission = np.zeros(3)
    emission_texture = None
    if not material.has_opacity and draw(st.booleans()):
        emission = np.array([numbers(draw, 0, 40), numbers(draw, 0, 1), 0.0])
        textures["emission_texture"] = Texture(decode(bytes_of(draw, height, width, 3)), wrap)
        emission_texture = TextureUse("emission_texture") if draw(st.booleans()) else None
    instances = tuple(
        transform(np.diag(g.uniform(0.5, 2, 3)) @ turn(g), g.normal(size=(3, 1)))
        for _ in range(draw(st.sampled_from([0, 2, 3])))
    )
    interior = None
    thick = model in BODIES - {"dispersive_dielectric"}
    if thick and draw(st.booleans()):
        interior = "m"
    shape = replace(
        shape,
        emission=emission,
        emission_texture=emission_texture,
        instances=instances,
        interior=interior,
        vertices=shape.vertices + g.normal(size=3).astype(np.float32),
        normals=g.normal(size=(count, 3)).astype(np.float32),
        uv=g.normal(size=(count, 2)).astype(np.float32),
    )
    media = {"m": Medium(g.uniform(0, 9, 3))} if interior else {}
    asked = {use.texture for use in uses.values()} | (
        {"emission_texture"} if emission_texture else set()
    )
    return ModelFile((shape,), {"m": material}, {n: textures[n] for n in asked}, media)


def turn(g: Any) -> Any:
    """A rotation (3, 3)."""
    q = np.linalg.qr(g.normal(size=(3, 3)))[0]
    return q * np.sign(np.linalg.det(q))


def transform(linear: Any, offset: Any) -> Any:
    """The matrix (4, 4) of x -> linear @ x + offset."""
    return np.block([[linear, offset], [np.zeros((1, 3)), 1.0]])

"""Materials of a glTF file, by the reflectance models there are [Khronos2021, Khronos2022].

A rule looks at the extensions of a material and answers with a model that speaks for them, or with
nothing; the first that answers is taken. `layered` comes first: it has whatever takes more than one
layer. What no model can say is named in a note, never dropped in silence.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._json_node import JsonNode
from photograd.transport.material import Material
from photograd.transport.medium import Medium
from photograd.transport.mesh_files.container import real
from photograd.transport.mesh_files.gltf_clear import transmission
from photograd.transport.mesh_files.gltf_layered import (
    film_thickness,
    layered,
    rotation,
    sheen_color,
)
from photograd.transport.mesh_files.gltf_material_reader import (
    PLAIN_IOR,
    MaterialReader,
    make_material,
    metallic_roughness,
    usable_ior,
)
from photograd.transport.mesh_files.pictures import Coordinates, Pictures
from photograd.transport.texture import NormalMap, TextureUse


@dataclass(frozen=True, eq=False)
class FileMaterial:
    """A material, the light of surfaces that have it, and the coordinates of its textures.

    `emission_texture` scales the emission, or is None; `interior` is what fills bodies of it.
    """

    material: Material
    emission: Any
    coordinates: Coordinates
    emission_texture: TextureUse | None = None
    interior: Medium | None = None


def _anisotropy(reader: MaterialReader) -> Material | None:
    """Brushed metal, the same everywhere; `layered` has all others."""
    node = reader.extension("anisotropy")
    if node is None or real(node, "anisotropyStrength", 0.0) <= 0:
        return None
    reader.textured("f0", reader.core, "baseColorTexture", "srgb")
    values = {
        "f0": reader.base_color,
        "roughness": reader.roughness,
        "anisotropy": real(node, "anisotropyStrength", 0.0),
        "rotation": rotation(reader),
    }
    return make_material("ggx_anisotropic", values, reader)


def _sheen(reader: MaterialReader) -> Material | None:
    """Cloth over what is below."""
    node = reader.extension("sheen")
    if node is None:
        return None
    if not sheen_color(reader).any():
        return None
    reader.textured("sheen_color_factor", node, "sheenColorTexture", "srgb")
    reader.textured("sheen_roughness_factor", node, "sheenRoughnessTexture", "alpha")
    values = metallic_roughness(reader) | {
        "sheen_color_factor": sheen_color(reader),
        "sheen_roughness_factor": real(node, "sheenRoughnessFactor", 0.0),
    }
    return make_material("gltf_sheen", values, reader)


def _iridescence(reader: MaterialReader) -> Material | None:
    """A thin film."""
    node = reader.extension("iridescence")
    if node is None or real(node, "iridescenceFactor", 0.0) <= 0:
        return None
    reader.textured("iridescence_factor", node, "iridescenceTexture", "linear", 0)
    values = metallic_roughness(reader) | {
        "iridescence_factor": real(node, "iridescenceFactor", 0.0),
        "iridescence_ior": real(node, "iridescenceIor", 1.3),
        "iridescence_thickness": film_thickness(reader),
    }
    return make_material("gltf_iridescence", values, reader)


def _specular(reader: MaterialReader) -> Material | None:
    """Dielectrics of another index, or a weaker or colored reflection; without any, matt ones.

    The strength scales the reflection at all angles [Khronos2022]: at 0 light meets the base alone.
    """
    node, ior = reader.extension("specular"), reader.ior
    strength, color, has_texture = 1.0, np.ones(3), False
    if node is not None:
        strength = real(node, "specularFactor", 1.0)
        if "specularColorFactor" in node:
            color = node["specularColorFactor"].numbers((3,))
        has_texture = "specularTexture" in node or "specularColorTexture" in node
    if strength == 0 and reader.metalness == 0:
        reader.textured("albedo", reader.core, "baseColorTexture", "srgb")
        return make_material("lambert", {"albedo": reader.base_color}, reader)
    if ior == PLAIN_IOR and strength == 1 and (color == 1).all() and not has_texture:
        return None
    if node is not None:
        reader.textured("specular_factor", node, "specularTexture", "alpha")
        reader.textured("specular_color_factor", node, "specularColorTexture", "srgb")
    values = metallic_roughness(reader) | {
        "eta": usable_ior(reader),
        "specular_factor": strength,
        "specular_color_factor": color,
    }
    return make_material("gltf_specular", values, reader)


def _plain(reader: MaterialReader) -> Material:
    return make_material("gltf", metallic_roughness(reader), reader)


RULES = (layered, transmission, _anisotropy, _sheen, _iridescence, _specular, _plain)


def read_material(node: JsonNode, pictures: Pictures, note: Callable[[str], None]) -> FileMaterial:
    """A material of the file's array of them.

    Args:
        node: its object.
        pictures: of the file.
        note: called with sentences.

    Raises:
        IoError, RangeError: values of other kinds than glTF has.
    """
    core = JsonNode(node.function, node.where, {})
    if "pbrMetallicRoughness" in node:
        core = node["pbrMetallicRoughness"]
    reader = MaterialReader(node, core, note)
    material = next(found for rule in RULES if (found := rule(reader)) is not None)
    if "extensions" in node:
        for name, extension in node["extensions"].members():
            if name not in reader.handled:
                note(f"{extension.where}: not supported by the model '{material.model}', left out")
    material = _covering(reader, material)
    return _with_pictures(reader, material, pictures)


def _covering(reader: MaterialReader, material: Material) -> Material:
    """The material with its alpha, unless it covers everything; blending is done by chance."""
    node = reader.node
    mode = node["alphaMode"].text() if "alphaMode" in node else "OPAQUE"
    if mode == "OPAQUE":
        return material
    if mode not in ("MASK", "BLEND"):
        reader.note(f"{node.where}: alphaMode {mode[:20]}: unknown, drawn opaque")
        return material
    if _radiance(reader).any():
        reader.note(f"{node.where}: alphaMode {mode}: what shines is drawn opaque")
        return material
    encoding = "mask" if mode == "MASK" else "alpha"
    reader.textured("alpha", reader.core, "baseColorTexture", encoding)
    cutoff = max(real(node, "alphaCutoff", 0.5), 0.0) if mode == "MASK" else None
    values = {**material.values, "alpha": reader.alpha}
    return Material(material.model, values, alpha_cutoff=cutoff)


class _CommonCoordinates:
    """The coordinates that the textures of a material share: those of the first."""

    def __init__(self, reader: MaterialReader, pictures: Pictures) -> None:
        self.first: Coordinates | None = None
        self._note, self._pictures = reader.note, pictures

    def add(self, info: JsonNode) -> None:
        """Of a texture that is used."""
        coordinates = self._pictures.coordinates(info)
        self.first = self.first or coordinates
        if coordinates != self.first:
            self._note(f"{info.where}: other coordinates than the first texture's; those are used")


def _with_pictures(reader: MaterialReader, material: Material, pictures: Pictures) -> FileMaterial:
    """The material with its textures, which must share one set of coordinates."""
    node, uses, coordinates = reader.node, {}, _CommonCoordinates(reader, pictures)
    for parameter, (info, encoding, channel) in reader.texture_slots.items():
        name = pictures.texture(info, encoding)
        if name is not None:
            coordinates.add(info)
            uses[parameter] = TextureUse(name, channel)
    bent = occlusion = None
    if "normalTexture" in node:
        info = node["normalTexture"]
        found = pictures.normal_map(info)
        if found is not None:
            coordinates.add(info)
            bent = NormalMap.from_image(found[0], real(info, "scale", 1.0), found[1])
    values, cutoff, alpha = dict(material.values), material.alpha_cutoff, reader.alpha
    if "anisotropy_y" in values and "anisotropy_y" not in uses:
        values["anisotropy_y"] = 0.0  # its texture is missing: along the tangent
    if material.has_opacity and "alpha" not in uses and alpha >= (1 if cutoff is None else cutoff):
        del values["alpha"]  # it covers everything
        cutoff = None
    emission, emission_texture = _radiance(reader), None
    if "emissiveTexture" in node and emission.any():
        info = node["emissiveTexture"]
        name = pictures.emission_texture(info)
        if name is not None:
            emission_texture = TextureUse(name)
            coordinates.add(info)
    if "occlusionTexture" in node:
        info = node["occlusionTexture"]
        occlusion = pictures.occlusion(info)
        if occlusion is not None:
            coordinates.add(info)
    whole = Material(material.model, values, uses, bent, cutoff, occlusion)
    return FileMaterial(
        whole, emission, coordinates.first or Coordinates(), emission_texture, reader.interior
    )


def _radiance(reader: MaterialReader) -> Any:
    """(3,) without its texture."""
    node = reader.node
    if "emissiveFactor" not in node:
        return np.zeros(3)
    given = node["emissiveFactor"].numbers((3,))
    emission, strength = np.clip(given, 0, 1), reader.extension("emissive_strength")
    if not np.array_equal(emission, given):
        reader.note(f"{node.where}: emissiveFactor: {given} is taken as {emission}")
    if strength is not None:
        factor = real(strength, "emissiveStrength", 1.0)
        if factor < 0:
            reader.note(f"{strength.where}: emissiveStrength: {factor} is taken as 0")
        emission = emission * max(factor, 0.0)
    return emission

"""Materials of a glTF file, by the reflectance models there are [Khronos2021, Khronos2022].

A rule looks at the extensions of a material and answers with a model that speaks for them, or with
nothing; the first that answers is taken. What it did not read is named in a note, never dropped in
silence.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd.data.json_node import JsonNode
from photograd.transport.mesh_files.container import real
from photograd.transport.mesh_files.gltf_draft import PLAIN_IOR, Draft
from photograd.transport.mesh_files.pictures import Coordinates, Pictures
from photograd.transport.scene import MODELS, Material
from photograd.transport.texture import NormalMap, TextureUse


@dataclass(frozen=True, eq=False)
class FileMaterial:
    """A material, the light of surfaces that have it, and the coordinates of its textures."""

    material: Material
    emission: Any
    coordinates: Coordinates


def _transmission(draft: Draft) -> Material | None:
    """Bodies with a volume become glass, clear or frosted; surfaces without become a pane."""
    node = draft.extension("transmission")
    if node is None or real(node, "transmissionFactor", 0.0) < 0.5:
        return None
    if real(node, "transmissionFactor", 0.0) < 1:
        draft.note(f"{node.place}: transmissionFactor below 1 is taken as 1")
    draft.unread(node, "transmissionTexture")
    draft.take("transmission", "ior")
    volume = draft.extension("volume")
    thick = volume is not None and real(volume, "thicknessFactor", 0.0) > 0
    if volume is not None:
        draft.unread(volume, "attenuationDistance", "thicknessTexture")
        draft.take("volume")
    if thick and draft.roughness >= 0.1:
        if draft.base_color.min() < 1 or "baseColorTexture" in draft.core:
            draft.note(f"{draft.node.place}: rough_dielectric has no colour; left out")
        return _material(
            "rough_dielectric", {"eta": draft.ior, "roughness": draft.roughness}, draft
        )
    if not thick and draft.roughness >= 0.1:
        draft.note(f"{draft.node.place}: thin_glass is smooth; roughnessFactor left out")
    draft.textured("tint", draft.core, "baseColorTexture", "srgb")
    model = "glass" if thick else "thin_glass"
    return _material(model, {"eta": draft.ior, "tint": draft.base_color}, draft)


def _clearcoat(draft: Draft) -> Material | None:
    node = draft.extension("clearcoat")
    if node is None or real(node, "clearcoatFactor", 0.0) <= 0:
        return None
    draft.take("clearcoat")
    draft.unread(node, "clearcoatNormalTexture")
    draft.textured("coat", node, "clearcoatTexture", "linear", 0)
    draft.textured("coat_roughness", node, "clearcoatRoughnessTexture", "linear", 1)
    values = _metallic_roughness(draft) | {
        "coat": real(node, "clearcoatFactor", 0.0),
        "coat_roughness": real(node, "clearcoatRoughnessFactor", 0.0),
    }
    return _material("clearcoat", values, draft)


def _anisotropy(draft: Draft) -> Material | None:
    """Brushed metal; there is no model of a brushed dielectric."""
    node = draft.extension("anisotropy")
    if node is None or draft.metalness < 0.5 or real(node, "anisotropyStrength", 0.0) <= 0:
        return None
    draft.take("anisotropy")
    draft.unread(node, "anisotropyTexture")
    draft.textured("f0", draft.core, "baseColorTexture", "srgb")
    draft.textured("roughness", draft.core, "metallicRoughnessTexture", "linear", 1)
    values = {
        "f0": draft.base_color,
        "roughness": draft.roughness,
        "anisotropy": real(node, "anisotropyStrength", 0.0),
        "rotation": float(np.angle(np.exp(1j * real(node, "anisotropyRotation", 0.0)))),
    }
    return _material("ggx_anisotropic", values, draft)


def _sheen(draft: Draft) -> Material | None:
    """Cloth over what is below."""
    node = draft.extension("sheen")
    if node is None:
        return None
    draft.take("sheen")
    if "sheenColorFactor" not in node or not node["sheenColorFactor"].numbers((3,)).any():
        return None  # black sheen is none
    draft.unread(node, "sheenRoughnessTexture")
    draft.textured("sheen_color_factor", node, "sheenColorTexture", "srgb")
    values = _metallic_roughness(draft) | {
        "sheen_color_factor": node["sheenColorFactor"].numbers((3,)),
        "sheen_roughness_factor": real(node, "sheenRoughnessFactor", 0.0),
    }
    return _material("gltf_sheen", values, draft)


def _iridescence(draft: Draft) -> Material | None:
    """A thin film; a texture can scale its thickness if it starts at nothing."""
    node = draft.extension("iridescence")
    if node is None or real(node, "iridescenceFactor", 0.0) <= 0:
        return None
    draft.take("iridescence")
    draft.textured("iridescence_factor", node, "iridescenceTexture", "linear", 0)
    if real(node, "iridescenceThicknessMinimum", 100.0) == 0:
        key = "iridescenceThicknessTexture"
        draft.textured("iridescence_thickness", node, key, "linear", 1)
    else:
        draft.unread(node, "iridescenceThicknessTexture")
    values = _metallic_roughness(draft) | {
        "iridescence_factor": real(node, "iridescenceFactor", 0.0),
        "iridescence_ior": real(node, "iridescenceIor", 1.3),
        "iridescence_thickness": real(node, "iridescenceThicknessMaximum", 400.0),
    }
    return _material("gltf_iridescence", values, draft)


def _specular(draft: Draft) -> Material | None:
    """Dielectrics of another index, or a weaker reflection: f0 = 0.16 reflectance^2."""
    node, ior = draft.extension("specular"), draft.ior
    strength = 1.0 if node is None else real(node, "specularFactor", 1.0)
    if strength == 1 and ior == PLAIN_IOR:
        if node is not None and "specularColorFactor" not in node:
            draft.take("specular")
        draft.take("ior")
        return None
    if node is not None:
        draft.unread(node, "specularTexture", "specularColorTexture", "specularColorFactor")
    draft.take("specular", "ior")
    f0 = strength * ((ior - 1) / (ior + 1)) ** 2 if ior > 0 else strength
    values = _metallic_roughness(draft) | {"reflectance": float(np.sqrt(max(f0, 0) / 0.16))}
    return _material("standard", values, draft)


def _plain(draft: Draft) -> Material:
    return _material("gltf", _metallic_roughness(draft), draft)


RULES = (_transmission, _clearcoat, _anisotropy, _sheen, _iridescence, _specular, _plain)


def read_material(node: JsonNode, pictures: Pictures, note: Callable[[str], None]) -> FileMaterial:
    """A material of the file's array of them.

    Raises:
        IoError, RangeError: values of other kinds than glTF has.
    """
    core = JsonNode(node.function, node.place, {})
    if "pbrMetallicRoughness" in node:
        core = node["pbrMetallicRoughness"]
    draft = Draft(node, core, note)
    material = next(found for rule in RULES if (found := rule(draft)) is not None)
    if "extensions" in node:
        for name, extension in node["extensions"].members():
            if name not in draft.read:
                note(f"{extension.place}: not supported by the model '{material.model}', left out")
    if "alphaMode" in node and node["alphaMode"].text() != "OPAQUE":
        note(f"{node.place}: alphaMode {node['alphaMode'].text()[:20]}: drawn opaque")
    return _with_pictures(draft, material, pictures)


def _with_pictures(draft: Draft, material: Material, pictures: Pictures) -> FileMaterial:
    """The material with its textures, which must share one set of coordinates."""
    node, uses = draft.node, {}
    first: Coordinates | None = None
    for parameter, (info, encoding, channel) in draft.wanted.items():
        name = pictures.texture(info, encoding)
        if name is None:
            continue
        place = pictures.coordinates(info)
        first = first or place
        if place != first:
            draft.note(f"{info.place}: other coordinates than the first texture's; those are used")
        uses[parameter] = TextureUse(name, channel)
    bent = None
    if "normalTexture" in node:
        info = node["normalTexture"]
        found = pictures.normal_map(info)
        if found is not None:
            place = pictures.coordinates(info)
            first = first or place
            if place != first:
                draft.note(f"{info.place}: other coordinates than the first texture's")
            bent = NormalMap.from_image(found[0], real(info, "scale", 1.0), found[1])
    finished = Material(material.model, material.values, uses, bent)
    return FileMaterial(finished, _emission(draft, pictures), first or Coordinates())


def _emission(draft: Draft, pictures: Pictures) -> Any:
    """(3,) radiance; a texture of it counts with its mean colour."""
    node = draft.node
    if "emissiveFactor" not in node:
        return np.zeros(3)
    emission = np.clip(node["emissiveFactor"].numbers((3,)), 0, 1)
    strength = draft.extension("emissive_strength")
    if strength is not None:
        emission = emission * max(real(strength, "emissiveStrength", 1.0), 0.0)
    if "emissiveTexture" in node and emission.any():
        name = pictures.texture(node["emissiveTexture"], "srgb")
        if name is not None:
            draft.note(f"{node.place}: emissiveTexture: taken as its mean colour")
            emission = emission * pictures.textures[name].values.mean(axis=(0, 1))
    return emission


def _metallic_roughness(draft: Draft) -> dict[str, Any]:
    """The parameters of the core model, and their textures."""
    draft.textured("base_color", draft.core, "baseColorTexture", "srgb")
    draft.textured("metalness", draft.core, "metallicRoughnessTexture", "linear", 2)
    draft.textured("roughness", draft.core, "metallicRoughnessTexture", "linear", 1)
    return {
        "base_color": draft.base_color,
        "metalness": draft.metalness,
        "roughness": draft.roughness,
    }


def _material(model: str, values: dict[str, Any], draft: Draft) -> Material:
    """Values brought into the range of the model; what moves by more than rounding is noted."""
    inside = {}
    for parameter in MODELS[model].parameters:
        value = np.asarray(values[parameter.name], np.float64)
        inside[parameter.name] = np.clip(value, parameter.lo, parameter.hi)
        moved = float(np.abs(inside[parameter.name] - value).max())
        # A perfectly smooth lobe is drawn as the smoothest there is; nobody can see the difference.
        if moved > (0.15 if "roughness" in parameter.name else 1e-6):
            taken = inside[parameter.name]
            draft.note(f"{draft.node.place}: {model}.{parameter.name}: {value} is taken as {taken}")
    return Material(model, inside)

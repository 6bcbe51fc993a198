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
from photograd.transport.mesh_files.gltf_draft import (
    PLAIN_IOR,
    Draft,
    finished,
    metallic_roughness,
    usable_ior,
)
from photograd.transport.mesh_files.gltf_layered import (
    film_thickness,
    layered,
    rotation,
    sheen_color,
)
from photograd.transport.mesh_files.pictures import Coordinates, Pictures
from photograd.transport.texture import NormalMap, TextureUse


@dataclass(frozen=True, eq=False)
class FileMaterial:
    """A material, the light of surfaces that have it, and the coordinates of its textures.

    `glow` is the texture that scales the emission, or None; `interior` what fills bodies of it.
    """

    material: Material
    emission: Any
    coordinates: Coordinates
    glow: TextureUse | None = None
    interior: Medium | None = None


def _anisotropy(draft: Draft) -> Material | None:
    """Brushed metal, the same everywhere; `layered` has all others."""
    node = draft.extension("anisotropy")
    if node is None or real(node, "anisotropyStrength", 0.0) <= 0:
        return None
    draft.textured("f0", draft.core, "baseColorTexture", "srgb")
    values = {
        "f0": draft.base_color,
        "roughness": draft.roughness,
        "anisotropy": real(node, "anisotropyStrength", 0.0),
        "rotation": rotation(draft),
    }
    return finished("ggx_anisotropic", values, draft)


def _sheen(draft: Draft) -> Material | None:
    """Cloth over what is below."""
    node = draft.extension("sheen")
    if node is None:
        return None
    if not sheen_color(draft).any():
        return None
    draft.textured("sheen_color_factor", node, "sheenColorTexture", "srgb")
    draft.textured("sheen_roughness_factor", node, "sheenRoughnessTexture", "alpha")
    values = metallic_roughness(draft) | {
        "sheen_color_factor": sheen_color(draft),
        "sheen_roughness_factor": real(node, "sheenRoughnessFactor", 0.0),
    }
    return finished("gltf_sheen", values, draft)


def _iridescence(draft: Draft) -> Material | None:
    """A thin film."""
    node = draft.extension("iridescence")
    if node is None or real(node, "iridescenceFactor", 0.0) <= 0:
        return None
    draft.textured("iridescence_factor", node, "iridescenceTexture", "linear", 0)
    values = metallic_roughness(draft) | {
        "iridescence_factor": real(node, "iridescenceFactor", 0.0),
        "iridescence_ior": real(node, "iridescenceIor", 1.3),
        "iridescence_thickness": film_thickness(draft),
    }
    return finished("gltf_iridescence", values, draft)


def _specular(draft: Draft) -> Material | None:
    """Dielectrics of another index, or a weaker or coloured reflection; without any, matt ones.

    The strength scales the reflection at all angles [Khronos2022]: at 0 light meets the base alone.
    """
    node, ior = draft.extension("specular"), draft.ior
    strength, color, painted = 1.0, np.ones(3), False
    if node is not None:
        strength = real(node, "specularFactor", 1.0)
        if "specularColorFactor" in node:
            color = node["specularColorFactor"].numbers((3,))
        painted = "specularTexture" in node or "specularColorTexture" in node
    if strength == 0 and draft.metalness == 0:
        draft.textured("albedo", draft.core, "baseColorTexture", "srgb")
        return finished("lambert", {"albedo": draft.base_color}, draft)
    if ior == PLAIN_IOR and strength == 1 and (color == 1).all() and not painted:
        return None
    if node is not None:
        draft.textured("specular_factor", node, "specularTexture", "alpha")
        draft.textured("specular_color_factor", node, "specularColorTexture", "srgb")
    values = metallic_roughness(draft) | {
        "eta": usable_ior(draft),
        "specular_factor": strength,
        "specular_color_factor": color,
    }
    return finished("gltf_specular", values, draft)


def _plain(draft: Draft) -> Material:
    return finished("gltf", metallic_roughness(draft), draft)


RULES = (layered, transmission, _anisotropy, _sheen, _iridescence, _specular, _plain)


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
    material = _covering(draft, material)
    return _with_pictures(draft, material, pictures)


def _covering(draft: Draft, material: Material) -> Material:
    """The material with its alpha, unless it covers everything; blending is done by chance."""
    node = draft.node
    mode = node["alphaMode"].text() if "alphaMode" in node else "OPAQUE"
    if mode == "OPAQUE":
        return material
    if mode not in ("MASK", "BLEND"):
        draft.note(f"{node.place}: alphaMode {mode[:20]}: unknown, drawn opaque")
        return material
    if _radiance(draft).any():
        draft.note(f"{node.place}: alphaMode {mode}: what shines is drawn opaque")
        return material
    encoding = "mask" if mode == "MASK" else "alpha"
    draft.textured("alpha", draft.core, "baseColorTexture", encoding)
    cutoff = max(real(node, "alphaCutoff", 0.5), 0.0) if mode == "MASK" else None
    values = {**material.values, "alpha": draft.alpha}
    return Material(material.model, values, alpha_cutoff=cutoff)


class _Places:
    """The coordinates that the textures of a material share: those of the first."""

    def __init__(self, draft: Draft, pictures: Pictures) -> None:
        self.first: Coordinates | None = None
        self._note, self._pictures = draft.note, pictures

    def add(self, info: JsonNode) -> None:
        """Of a texture that is used."""
        place = self._pictures.coordinates(info)
        self.first = self.first or place
        if place != self.first:
            self._note(f"{info.place}: other coordinates than the first texture's; those are used")


def _with_pictures(draft: Draft, material: Material, pictures: Pictures) -> FileMaterial:
    """The material with its textures, which must share one set of coordinates."""
    node, uses, places = draft.node, {}, _Places(draft, pictures)
    for parameter, (info, encoding, channel) in draft.wanted.items():
        name = pictures.texture(info, encoding)
        if name is not None:
            places.add(info)
            uses[parameter] = TextureUse(name, channel)
    bent = occlusion = None
    if "normalTexture" in node:
        info = node["normalTexture"]
        found = pictures.normal_map(info)
        if found is not None:
            places.add(info)
            bent = NormalMap.from_image(found[0], real(info, "scale", 1.0), found[1])
    values, cutoff, alpha = dict(material.values), material.alpha_cutoff, draft.alpha
    if "anisotropy_y" in values and "anisotropy_y" not in uses:
        values["anisotropy_y"] = 0.0  # its texture is missing: along the tangent
    if material.sheer and "alpha" not in uses and alpha >= (1 if cutoff is None else cutoff):
        del values["alpha"]  # it covers everything
        cutoff = None
    emission, glow = _radiance(draft), None
    if "emissiveTexture" in node and emission.any():
        info = node["emissiveTexture"]
        name = pictures.glow(info)
        if name is not None:
            glow = TextureUse(name)
            places.add(info)
    if "occlusionTexture" in node:
        info = node["occlusionTexture"]
        occlusion = pictures.occlusion(info)
        if occlusion is not None:
            places.add(info)
    whole = Material(material.model, values, uses, bent, cutoff, occlusion)
    return FileMaterial(whole, emission, places.first or Coordinates(), glow, draft.interior)


def _radiance(draft: Draft) -> Any:
    """(3,) without its texture."""
    node = draft.node
    if "emissiveFactor" not in node:
        return np.zeros(3)
    given = node["emissiveFactor"].numbers((3,))
    emission, strength = np.clip(given, 0, 1), draft.extension("emissive_strength")
    if not np.array_equal(emission, given):
        draft.note(f"{node.place}: emissiveFactor: {given} is taken as {emission}")
    if strength is not None:
        factor = real(strength, "emissiveStrength", 1.0)
        if factor < 0:
            draft.note(f"{strength.place}: emissiveStrength: {factor} is taken as 0")
        emission = emission * max(factor, 0.0)
    return emission

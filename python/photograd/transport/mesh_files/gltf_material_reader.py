"""A glTF material while it is read: which of its extensions and textures have been handled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from photograd._json_node import JsonNode
from photograd.transport.material import MODELS, Material
from photograd.transport.medium import Medium
from photograd.transport.mesh_files.container import real

FOLLOWED = ("KHR_materials_emissive_strength",)
"""Extensions that no rule has to handle."""
PLAIN_IOR = 1.5
MAX_IOR = 2.5  # of the models: diamond has 2.42


@dataclass
class MaterialReader:
    """A material while it is being read.

    Attributes:
        node: of the file.
        core: its pbrMetallicRoughness.
        note: takes what could not be followed.
        handled: extensions that a rule has read.
        texture_slots: {parameter: (textureInfo, encoding, channel)}.
        interior: the absorption of a body, or None.
    """

    node: JsonNode
    core: JsonNode
    note: Callable[[str], None]
    handled: set[str] = field(default_factory=lambda: set(FOLLOWED))
    texture_slots: dict[str, tuple[JsonNode, str, int]] = field(default_factory=dict)
    interior: Medium | None = None

    def extension(self, name: str) -> JsonNode | None:
        """An extension of the material, if it has it.

        Args:
            name: of the extension.
        """
        key = f"KHR_materials_{name}"
        if "extensions" not in self.node or key not in self.node["extensions"]:
            return None
        return self.node["extensions"][key]

    def handle(self, *names: str) -> None:
        """Mark extensions as handled by the model.

        Args:
            names: of extensions.
        """
        self.handled.update(f"KHR_materials_{name}" for name in names)

    def textured(
        self, parameter: str, node: JsonNode, key: str, encoding: str, channel: int = 0
    ) -> None:
        """A parameter is scaled by a texture, if the file has one there.

        Args:
            parameter: of the model.
            node: the object that names the texture.
            key: of its member.
            encoding: of the texture, as of `Texture`.
            channel: of the image.
        """
        if key in node:
            self.texture_slots[parameter] = (node[key], encoding, channel)

    def note_unsupported(self, node: JsonNode, *keys: str) -> None:
        """Textures that no parameter of the model can take.

        Args:
            node: the object that names them.
            keys: of its members.
        """
        for key in keys:
            if key in node:
                self.note(f"{node.where}: {key}: not supported, left out")

    @property
    def base_color(self) -> Any:
        """(3,) linear; the fourth number of the file is its opacity."""
        if "baseColorFactor" not in self.core:
            return np.ones(3)
        return np.clip(self.core["baseColorFactor"].numbers((4,))[:3], 0, 1)

    @property
    def alpha(self) -> float:
        """0 to 1: the fourth number of the base color."""
        if "baseColorFactor" not in self.core:
            return 1.0
        return float(np.clip(self.core["baseColorFactor"].numbers((4,))[3], 0, 1))

    @property
    def metalness(self) -> float:
        """0 to 1."""
        return min(max(real(self.core, "metallicFactor", 1.0), 0.0), 1.0)

    @property
    def roughness(self) -> float:
        """As the file has it, unbounded."""
        return real(self.core, "roughnessFactor", 1.0)

    @property
    def ior(self) -> float:
        """Refractive index."""
        node = self.extension("ior")
        return PLAIN_IOR if node is None else real(node, "ior", PLAIN_IOR)


def usable_ior(reader: MaterialReader) -> float:
    """Refractive index; an ior of 0, which mirrors everything, is the largest one, and noted.

    Args:
        reader: of the material.
    """
    if reader.ior != 0:
        return reader.ior
    reader.note(f"{reader.node.where}: ior 0, which mirrors everything: taken as {MAX_IOR}")
    return MAX_IOR


def metallic_roughness(reader: MaterialReader) -> dict[str, Any]:
    """The parameters of the core model, and their textures.

    Args:
        reader: of the material.
    """
    reader.textured("base_color", reader.core, "baseColorTexture", "srgb")
    reader.textured("metalness", reader.core, "metallicRoughnessTexture", "linear", 2)
    reader.textured("roughness", reader.core, "metallicRoughnessTexture", "linear", 1)
    return {
        "base_color": reader.base_color,
        "metalness": reader.metalness,
        "roughness": reader.roughness,
    }


def make_material(model: str, values: dict[str, Any], reader: MaterialReader) -> Material:
    """Values brought into the range of the model; what moves by more than rounding is noted.

    Args:
        model: of reflectance.
        values: {parameter: value}.
        reader: of the material.
    """
    inside = {}
    for parameter in MODELS[model].parameters:
        value = np.asarray(values[parameter.name], np.float64)
        inside[parameter.name] = np.clip(value, parameter.lo, parameter.hi)
        moved = float(np.abs(inside[parameter.name] - value).max())
        # A perfectly smooth lobe is drawn as the smoothest there is; nobody can see the difference.
        if moved > (0.15 if "roughness" in parameter.name else 1e-6):
            taken = inside[parameter.name]
            reader.note(
                f"{reader.node.where}: {model}.{parameter.name}: {value} is taken as {taken}"
            )
    return Material(model, inside)

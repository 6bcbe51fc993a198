"""What lets light through, in glTF files: panes, glass and what is glass in part [Khronos2022]."""

from __future__ import annotations

import numpy as np

from photograd._json_node import JsonNode
from photograd.transport.material import Material
from photograd.transport.medium import Medium
from photograd.transport.mesh_files.container import real
from photograd.transport.mesh_files.gltf_material_reader import (
    MaterialReader,
    make_material,
    metallic_roughness,
)

MIN_ROUGHNESS = 0.1
"""Below this a clear surface is drawn as perfectly smooth."""
_DARKEST = 1e-4
"""In place of a color of 0, which no finite coefficient leaves."""


def transmission_factor(reader: MaterialReader) -> float:
    """0 to 1; 0 of metals, which let nothing through.

    Args:
        reader: of the material.
    """
    node = reader.extension("transmission")
    if node is None or (reader.metalness == 1 and "metallicRoughnessTexture" not in reader.core):
        return 0.0
    return min(max(real(node, "transmissionFactor", 0.0), 0.0), 1.0)


def is_thick(reader: MaterialReader) -> bool:
    """Whether the file gives the material a volume, so that it bends light.

    Args:
        reader: of the material.
    """
    volume = reader.extension("volume")
    return volume is not None and real(volume, "thicknessFactor", 0.0) > 0


def transmission(reader: MaterialReader) -> Material | None:
    """A sheet, or a body that bends light if the file gives it a volume.

    Perfectly clear ones have models of their own; all others, colored, frosted or opaque in part,
    become `gltf_transmission` or `gltf_refraction`. Metals let nothing through. `layered` has what
    has other layers as well.

    Args:
        reader: of the material.
    """
    node = reader.extension("transmission")
    if node is None:
        return None
    factor = transmission_factor(reader)
    if factor == 0:
        return None
    volume, thick = reader.extension("volume"), is_thick(reader)
    if thick and volume is not None:
        reader.note_unsupported(volume, "thicknessTexture")
        reader.interior = attenuation(reader, volume)
    whole = factor == 1 and "transmissionTexture" not in node
    if whole and reader.metalness == 0:
        clear = _clear(reader, thick)
        if clear is not None:
            return clear
    reader.textured("transmission", node, "transmissionTexture", "linear", 0)
    values = metallic_roughness(reader) | {"transmission": factor, "eta": reader.ior}
    return make_material("gltf_refraction" if thick else "gltf_transmission", values, reader)


def attenuation(reader: MaterialReader, volume: JsonNode) -> Medium | None:
    """Beer and Lambert's law by the color that white light has after a distance, meters.

    color = exp(-sigma_t distance); without a distance nothing is swallowed.

    Args:
        reader: of the material.
        volume: its volume extension.
    """
    if "attenuationDistance" not in volume or "attenuationColor" not in volume:
        return None
    distance = real(volume, "attenuationDistance", 1.0)
    if not distance > 0:
        reader.note(f"{volume.where}: attenuationDistance: {distance}, left out")
        return None
    color = np.clip(volume["attenuationColor"].numbers((3,)), _DARKEST, 1.0)
    return None if (color == 1).all() else Medium(-np.log(color) / distance)


def _clear(reader: MaterialReader, thick: bool) -> Material | None:
    """Glass and nothing else; frosted glass has a model here only if it is white."""
    roughened = "metallicRoughnessTexture" in reader.core
    smooth = reader.roughness < MIN_ROUGHNESS
    extension = reader.extension("dispersion")
    spread = real(extension, "dispersion", 0.0) if thick and extension is not None else 0.0
    values = {"eta": reader.ior}
    if spread > 0:
        values["dispersion"] = spread
    if smooth:
        reader.textured("tint", reader.core, "baseColorTexture", "srgb")
        model = ("dispersive_glass" if spread > 0 else "glass") if thick else "thin_glass"
        return make_material(model, values | {"tint": reader.base_color}, reader)
    white = bool(reader.base_color.min() == 1) and "baseColorTexture" not in reader.core
    if not thick or roughened or not white:
        return None
    model = "dispersive_dielectric" if spread > 0 else "rough_dielectric"
    return make_material(model, values | {"roughness": reader.roughness}, reader)

"""What lets light through, in glTF files: panes, glass and what is glass in part [Khronos2022]."""

from __future__ import annotations

import numpy as np

from photograd._json_node import JsonNode
from photograd.transport.material import Material
from photograd.transport.medium import Medium
from photograd.transport.mesh_files.container import real
from photograd.transport.mesh_files.gltf_draft import Draft, finished, metallic_roughness

LEAST_ROUGHNESS = 0.1
"""Below this a clear surface is drawn as perfectly smooth."""
_DARKEST = 1e-4
"""In place of a colour of 0, which no finite coefficient leaves."""


def transmission_factor(draft: Draft) -> float:
    """0 to 1; 0 of metals, which let nothing through."""
    node = draft.extension("transmission")
    if node is None or (draft.metalness == 1 and "metallicRoughnessTexture" not in draft.core):
        return 0.0
    return min(max(real(node, "transmissionFactor", 0.0), 0.0), 1.0)


def is_thick(draft: Draft) -> bool:
    """Whether the file gives the material a volume, so that it bends light."""
    volume = draft.extension("volume")
    return volume is not None and real(volume, "thicknessFactor", 0.0) > 0


def transmission(draft: Draft) -> Material | None:
    """A sheet, or a body that bends light if the file gives it a volume.

    Perfectly clear ones have models of their own; all others, coloured, frosted or opaque in part,
    become `gltf_transmission` or `gltf_refraction`. Metals let nothing through. `layered` has what
    has other layers as well.
    """
    node = draft.extension("transmission")
    if node is None:
        return None
    factor = transmission_factor(draft)
    if factor == 0:
        return None
    volume, thick = draft.extension("volume"), is_thick(draft)
    if thick and volume is not None:
        draft.unread(volume, "thicknessTexture")
        draft.interior = attenuation(draft, volume)
    whole = factor == 1 and "transmissionTexture" not in node
    if whole and draft.metalness == 0:
        clear = _clear(draft, thick)
        if clear is not None:
            return clear
    draft.textured("transmission", node, "transmissionTexture", "linear", 0)
    values = metallic_roughness(draft) | {"transmission": factor, "eta": draft.ior}
    return finished("gltf_refraction" if thick else "gltf_transmission", values, draft)


def attenuation(draft: Draft, volume: JsonNode) -> Medium | None:
    """Beer and Lambert's law by the colour that white light has after a distance, metres.

    color = exp(-sigma_t distance); without a distance nothing is swallowed.
    """
    if "attenuationDistance" not in volume or "attenuationColor" not in volume:
        return None
    distance = real(volume, "attenuationDistance", 1.0)
    if not distance > 0:
        draft.note(f"{volume.place}: attenuationDistance: {distance}, left out")
        return None
    color = np.clip(volume["attenuationColor"].numbers((3,)), _DARKEST, 1.0)
    return None if (color == 1).all() else Medium(-np.log(color) / distance)


def _clear(draft: Draft, thick: bool) -> Material | None:
    """Glass and nothing else; frosted glass has a model here only if it is white."""
    roughened = "metallicRoughnessTexture" in draft.core
    smooth = draft.roughness < LEAST_ROUGHNESS
    extension = draft.extension("dispersion")
    spread = real(extension, "dispersion", 0.0) if thick and extension is not None else 0.0
    values = {"eta": draft.ior}
    if spread > 0:
        values["dispersion"] = spread
    if smooth:
        draft.textured("tint", draft.core, "baseColorTexture", "srgb")
        model = ("dispersive_glass" if spread > 0 else "glass") if thick else "thin_glass"
        return finished(model, values | {"tint": draft.base_color}, draft)
    white = bool(draft.base_color.min() == 1) and "baseColorTexture" not in draft.core
    if not thick or roughened or not white:
        return None
    model = "dispersive_dielectric" if spread > 0 else "rough_dielectric"
    return finished(model, values | {"roughness": draft.roughness}, draft)

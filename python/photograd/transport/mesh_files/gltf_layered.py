"""glTF materials with several extensions at once: all of them in one model [Khronos2022].

`gltf_layered` and, of bodies that bend light, `gltf_layered_volume` hold every layer. Materials
with a single layer keep the smaller model of that layer, where that is the same; a coat's is not,
since light passes `clearcoat` twice.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd.transport.material import Material
from photograd.transport.mesh_files.container import real
from photograd.transport.mesh_files.gltf_clear import (
    MIN_ROUGHNESS,
    attenuation,
    is_thick,
    transmission_factor,
)
from photograd.transport.mesh_files.gltf_material_reader import (
    PLAIN_IOR,
    MaterialReader,
    make_material,
    metallic_roughness,
    usable_ior,
)

NAMES = (
    "specular",
    "ior",
    "anisotropy",
    "iridescence",
    "sheen",
    "clearcoat",
    "transmission",
    "volume",
    "dispersion",
)
"""The extensions that it speaks for."""


def layered(reader: MaterialReader) -> Material | None:
    """The model of all layers, if no smaller one holds what the material has.

    Args:
        reader: of the material.
    """
    thick = transmission_factor(reader) > 0 and is_thick(reader)
    reader.handle(*NAMES)  # a smaller model has the only layer; the others change nothing
    if not _needs_layers(reader, thick):
        return None
    values = metallic_roughness(reader) | {"eta": usable_ior(reader)}
    for read in (_specular, _anisotropy, _iridescence, _sheen, _clearcoat):
        values |= read(reader)
    values["transmission"] = transmission_factor(reader)
    node = reader.extension("transmission")
    if node is not None and values["transmission"] > 0:
        reader.textured("transmission", node, "transmissionTexture", "linear", 0)
    if not thick:
        return make_material("gltf_layered", values, reader)
    volume, spread = reader.extension("volume"), reader.extension("dispersion")
    assert volume is not None
    reader.note_unsupported(volume, "thicknessTexture")
    reader.interior = attenuation(reader, volume)
    values["dispersion"] = 0.0 if spread is None else real(spread, "dispersion", 0.0)
    if values["roughness"] < MIN_ROUGHNESS:
        words = f"roughness {values['roughness']:g} is drawn as {MIN_ROUGHNESS}"
        reader.note(
            f"{reader.node.where}: {words}: clear glass with other layers is a little frosted"
        )
    return make_material("gltf_layered_volume", values, reader)


def _needs_layers(reader: MaterialReader, thick: bool) -> bool:
    passes = transmission_factor(reader) > 0
    layers = [
        _is_tinted(reader) or (reader.ior != PLAIN_IOR and not passes),
        _factor(reader, "iridescence", "iridescenceFactor") > 0,
        _factor(reader, "anisotropy", "anisotropyStrength") > 0,
        bool(sheen_color(reader).any()),
        passes,
    ]
    return (
        sum(layers) > 1
        or _factor(reader, "clearcoat", "clearcoatFactor") > 0
        or _brushed_in_part(reader)
        or (thick and _parts_colors_in_part(reader))
    )


def _is_tinted(reader: MaterialReader) -> bool:
    """Whether the reflection of a coating is weakened or colored."""
    node = reader.extension("specular")
    if node is None:
        return False
    color = node["specularColorFactor"].numbers((3,)) if "specularColorFactor" in node else 1.0
    textured = "specularTexture" in node or "specularColorTexture" in node
    return real(node, "specularFactor", 1.0) != 1 or bool(np.any(color != 1)) or textured


def _brushed_in_part(reader: MaterialReader) -> bool:
    """Whether something is brushed that is not all metal, or not everywhere alike."""
    node = reader.extension("anisotropy")
    if node is None or real(node, "anisotropyStrength", 0.0) <= 0:
        return False
    mixed = reader.metalness < 1 or "metallicRoughnessTexture" in reader.core
    return mixed or "anisotropyTexture" in node


def _parts_colors_in_part(reader: MaterialReader) -> bool:
    """Whether glass spreads colors that is not clear, or frosted and white."""
    if _factor(reader, "dispersion", "dispersion") <= 0:
        return False
    node = reader.extension("transmission")
    whole = (
        transmission_factor(reader) == 1 and node is not None and "transmissionTexture" not in node
    )
    white = bool(reader.base_color.min() == 1) and "baseColorTexture" not in reader.core
    smooth = reader.roughness < MIN_ROUGHNESS
    textured = "metallicRoughnessTexture" in reader.core
    return not (whole and reader.metalness == 0 and (smooth or (white and not textured)))


def _factor(reader: MaterialReader, extension: str, key: str) -> float:
    node = reader.extension(extension)
    return 0.0 if node is None else real(node, key, 0.0)


def sheen_color(reader: MaterialReader) -> Any:
    """(3,) without its texture; black is no sheen.

    Args:
        reader: of the material.
    """
    node = reader.extension("sheen")
    if node is None or "sheenColorFactor" not in node:
        return np.zeros(3)
    return node["sheenColorFactor"].numbers((3,))


def _specular(reader: MaterialReader) -> dict[str, Any]:
    node = reader.extension("specular")
    values: dict[str, Any] = {"specular_factor": 1.0, "specular_color_factor": np.ones(3)}
    if node is None:
        return values
    reader.textured("specular_factor", node, "specularTexture", "alpha")
    reader.textured("specular_color_factor", node, "specularColorTexture", "srgb")
    values["specular_factor"] = real(node, "specularFactor", 1.0)
    if "specularColorFactor" in node:
        values["specular_color_factor"] = node["specularColorFactor"].numbers((3,))
    return values


def _anisotropy(reader: MaterialReader) -> dict[str, Any]:
    """Red and green of the texture are a direction, from -1 to 1, blue is its strength."""
    node = reader.extension("anisotropy")
    values = {"anisotropy": 0.0, "rotation": 0.0, "anisotropy_x": 1.0, "anisotropy_y": 0.0}
    if node is None:
        return values
    key = "anisotropyTexture"
    for parameter, channel in (("anisotropy_x", 0), ("anisotropy_y", 1), ("anisotropy", 2)):
        reader.textured(parameter, node, key, "direction", channel)
    return values | {
        "anisotropy": real(node, "anisotropyStrength", 0.0),
        "rotation": rotation(reader),
        "anisotropy_y": 1.0 if key in node else 0.0,
    }


def rotation(reader: MaterialReader) -> float:
    """Of the brush marks, -pi to pi.

    Args:
        reader: of the material.
    """
    node = reader.extension("anisotropy")
    turn = 0.0 if node is None else real(node, "anisotropyRotation", 0.0)
    return turn if -np.pi <= turn <= np.pi else float(np.angle(np.exp(1j * turn)))


def _iridescence(reader: MaterialReader) -> dict[str, Any]:
    node = reader.extension("iridescence")
    if node is None:
        return {"iridescence_factor": 0.0, "iridescence_ior": 1.3, "iridescence_thickness": 400.0}
    reader.textured("iridescence_factor", node, "iridescenceTexture", "linear", 0)
    return {
        "iridescence_factor": real(node, "iridescenceFactor", 0.0),
        "iridescence_ior": real(node, "iridescenceIor", 1.3),
        "iridescence_thickness": film_thickness(reader),
    }


def film_thickness(reader: MaterialReader) -> float:
    """Nanometers where its texture is 1; the texture, if there is one, is wanted.

    It blends from the minimum of the file to its maximum: as a factor of the larger one, it spans a
    range that need not start at 0.

    Args:
        reader: of the material.
    """
    node = reader.extension("iridescence")
    assert node is not None
    least = real(node, "iridescenceThicknessMinimum", 100.0)
    most = real(node, "iridescenceThicknessMaximum", 400.0)
    key = "iridescenceThicknessTexture"
    if key not in node:
        return most
    largest = max(least, most)
    span = (least / largest, most / largest) if largest > 0 else (0.0, 1.0)
    encoding = "linear" if span == (0.0, 1.0) else f"span {span[0]!r} {span[1]!r}"
    reader.textured("iridescence_thickness", node, key, encoding, 1)
    return largest


def _sheen(reader: MaterialReader) -> dict[str, Any]:
    node = reader.extension("sheen")
    if node is None:
        return {"sheen_color_factor": np.zeros(3), "sheen_roughness_factor": 0.5}
    reader.textured("sheen_color_factor", node, "sheenColorTexture", "srgb")
    reader.textured("sheen_roughness_factor", node, "sheenRoughnessTexture", "alpha")
    return {
        "sheen_color_factor": sheen_color(reader),
        "sheen_roughness_factor": real(node, "sheenRoughnessFactor", 0.0),
    }


def _clearcoat(reader: MaterialReader) -> dict[str, Any]:
    node = reader.extension("clearcoat")
    if node is None:
        return {"coat": 0.0, "coat_roughness": 0.1}
    reader.note_unsupported(node, "clearcoatNormalTexture")
    reader.textured("coat", node, "clearcoatTexture", "linear", 0)
    reader.textured("coat_roughness", node, "clearcoatRoughnessTexture", "linear", 1)
    return {
        "coat": real(node, "clearcoatFactor", 0.0),
        "coat_roughness": real(node, "clearcoatRoughnessFactor", 0.0),
    }

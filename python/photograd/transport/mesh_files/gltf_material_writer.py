"""Reflectance models as materials of glTF: what `gltf_materials` reads, written.

Each function is the inverse of a rule there. A model that glTF lacks is refused by name.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from photograd.transport.material import Material
from photograd.transport.medium import Medium

Values = dict[str, Any]
_MAX_DEPTH = 4.0
"""Optical depth, in the thickest channel, at the distance for which a color is written."""


@dataclass
class GltfMaterial:
    """A material of a file.

    Attributes:
        core: its pbrMetallicRoughness.
        extensions: by their names without KHR_materials_.
    """

    core: dict[str, Any]
    extensions: dict[str, dict[str, Any]] = field(default_factory=dict)


def gltf_material(material: Material) -> GltfMaterial:
    """The numbers of a material of a model in `WRITTEN`; textures and alpha are added elsewhere."""
    return WRITTEN[material.model](
        {
            name: [float(x) for x in value] if np.ndim(value) else float(value)
            for name, value in material.values.items()
        }
    )


def _core(color: Any, metalness: float, roughness: float) -> dict[str, Any]:
    return {
        "baseColorFactor": [*color, 1.0],
        "metallicFactor": metalness,
        "roughnessFactor": roughness,
    }


def _gltf(v: Values) -> GltfMaterial:
    return GltfMaterial(_core(v["base_color"], v["metalness"], v["roughness"]))


def _lambert(v: Values) -> GltfMaterial:
    """A dielectric that mirrors nothing."""
    return GltfMaterial(_core(v["albedo"], 0.0, 1.0), {"specular": {"specularFactor": 0.0}})


def _metal(v: Values) -> GltfMaterial:
    return GltfMaterial(_core(v["f0"], 1.0, v["roughness"]))


def _anisotropic(v: Values) -> GltfMaterial:
    turned = {"anisotropyStrength": v["anisotropy"], "anisotropyRotation": v["rotation"]}
    return GltfMaterial(_metal(v).core, {"anisotropy": turned})


def _clearcoat(v: Values) -> GltfMaterial:
    coat = {"clearcoatFactor": v["coat"], "clearcoatRoughnessFactor": v["coat_roughness"]}
    return GltfMaterial(_gltf(v).core, {"clearcoat": coat})


def _sheen(v: Values) -> GltfMaterial:
    cloth = {
        "sheenColorFactor": v["sheen_color_factor"],
        "sheenRoughnessFactor": v["sheen_roughness_factor"],
    }
    return GltfMaterial(_gltf(v).core, {"sheen": cloth})


def _iridescence(v: Values) -> GltfMaterial:
    film = {
        "iridescenceFactor": v["iridescence_factor"],
        "iridescenceIor": v["iridescence_ior"],
        "iridescenceThicknessMinimum": 0.0,
        "iridescenceThicknessMaximum": v["iridescence_thickness"],
    }
    return GltfMaterial(_gltf(v).core, {"iridescence": film})


def _specular(v: Values) -> GltfMaterial:
    coating = {
        "specularFactor": v["specular_factor"],
        "specularColorFactor": v["specular_color_factor"],
    }
    return GltfMaterial(_gltf(v).core, {"specular": coating, "ior": {"ior": v["eta"]}})


def _clear(v: Values) -> GltfMaterial:
    """Smooth if there is no roughness, white if there is no color."""
    core = _core(v.get("tint", [1.0] * 3), 0.0, v.get("roughness", 0.0))
    passing = {"transmission": {"transmissionFactor": 1.0}, "ior": {"ior": v["eta"]}}
    if "dispersion" in v:
        passing["dispersion"] = {"dispersion": v["dispersion"]}
    return GltfMaterial(core, passing)


def _thick(v: Values) -> GltfMaterial:
    written = _clear(v)
    written.extensions["volume"] = {"thicknessFactor": 1.0}  # any but 0 means: a body
    return written


def _transmission(v: Values) -> GltfMaterial:
    extensions = {
        "transmission": {"transmissionFactor": v["transmission"]},
        "ior": {"ior": v["eta"]},
    }
    return GltfMaterial(_gltf(v).core, extensions)


def _refraction(v: Values) -> GltfMaterial:
    written = _transmission(v)
    written.extensions["volume"] = {"thicknessFactor": 1.0}
    return written


def _layered(v: Values) -> GltfMaterial:
    """All layers, those of factor 0 as well: their other numbers come back."""
    written = _gltf(v)
    turn = v["rotation"] + float(np.arctan2(v["anisotropy_y"], v["anisotropy_x"]))
    directed = (v["anisotropy_x"], v["anisotropy_y"]) == (1.0, 1.0)  # of a texture
    written.extensions |= _specular(v).extensions | _sheen(v).extensions | _clearcoat(v).extensions
    written.extensions |= _iridescence(v).extensions | _transmission(v).extensions
    written.extensions["anisotropy"] = {
        "anisotropyStrength": v["anisotropy"],
        "anisotropyRotation": v["rotation"] if directed else turn,
    }
    return written


def _layered_volume(v: Values) -> GltfMaterial:
    written = _layered(v)
    written.extensions["volume"] = {"thicknessFactor": 1.0}
    written.extensions["dispersion"] = {"dispersion": v["dispersion"]}
    return written


WRITTEN: dict[str, Callable[[Values], GltfMaterial]] = {
    "gltf": _gltf,
    "gltf_specular": _specular,
    "clearcoat": _clearcoat,
    "ggx_anisotropic": _anisotropic,
    "gltf_sheen": _sheen,
    "gltf_iridescence": _iridescence,
    "thin_glass": _clear,
    "glass": _thick,
    "dispersive_glass": _thick,
    "rough_dielectric": _thick,
    "dispersive_dielectric": _thick,
    "gltf_transmission": _transmission,
    "gltf_refraction": _refraction,
    "gltf_layered": _layered,
    "gltf_layered_conserving": _layered,
    "gltf_layered_volume": _layered_volume,
    "gltf_layered_volume_conserving": _layered_volume,
    "lambert": _lambert,
    "ggx_metal": _metal,
}
"""Models that glTF can express."""
BODIES = {
    name for name, write in WRITTEN.items() if write in (_thick, _refraction, _layered_volume)
}
"""Those with a volume, which may swallow light."""


def attenuation(medium: Medium) -> dict[str, Any]:
    """What KHR_materials_volume says of a medium that only absorbs: the inverse of Beer's law."""
    most = float(medium.sigma_t.max())
    if most == 0:
        return {}
    distance = _MAX_DEPTH / most
    color = np.exp(-medium.sigma_t * distance)
    return {"attenuationDistance": distance, "attenuationColor": color.tolist()}

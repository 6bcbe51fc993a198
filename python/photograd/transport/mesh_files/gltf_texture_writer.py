"""Textures and normal maps as images of a glTF file, eight bits a channel."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from photograd_course.color import srgb_encode

from photograd._gltf_bytes import GltfBytes
from photograd.errors import SceneError, message
from photograd.transport.material import Material
from photograd.transport.mesh_files.gltf_material_writer import GltfMaterial
from photograd.transport.mesh_files.gltf_samplers import gltf_sampler
from photograd.transport.texture import Filter, NormalMap, OcclusionMap, Texture, TextureUse, Wrap
from photograd.types import Array

_LABEL = re.compile(r" \((srgb|linear|alpha|mask|direction|span [^,]*), \d+\)$")
"""What reading adds to the name of an image."""
_COLOR = ("", "baseColorTexture", "srgb", 0)
SLOTS = {
    "base_color": _COLOR,
    "tint": _COLOR,
    "f0": _COLOR,
    "albedo": _COLOR,
    "alpha": ("", "baseColorTexture", "alpha", 3),
    "metalness": ("", "metallicRoughnessTexture", "linear", 2),
    "roughness": ("", "metallicRoughnessTexture", "linear", 1),
    "anisotropy_x": ("anisotropy", "anisotropyTexture", "direction", 0),
    "anisotropy_y": ("anisotropy", "anisotropyTexture", "direction", 1),
    "anisotropy": ("anisotropy", "anisotropyTexture", "direction", 2),
    "coat": ("clearcoat", "clearcoatTexture", "linear", 0),
    "coat_roughness": ("clearcoat", "clearcoatRoughnessTexture", "linear", 1),
    "sheen_color_factor": ("sheen", "sheenColorTexture", "srgb", 0),
    "sheen_roughness_factor": ("sheen", "sheenRoughnessTexture", "alpha", 3),
    "iridescence_factor": ("iridescence", "iridescenceTexture", "linear", 0),
    "iridescence_thickness": ("iridescence", "iridescenceThicknessTexture", "linear", 1),
    "specular_factor": ("specular", "specularTexture", "alpha", 3),
    "specular_color_factor": ("specular", "specularColorTexture", "srgb", 0),
    "transmission": ("transmission", "transmissionTexture", "linear", 0),
}
"""{parameter: (extension, or none; member; encoding; channel of the image)}."""


@dataclass
class TextureWriter:
    """The images of a file, each written once.

    Attributes:
        file: takes them.
        textures: of the scene.
    """

    file: GltfBytes
    textures: Mapping[str, Texture]
    _numbers: dict[object, int] = field(default_factory=dict)

    def material(self, written: GltfMaterial, material: Material) -> None:
        """Add the textures of a material to what is written of it.

        Raises:
            SceneError: textures of one image that differ in size, wrap or filter.
        """
        members: dict[tuple[str, str], list[tuple[str, int, TextureUse]]] = {}
        for parameter, use in material.textures.items():
            extension, key, encoding, channel = SLOTS[parameter]
            if key == "baseColorTexture" and channel == 3 and material.alpha_cutoff is not None:
                encoding = "mask"
            if parameter == "iridescence_thickness":
                encoding = self._span(written, material, use)
            members.setdefault((extension, key), []).append((encoding, channel, use))
        for (extension, key), uses in members.items():
            node = written.extensions[extension] if extension else written.core
            node[key] = {"index": self._shared(key, uses)}

    def _span(self, written: GltfMaterial, material: Material, use: TextureUse) -> str:
        """The encoding of a film's thickness, whose minimum is written."""
        low = minimum_of(self.textures[use.texture].values[..., use.channel])
        most = float(material.values["iridescence_thickness"])
        written.extensions["iridescence"]["iridescenceThicknessMinimum"] = low * most
        return f"span {low!r} 1.0" if low > 0 else "linear"

    def color(self, use: TextureUse) -> int:
        """The number of a texture of colors.

        Args:
            use: the texture, and its channels.
        """
        return self._shared("emissiveTexture", [("srgb", 0, use)])

    def normal_map(self, bent: NormalMap) -> dict[str, Any]:
        """A normalTexture.

        Args:
            bent: the normals.
        """
        pixels, scale = normals_as_bytes(bent.values)
        key = (pixels.tobytes(), pixels.shape, bent.wrap)
        if key not in self._numbers:
            self._numbers[key] = self._texture("normals", pixels, bent.wrap, "bilinear")
        return {"index": self._numbers[key], "scale": scale}

    def occlusion(self, map_: OcclusionMap) -> dict[str, Any]:
        """An occlusionTexture: gray, of which red counts.

        Args:
            map_: the factors.
        """
        pixels = np.asarray(np.rint(255 * np.clip(map_.values, 0, 1)), np.uint8)
        key = ("occlusion", pixels.tobytes(), pixels.shape, map_.wrap)
        if key not in self._numbers:
            gray = np.repeat(pixels, 3, axis=2)
            self._numbers[key] = self._texture("occlusion", gray, map_.wrap, "bilinear")
        return {"index": self._numbers[key], "strength": map_.strength}

    def _shared(self, member: str, uses: list[tuple[str, int, TextureUse]]) -> int:
        key = tuple(uses)
        if key not in self._numbers:
            found = [self.textures[use.texture] for _, _, use in uses]
            # Masks are read point by point, whatever the sampler of their image says.
            filters = {
                t.filter
                for t, (encoding, _, _) in zip(found, uses, strict=True)
                if encoding != "mask"
            }
            looked_up: Filter = max(filters, default="bilinear")
            if len({(t.values.shape[:2], t.wrap) for t in found}) > 1 or len(filters) > 1:
                names = ", ".join(use.texture for _, _, use in uses)
                expected = f"one size, wrap and filter for {member}, which is one image"
                got = sorted((t.values.shape[:2], t.wrap, t.filter) for t in found)
                raise SceneError(message("save_gltf", f"textures {names}", expected, got))
            pixels = _pixels(uses, found)
            name = _LABEL.sub("", uses[0][2].texture)
            self._numbers[key] = self._texture(name, pixels, found[0].wrap, looked_up)
        return self._numbers[key]

    def _texture(self, name: str, pixels: Array, wrap: Wrap, looked_up: Filter) -> int:
        entry = {"source": self.file.image(name, pixels)}
        sampler = gltf_sampler(wrap, looked_up)
        if sampler:
            key = ("sampler", wrap, looked_up)
            if key not in self._numbers:
                self._numbers[key] = self.file.entry("samplers", sampler)
            entry["sampler"] = self._numbers[key]
        return self.file.entry("textures", entry)


def minimum_of(values: Array) -> float:
    """What byte 0 stands for, if 255 stands for 1 and equal steps lie between: as far above 0 as
    the values come back from bytes; 0 if they do not.
    """
    levels = np.unique(values.astype(np.float64))
    if levels[0] <= 0 or levels[-1] > 1 or len(levels) > 256:
        return 0.0
    gaps = np.diff(np.append(levels[levels < 1 - _SAME], 1.0))
    step = float(gaps.min(initial=1.0))
    span = 1.0 - float(levels[0])
    for divisor in range(1, 256):
        count = round(span * divisor / step)
        if not 0 < count <= 255:
            break
        low = 1.0 - 255.0 * span / count  # from all the levels: the smallest gap is rounded
        if abs(low) < _SAME:
            return 0.0
        bytes_ = 255.0 * (levels - low) / (1.0 - low)
        if low > 0 and np.abs(bytes_ - np.rint(bytes_)).max() < 1e-3:
            return low
    return 0.0


_SAME = 1e-6
"""Texels closer than this are one level."""


def _pixels(uses: list[tuple[str, int, TextureUse]], textures: list[Texture]) -> Array:
    """(H, W, 3 or 4) bytes; channels that nobody wants are those of a texture, or white."""
    height, width = textures[0].values.shape[:2]
    image = np.full((height, width, 4), 255, np.uint8)
    if any(encoding == "direction" for encoding, _, _ in uses):
        image[..., 1] = 128  # along the tangent, as nearly as bytes say it
    for (encoding, channel, use), texture in zip(uses, textures, strict=True):
        values = texture.values.astype(np.float64)
        if encoding == "direction" and channel < 2:
            values = 0.5 * (values + 1)
        if encoding.startswith("span"):
            low = float(encoding.split()[1])
            values = (values - low) / (1 - low)
        values = np.clip(values, 0, 1)
        read, written, wide = use.channel, channel, 3 if encoding == "srgb" else 1
        if encoding == "linear" and read == written and values.shape[2] == 3:
            read, written, wide = 0, 0, 3
        part = values[..., read : read + wide]
        shown = srgb_encode(part) if encoding == "srgb" else part
        image[..., written : written + wide] = np.rint(255 * np.asarray(shown))
    covers = any(encoding in ("alpha", "mask") for encoding, _, _ in uses)
    return image if covers else image[..., :3].copy()


def normals_as_bytes(values: Array) -> tuple[Array, float]:
    """(H, W, 3) bytes and the scale of the tilt that come back as a normal map's values.

    Read from a file, tilts are odd multiples of scale / 255: the scale is guessed from the smallest
    of them, made exact by the largest, and proved on all. Other maps get the least scale that holds
    all tilts, and are rounded.
    """
    tilt = np.abs(values[..., :2]).astype(np.float64)
    few = values.reshape(1, -1, 3)[:, :64]
    for scale in _scales(float(tilt.min()), float(tilt.max())):
        if _comes_back(few, scale) and _comes_back(values, scale):
            return _as_bytes(values, scale), float(scale)
    scale = np.float32(max(1.0, float(tilt.max())))
    return _as_bytes(values, scale), float(scale)


def _scales(least: float, most: float) -> Iterator[np.float32]:
    """Scales for which both tilts are odd multiples of scale / 255, about."""
    for odd in range(1, 256, 2) if least > 0 else ():
        multiple = 2 * round((most * odd / least - 1) / 2) + 1
        if multiple > 255:
            return
        for byte in (255 - multiple) // 2, (255 + multiple) // 2:
            # Divided by what the byte is in float, which cancellation has rounded.
            tilt = np.abs(np.float32(2) * (np.float32(byte) / np.float32(255)) - np.float32(1))
            middle = np.float32(most / float(tilt))
            up = np.nextafter(middle, np.float32(np.inf))
            down = np.nextafter(middle, np.float32(0))
            yield from (middle, up, down)


def _comes_back(values: Array, scale: np.float32) -> bool:
    return np.array_equal(_as_values(_as_bytes(values, scale), scale), values)


def _as_bytes(values: Array, scale: np.float32) -> Array:
    units = values.astype(np.float64) / [scale, scale, 1.0]
    return np.asarray(np.rint(np.clip(0.5 * (units + 1), 0, 1) * 255), np.uint8)


def _as_values(pixels: Array, scale: np.float32) -> Array:
    image = pixels.astype(np.float32) / np.float32(255)
    return NormalMap.from_image(image, float(scale)).values

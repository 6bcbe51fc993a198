"""Images of glTF materials: which coordinates, decoded how [Khronos2021, Sec. 3.8]."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import PurePath

import numpy as np
from PIL import Image

from photograd._json_node import JsonNode
from photograd.errors import Error, IoError, message
from photograd.images.kind import PILLOW_KINDS, allow_pixels, require_pixels, too_many_pixels
from photograd.transport.mesh_files.container import NAME, Container, real, whole
from photograd.transport.mesh_files.gltf_samplers import read_sampler
from photograd.transport.texture import Filter, OcclusionMap, Texture, Wrap, decode
from photograd.types import Array

TRANSFORM = "KHR_texture_transform"
_LEVELS = np.arange(256, dtype=np.float32) / np.float32(255)


def _levels(encoding: str) -> Array:
    """(256,) float32: what bytes stand for."""
    if encoding == "srgb":
        return decode(_LEVELS)
    if encoding.startswith("span"):
        low, high = (float(end) for end in encoding.split()[1:])
        return np.asarray(low + (high - low) * _LEVELS.astype(np.float64), np.float32)
    return _LEVELS


@dataclass(frozen=True)
class Coordinates:
    """Which set of texture coordinates, and how it is moved: uv' = offset + R(rotation) S uv.

    The rotation turns counter-clockwise as one sees it with v downwards.
    """

    set: int = 0
    offset: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)

    def apply(self, uv: Array) -> Array:
        """Uv (V, 2), moved.

        Args:
            uv: (V, 2).
        """
        c, s = np.cos(self.rotation), np.sin(self.rotation)
        with np.errstate(over="ignore", invalid="ignore"):
            moved = (uv * np.array(self.scale)) @ np.array([[c, s], [-s, c]]).T + self.offset
            return np.asarray(moved, np.float32)


@dataclass
class Pictures:
    """The textures of a file, each decoded once and only if a material asks for it."""

    container: Container
    note: Callable[[str], None]
    textures: dict[str, Texture] = field(default_factory=dict)
    _images: dict[int, Array | None] = field(default_factory=dict)

    def coordinates(self, info: JsonNode) -> Coordinates:
        """Of a textureInfo object.

        Args:
            info: the object.
        """
        number = whole(info, 0, 15, "texCoord", 0)
        if "extensions" not in info or TRANSFORM not in info["extensions"]:
            return Coordinates(number)
        moved = info["extensions"][TRANSFORM]
        number = whole(moved, 0, 15, "texCoord", number)
        u, v = moved["offset"].numbers((2,)) if "offset" in moved else (0.0, 0.0)
        x, y = moved["scale"].numbers((2,)) if "scale" in moved else (1.0, 1.0)
        turn = real(moved, "rotation", 0.0)
        return Coordinates(number, (float(u), float(v)), turn, (float(x), float(y)))

    def texture(self, info: JsonNode, encoding: str) -> str | None:
        """The name of the texture that a textureInfo object points at; None, with a note, if the
        image is missing or damaged. Of the encoding "alpha" it is its opacity, (H, W, 1), and
        None without a note if that is 1 everywhere. "mask" is opacity that is compared with a
        cutoff, point by point: the mean over a net of wires is above or below it as a whole. Of
        "direction", red and green go from -1 to 1; "span a b" goes from a to b.

        Args:
            info: the object.
            encoding: "linear", "srgb" or one of these.
        """
        number = whole(info, 0, 1 << 31, "index")
        found = self._pixels(info)
        if found is None:
            return None
        image, (wrap, looked_up), label = found
        name = f"{label} ({encoding}, {number})"
        if encoding in ("alpha", "mask") and bool((image[..., 3] == 255).all()):
            return None
        if encoding == "mask" and looked_up == "mip":
            self._sees_points(info)
            looked_up = "bilinear"
        if name not in self.textures:
            part = slice(3, 4) if encoding in ("alpha", "mask") else slice(0, 3)
            color = _levels(encoding)[image[..., part]]
            if encoding == "direction":
                color[..., :2] = 2 * color[..., :2] - 1
            self.textures[name] = Texture(color, wrap, looked_up)
        return name

    def emission_texture(self, info: JsonNode) -> str | None:
        """As `texture`, of what shines, which paths see point by point.

        Args:
            info: the object.
        """
        name = self.texture(info, "srgb")
        if name is not None and self.textures[name].filter == "mip":
            self._sees_points(info)
        return name

    def normal_map(self, info: JsonNode) -> tuple[Array, Wrap] | None:
        """Pixels (H, W, 3) in 0..1 and wrap of a texture that holds normals.

        Args:
            info: a textureInfo object.
        """
        found = self._pixels(info)
        if found is None:
            return None
        image, (wrap, looked_up), _ = found
        if looked_up == "mip":
            self._sees_points(info)
        return _LEVELS[image[..., :3]], wrap

    def occlusion(self, info: JsonNode) -> OcclusionMap | None:
        """The map that an occlusionTextureInfo object points at: the image's red channel.

        Args:
            info: the object.
        """
        found = self._pixels(info)
        if found is None:
            return None
        image, (wrap, _), _ = found
        strength = real(info, "strength", 1.0)
        if not 0 <= strength <= 1:
            self.note(f"{info.where}: strength: {strength} is taken as {min(max(strength, 0), 1)}")
        return OcclusionMap(_LEVELS[image[..., :1]], min(max(strength, 0.0), 1.0), wrap)

    def _sees_points(self, info: JsonNode) -> None:
        self.note(f"{info.where}: mip maps of its sampler: not supported, sampled without mip maps")

    def _pixels(self, info: JsonNode) -> tuple[Array, tuple[Wrap, Filter], str] | None:
        texture = self.container.entry("textures", info["index"])
        looks: tuple[Wrap, Filter] = (("repeat", "repeat"), "bilinear")
        if "sampler" in texture:
            sampler = self.container.entry("samplers", texture["sampler"])
            looks = read_sampler(sampler, self.note)
        if "source" not in texture:
            self.note(f"{texture.where}: no image in a format that is read; left out")
            return None
        source = texture["source"]
        number = whole(source, 0, 1 << 31)
        image = self.container.entry("images", source)
        if number not in self._images:
            try:
                self._images[number] = self._decoded(image)
            except Error as failure:
                self.note(f"{image.where}: left out: {failure}")
                self._images[number] = None
        pixels = self._images[number]
        name = image["name"].text() if "name" in image else ""
        return None if pixels is None else (pixels, looks, PurePath(name).name or f"image {number}")

    def _decoded(self, image: JsonNode) -> Array:
        """(H, W, 4) of 8 bits, as stored; alpha is 255 where the file has none."""
        if "bufferView" in image:
            data = bytes(self.container.view(image["bufferView"])[0])
        else:
            data = self.container.fetch(image["uri"])
        allow_pixels()
        try:
            with Image.open(io.BytesIO(data), formats=PILLOW_KINDS) as opened:
                require_pixels(NAME, image.where, opened.width, opened.height)
                self.container.spend(image, opened.width * opened.height)
                return np.asarray(opened.convert("RGBA"))
        except IoError:
            raise
        except Image.DecompressionBombError as failure:
            raise too_many_pixels(NAME, image.where, failure) from failure
        except Exception as failure:  # Pillow's plugins do not share an exception
            text = " ".join(str(failure).split())[:120] or type(failure).__name__
            raise IoError(message(NAME, image.where, "a PNG or JPEG image", text)) from failure

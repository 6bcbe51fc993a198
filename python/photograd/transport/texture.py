"""Pictures on surfaces: a material's parameter times a texture, and bent normals.

A texture is linear and (H, W, C), T[row, column], v downwards; `from_image` decodes sRGB. Lookups
are bilinear: a path tracer averages over a pixel by its many samples, and needs no mip map. With
few samples one helps: `filter` "mip" looks up the mean over what a pixel sees at once, by ray cones
(cpp/photograd/render/path/ray_cone.h). It is less noisy and biased: what is averaged is the
texture, not the light, over a square as wide as the longer side of that area, and no number of
samples sharpens it again. Pictures of the textured surface itself, seen far away or through many
bounces, gain most.
Normal maps, what shines, shadows of what covers in part, and photons see single points always. A
mask is compared with its cutoff after the mean is taken, so that a net far away is all or nothing:
its alpha is better bilinear, as it is when read from glTF.
A coordinate beyond 0..1 is brought back first, so texels at a seam are not mixed across it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from photograd_course.color import srgb_decode

from photograd._arrays import Arguments
from photograd._checks import require_bounds, require_choices, typed
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.images.read import read_header, read_image
from photograd.textures import sample
from photograd.types import Array

WrapMode = Literal["repeat", "mirror", "clamp"]
Wrap = tuple[WrapMode, WrapMode]
Filter = Literal["bilinear", "mip"]
Encoding = Literal["srgb", "linear", "alpha"]
WRAPS: tuple[WrapMode, ...] = get_args(WrapMode)  # in the core's order
FILTERS: tuple[Filter, ...] = get_args(Filter)
ENCODINGS: tuple[Encoding, ...] = get_args(Encoding)


@typed_call
@dataclass(frozen=True, eq=False)
class Texture:
    """An image that scales parameters of materials.

    Attributes:
        values: (H, W, C) floating point, linear, C from 1 to 4; kept as float32.
        wrap: what happens to coordinates outside 0..1 along u and v, of `WRAPS`.
        filter: "bilinear" looks at single points, "mip" at the mean over what a ray sees.

    Raises:
        DtypeError, ShapeError: not floating point, or not (H, W, C).
        RangeError: not finite, or an unknown wrap or filter.
    """

    values: Array
    wrap: Wrap = ("repeat", "repeat")
    filter: Filter = "bilinear"

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", _picture("Texture", self.values, (1, 2, 3, 4)))
        require_choices(self)

    @property
    def channels(self) -> int:
        """C."""
        return int(self.values.shape[2])


@typed_call
@dataclass(frozen=True)
class TextureUse:
    """A parameter of a material is its value times a texture.

    Attributes:
        texture: name in the scene.
        channel: of the texture, that scales the parameter; colors take three from here on.
    """

    texture: str
    channel: int = 0


@typed_call
@dataclass(frozen=True, eq=False)
class NormalMap:
    """Normals in the frame of the texture coordinates; they are part of the shape, not parameters.

    Attributes:
        values: (H, W, 3), components -1..1 along growing u, against growing v, and outwards.
        wrap: as of `Texture`.

    Raises:
        DtypeError, ShapeError, RangeError: as `Texture`.
    """

    values: Array
    wrap: Wrap = ("repeat", "repeat")

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", _picture("NormalMap", self.values, (3,)))
        require_choices(self)

    @classmethod
    def from_image(
        cls, image: Array, scale: float = 1.0, wrap: Wrap = ("repeat", "repeat")
    ) -> NormalMap:
        """Of an image (H, W, 3 or more) that holds (n + 1) / 2; `scale` is of the tilt.

        Args:
            image: (H, W, C).
            scale: factor on x and y of the normals.
            wrap: along u and v.
        """
        values = 2 * np.asarray(image, np.float32)[..., :3] - 1
        return cls(values * np.array([scale, scale, 1], np.float32), wrap)


@typed_call
@dataclass(frozen=True, eq=False)
class OcclusionMap:
    """How much of the ambient light reaches a surface: 1 + strength (values - 1).

    For what approximates ambient light, such as `photograd.lights.prefilter.shade`. It is no
    parameter, and paths do not look at it: they find what is occluded themselves.

    Attributes:
        values: (H, W, 1), 1 where nothing is occluded; `bake_ambient_occlusion` makes them.
        strength: 0 to 1.
        wrap: as of `Texture`.

    Raises:
        DtypeError, ShapeError, RangeError: as `Texture`; a strength outside of 0..1.
    """

    values: Array
    strength: float = 1.0
    wrap: Wrap = ("repeat", "repeat")

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", _picture("OcclusionMap", self.values, (1,)))
        require_choices(self)
        require_bounds(self, "strength", low=0, high=1)

    def at(self, uv: Array) -> Array:
        """The factor (N,) of ambient light at texture coordinates (N, 2), bilinear, float32.

        Args:
            uv: (N, 2).

        Raises:
            ShapeError, RangeError: as `photograd.textures.sample`.
        """
        inside = np.array(uv, np.float32)
        for axis, wrap in enumerate(self.wrap if inside.ndim == 2 and inside.shape[1] == 2 else ()):
            x = inside[:, axis]
            if wrap == "repeat":
                inside[:, axis] = x - np.floor(x)
            elif wrap == "mirror":
                inside[:, axis] = 1 - np.abs(1 - (x - 2 * np.floor(0.5 * x)))
        found = sample(self.values, np.ascontiguousarray(inside))[:, 0]
        return np.asarray(1 + np.float32(self.strength) * (found - 1), np.float32)


@typed_call
def read_texture(
    path: Path,
    encoding: Encoding = "srgb",
    wrap: Wrap = ("repeat", "repeat"),
    filter: Filter = "bilinear",
) -> Texture:
    """The colors of an image file, without its alpha; or its alpha alone.

    Args:
        path: .png, .jpg, or, always linear, .exr, .hdr and .pfm.
        encoding: "srgb" for colors of 8 or 16 bits, which are decoded; "linear" for numbers that
            are not colors (roughness), taken as they are; "alpha" for the opacity, (H, W, 1).
        wrap, filter: as of `Texture`.

    Raises:
        IoError: no such image.
        RangeError: an unknown encoding, wrap or filter.
    """
    typed("read_texture", "encoding", Encoding, encoding)
    color = read_image(path)
    if encoding == "alpha":
        return Texture(color[..., 3:], wrap, filter)
    color = color[..., :3]
    decoded = encoding == "srgb" and read_header(path).color_space == "display"
    return Texture(decode(color) if decoded else color, wrap, filter)


def decode(color: Array) -> Array:
    """Display-encoded sRGB as linear float32.

    Args:
        color: (..., C) display values.
    """
    encoded = np.ravel(color)
    linear = np.empty(encoded.shape, np.float32)
    for start in range(0, encoded.size, 1 << 16):  # in double, but never all of it
        piece = slice(start, start + (1 << 16))
        linear[piece] = srgb_decode(encoded[piece].astype(np.float64))
    return linear.reshape(np.shape(color))


def checked_uses(
    model: str, sizes: Mapping[str, int], uses: Mapping[str, TextureUse]
) -> Mapping[str, TextureUse]:
    """`uses` if they name parameters of a model; `sizes` are those of the parameters.

    Raises:
        RangeError: an unknown parameter, or a channel below 0.
    """
    for name, use in uses.items():
        if name not in sizes:
            expected = f"parameters of {model}: {', '.join(sizes)}"
            raise RangeError(message("Material", f"textures.{name}", expected, name))
        if not 0 <= use.channel < 4:
            raise RangeError(message("Material", f"textures.{name}", "channel 0 to 3", use.channel))
    return dict(uses)


def _picture(function: str, value: Any, channels: tuple[int, ...]) -> Array:
    shapes = [("H", "W", count) for count in channels]
    call = Arguments(function, np.float32)
    return call.array("values", value, *shapes, floating=True, min_length=1)

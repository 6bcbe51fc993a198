"""What the built-in scenes share: named paints, painted parts, a sun and a sky.

In this light a white surface that faces the sun reflects a radiance a little below 1, which is
display white: the pictures use their range, and next to nothing is clipped.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from photograd_course.color import srgb_decode
from photograd_course.suggest import choose_from

from photograd.errors import RangeError, message
from photograd.scenes.description import SceneMesh, SkyDescription, SunDescription
from photograd.scenes.surface import Surface
from photograd.types import FloatArray

Color: TypeAlias = npt.NDArray[np.float32]

DARKEST: Final = 0.02
BRIGHTEST: Final = 0.95
"""No real paint reflects nothing or everything, and gradients vanish at both ends."""

_DISPLAY: Final = {
    "cream": "f6ead2",
    "white": "f7f5ef",
    "ink": "1c2740",
    "charcoal": "34302e",
    "red": "d62828",
    "coral": "f2644d",
    "orange": "f48c06",
    "amber": "ffb627",
    "yellow": "ffd23f",
    "lime": "a7c934",
    "green": "3a9d4b",
    "pine": "1d6b4f",
    "teal": "139a94",
    "turquoise": "3fc4bd",
    "sky": "5bb4e5",
    "blue": "2667c9",
    "navy": "23378a",
    "violet": "6c3fb0",
    "magenta": "c9307f",
    "pink": "f58fb0",
    "brown": "7a4a28",
    "oak": "c98f55",
    "walnut": "8a5a33",
    "maple": "e2b77e",
    "sand": "dcc48f",
    "grass": "6f9c3a",
    "forest": "3d6b32",
    "rock": "857a6e",
    "slate": "5b6068",
    "snow": "f4f6f8",
    "lagoon": "2aa7b8",
    "deep": "1b4f86",
}
"""Display-encoded, as hexadecimal RGB."""


def paint(name: str) -> Color:
    """The paint of this name.

    Raises:
        RangeError: no such paint; suggests the nearest.
    """
    if name not in _DISPLAY:
        raise RangeError(
            message("paint", "name", "a paint", repr(name), choose_from(name, _DISPLAY))
        )
    encoded = np.frombuffer(bytes.fromhex(_DISPLAY[name]), dtype=np.uint8) / np.float64(255.0)
    return within_range(srgb_decode(encoded))


def paints(*names: str) -> Color:
    """Several paints, (len(names), 3)."""
    return np.stack([paint(name) for name in names])


def paint_names() -> list[str]:
    """All names that `paint` knows."""
    return sorted(_DISPLAY)


def within_range(albedo: npt.NDArray[np.floating]) -> Color:
    """Clipped to what real paints reflect, as float32."""
    clipped: Color = np.clip(albedo, DARKEST, BRIGHTEST).astype(np.float32)
    return clipped


# Painted parts that together make a thing, which can be put anywhere.


Part: TypeAlias = tuple[Surface, Color]
"""A surface and its albedo, as `SceneMesh` takes it."""


def placed(
    parts: Iterable[Part],
    by: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    rotation: FloatArray | None = None,
) -> list[Part]:
    """All parts turned by a (3, 3) `rotation` about the origin, then shifted `by` meters."""
    return [(surface.moved(by, rotation=rotation), albedo) for surface, albedo in parts]


def as_meshes(parts: Iterable[Part]) -> tuple[SceneMesh, ...]:
    """One mesh a part."""
    return tuple(surface.painted(albedo) for surface, albedo in parts)


# The light that the built-in scenes share: a warm, slightly large sun in a blue sky.


def warm_sun(*, towards: tuple[float, float, float] = (0.55, 0.75, 0.5)) -> SunDescription:
    """A sun of 0.05 rad, ten times the real one's, so that shadows have soft edges."""
    irradiance = np.array([2.4, 2.0, 1.5])
    return SunDescription.from_irradiance(np.asarray(towards), irradiance, 0.05)


def blue_sky() -> SkyDescription:
    """Blue above, pale at the horizon, and the warm gray of lit ground below."""
    return SkyDescription(
        zenith=np.array([0.3, 0.45, 0.76]),
        horizon=np.array([0.62, 0.7, 0.8]),
        ground=np.array([0.36, 0.31, 0.25]),
    )

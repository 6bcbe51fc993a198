"""Samplers of a glTF file: what is beyond the edges of an image, and how it is filtered.

The numbers are those of OpenGL [Khronos2021, Sec. 3.8.4]. A `minFilter` that asks for mip maps
gives textures with `filter` "mip", which is LINEAR_MIPMAP_LINEAR; all other filters, and none, give
bilinear lookups, of which a pixel averages many. What looks up the nearest texel or level has no
counterpart here and is named in a note.
"""

from __future__ import annotations

from collections.abc import Callable

from photograd._json_node import JsonNode
from photograd.transport.mesh_files.container import whole
from photograd.transport.texture import Filter, Wrap, WrapMode

WRAPS: dict[WrapMode, int] = {"repeat": 10497, "mirror": 33648, "clamp": 33071}
LINEAR, TRILINEAR = 9729, 9987
FILTERS = {
    9728: "NEAREST",
    LINEAR: "LINEAR",
    9984: "NEAREST_MIPMAP_NEAREST",
    9985: "LINEAR_MIPMAP_NEAREST",
    9986: "NEAREST_MIPMAP_LINEAR",
    TRILINEAR: "LINEAR_MIPMAP_LINEAR",
}
_MAGNIFYING = (9728, LINEAR)
_KNOWN_WRAPS = {number: name for name, number in WRAPS.items()}


def read_sampler(sampler: JsonNode, note: Callable[[str], None]) -> tuple[Wrap, Filter]:
    """Wrap along u and v, and filter, as of `photograd.transport.Texture`.

    Args:
        sampler: its object.
        note: called with sentences.

    Raises:
        IoError, RangeError: values that are no whole numbers.
    """
    wrap = _wrap(sampler, "wrapS", note), _wrap(sampler, "wrapT", note)
    _filter(sampler, "magFilter", LINEAR, note)
    shrunk = _filter(sampler, "minFilter", LINEAR, note)
    return wrap, "bilinear" if shrunk == LINEAR else "mip"


def _wrap(sampler: JsonNode, key: str, note: Callable[[str], None]) -> WrapMode:
    number = whole(sampler, 0, 1 << 16, key, WRAPS["repeat"])
    if number not in _KNOWN_WRAPS:
        note(f"{sampler.where}: {key}: {number}: unknown, read as REPEAT")
    return _KNOWN_WRAPS.get(number, "repeat")


def _filter(sampler: JsonNode, key: str, default: int, note: Callable[[str], None]) -> int:
    """What there is here in the place of a filter: `LINEAR` or `TRILINEAR`."""
    number = whole(sampler, 0, 1 << 16, key, default)
    known = _MAGNIFYING if key == "magFilter" else tuple(FILTERS)
    taken = TRILINEAR if number in known and number not in _MAGNIFYING else LINEAR
    if number != taken:
        name = FILTERS[number] if number in known else f"{number}: unknown"
        note(f"{sampler.where}: {key}: {name}, read as {FILTERS[taken]}")
    return taken


def gltf_sampler(wrap: Wrap, looked_up: Filter) -> dict[str, int]:
    """An entry of the table of samplers; nothing for what a file means without one.

    A bilinear texture asks for no filter: viewers that take one sample a pixel should not be kept
    from the mip maps they need.

    Args:
        wrap: along u and v.
        looked_up: the filter.
    """
    entry: dict[str, int] = {}
    if wrap != ("repeat", "repeat"):
        entry |= {"wrapS": WRAPS[wrap[0]], "wrapT": WRAPS[wrap[1]]}
    if looked_up == "mip":
        entry |= {"magFilter": LINEAR, "minFilter": TRILINEAR}
    return entry

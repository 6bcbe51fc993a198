"""Arrays that may be zero everywhere: (pattern of the case's name, pattern of the array's name)."""

from __future__ import annotations

DELTA = ("point", "spot", "directional")
ZEROS: tuple[tuple[str, str], ...] = (
    ("*", "materials.mask.alpha"),  # where a mask ends has no derivative
    ("path/mask*", "materials.card.alpha"),
    ("path/mask*", "textures.opacity"),
    # Paths of one segment see lights alone; of two, what a light reflects is not lit.
    ("path/*/depth-1/*", "materials.*"),
    ("path/*/depth-1/*", "textures.*"),
    ("path/*/depth-1/*", "media.*"),
    ("path/*/depth-1/*", "lights.*"),
    ("path/*/depth-2/*", "materials.*"),
    ("path/large-surfaces/*", "materials.lamp.albedo"),  # black, and seldom lit
    # A medium around everything has no end: what is at infinity is not seen through it.
    ("path/haze-lights-at-infinity/*", "environment"),
    ("path/haze-lights-at-infinity/*", "lights.*.irradiance"),
    # No ray hits a delta light.
    *((f"light/{name}/*", a) for name in DELTA for a in ("L", "pdf-of", "d_L-*")),
    # The directions of these lobes depend on no parameter.
    ("delta/mirror/*", "tangent-0"),
    ("delta/thin_glass/*", "tangent-0"),
)

"""Reflectance models and phase functions: the core's registries, with parameters by name.

`registry` has the models that are functions of two directions; `specular` mirrors and panes,
`phase` what particles do, `principled` one model at millions of pairs, `gallery` pictures of all.
"""

from __future__ import annotations

from photograd.bsdf.models import (
    METALS,
    SMOOTH,
    BsdfModel,
    Parameter,
    checked_directions,
    pack_rows,
    registry,
    unpack_rows,
)

__all__ = [
    "METALS",
    "SMOOTH",
    "BsdfModel",
    "Parameter",
    "checked_directions",
    "pack_rows",
    "registry",
    "unpack_rows",
]

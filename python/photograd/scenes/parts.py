"""Painted parts that together make a thing, which can be put anywhere."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeAlias

from photograd.scenes.description import SceneMesh
from photograd.scenes.paints import Color
from photograd.scenes.surface import Surface
from photograd.types import FloatArray

Part: TypeAlias = tuple[Surface, Color]
"""A surface and its albedo, as `SceneMesh` takes it."""


def placed(
    parts: Iterable[Part],
    by: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    rotation: FloatArray | None = None,
) -> list[Part]:
    """All parts turned by a (3, 3) `rotation` about the origin, then shifted `by` metres."""
    return [(surface.moved(by, rotation=rotation), albedo) for surface, albedo in parts]


def as_meshes(parts: Iterable[Part]) -> tuple[SceneMesh, ...]:
    """One mesh a part."""
    return tuple(surface.painted(albedo) for surface, albedo in parts)

"""What the hidden checks of several tasks share."""

from __future__ import annotations

from ..common import directions, material


def pairs(t, n):
    """Pairs of directions and their roughness."""
    return directions(t.rng, n), directions(t.rng, n), t.rng.uniform(0.3, 1.0, n)


def painted(t, n):
    """What `gltf` takes."""
    return *pairs(t, n)[:2], *material(t.rng, n)

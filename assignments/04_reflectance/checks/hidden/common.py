"""Helpers for the hidden checks of several tasks."""

from photograd_course.grading.generators import upper_directions

from ..common import material


def pairs(t, n):
    """Pairs of directions and their roughness."""
    return upper_directions(t.rng, n), upper_directions(t.rng, n), t.rng.uniform(0.3, 1.0, n)


def painted(t, n):
    """Arguments of `gltf`."""
    return *pairs(t, n)[:2], *material(t.rng, n)

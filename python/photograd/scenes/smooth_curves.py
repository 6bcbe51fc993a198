"""Vessels with soft outlines and slowly changing colours: nothing here needs a fine grid."""

from __future__ import annotations

import numpy as np
from photograd_course import random

from photograd.scenes.daylight import blue_sky, warm_sun
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.lathe import lathe, rounded_profile
from photograd.scenes.paints import Color, paint, paints, within_range
from photograd.scenes.parts import Part, as_meshes
from photograd.scenes.shapes import superellipsoid, torus
from photograd.scenes.surface import Surface, rotation_about


def smooth_curves(seed: int) -> SceneDescription:
    """A vase, a bowl, a pebble and a ring within 0.7 m of the origin; `seed` turns the colours."""
    shift = float(random.uniform(seed))
    vase = lathe(rounded_profile([
        (0.0, 0.02), (0.09, 0.1), (0.06, 0.62), (0.1, 0.66), (0.12, 0.62), (0.09, 0.48),
        (0.2, 0.22), (0.17, 0.02), (0.1, -0.03), (0.0, -0.03),
    ], count=160), columns=128)  # fmt: skip
    bowl = lathe(rounded_profile([
        (0.0, 0.03), (0.12, 0.06), (0.24, 0.17), (0.26, 0.18), (0.26, 0.16), (0.15, 0.02),
        (0.08, -0.02), (0.0, -0.02),
    ], count=128), columns=128)  # fmt: skip
    pebble = superellipsoid((0.19, 0.13, 0.15), north=1.0, east=0.9)
    ring = torus(0.15, 0.055, rows=48, columns=128).moved(rotation=rotation_about("x", 75.0))
    plate = lathe(rounded_profile([
        (0.0, 0.0), (0.5, 0.0), (0.6, 0.03), (0.61, 0.02), (0.5, -0.04), (0.0, -0.05),
    ], count=128), columns=160)  # fmt: skip
    parts: list[Part] = [
        _graded(vase.moved((-0.2, -0.33, -0.16)), ("navy", "turquoise", "cream"), shift),
        _graded(bowl.moved((0.26, -0.33, -0.14)), ("magenta", "coral", "amber"), shift),
        _graded(pebble.moved((0.05, -0.23, 0.33)), ("pine", "lime", "yellow"), shift),
        _graded(ring.moved((-0.4, -0.17, 0.25)), ("violet", "pink", "sky"), shift),
        (plate.moved((0.0, -0.37, 0.0)), paint("lagoon")),
    ]
    meshes = as_meshes(parts)
    return SceneDescription("smooth_curves", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def _graded(surface: Surface, names: tuple[str, ...], shift: float) -> Part:
    """Colours that go once through the named paints and back, along a slanting direction."""
    points = surface.vertices
    low, high = points.min(axis=0), points.max(axis=0)
    way = ((points - low) / (high - low)) @ np.array([0.3, 0.6, 0.3])
    phase = np.abs((way + shift) % 2.0 - 1.0)
    stops = np.linspace(0.0, 1.0, len(names))
    colors: Color = paints(*names)
    blended = np.stack([np.interp(phase, stops, channel) for channel in colors.T], axis=-1)
    return surface, within_range(blended)

"""The scene of the demo: painted toys on a round table, in the light of a low, warm sun."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from photograd.scenes.daylight import blue_sky, warm_sun
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.lathe import lathe, rounded_profile
from photograd.scenes.paints import paint, paints
from photograd.scenes.parts import Part, as_meshes, placed
from photograd.scenes.shapes import torus
from photograd.scenes.surface import rotation_about
from photograd.scenes.textures import bands, stripes, wood
from photograd.scenes.toys import (
    beach_ball,
    blocks,
    caterpillar,
    mug,
    rainbow,
    ring_tower,
    spinning_top,
)

_TOP = -0.12
"""Height of the table's top; the floor would be at -0.62."""

_RADIUS = 0.6


def toy_table(seed: int) -> SceneDescription:
    """Toys on a table, within 0.7 m of the origin; `seed` draws the wood, tiles and marble."""
    parts = [
        *table(seed=seed),
        *placed(ring_tower(), (-0.27, _TOP, -0.2)),
        *placed(rainbow(), (0.2, _TOP, -0.33), rotation=rotation_about("y", -25.0)),
        *placed(beach_ball(), (0.39, _TOP, 0.0)),
        *placed(mug(seed=seed), (-0.36, _TOP, 0.2), rotation=rotation_about("y", 150.0)),
        *placed(blocks(seed=seed), (0.02, _TOP, 0.03), rotation=rotation_about("y", 30.0)),
        *placed(spinning_top(seed=seed), (0.34, _TOP, 0.31)),
        *placed(caterpillar(), (-0.16, _TOP, 0.43), rotation=rotation_about("y", 5.0)),
    ]
    meshes = as_meshes(parts)
    return SceneDescription("toy_table", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def table(*, seed: int) -> list[Part]:
    """A round top of planks, a striped rim, four turned legs and a ring that holds them."""
    corners = [
        (0.0, 0.0),
        (_RADIUS - 0.02, 0.0),
        (_RADIUS, -0.02),
        (_RADIUS - 0.02, -0.05),
        (0.0, -0.05),
    ]
    top = lathe(np.array(corners), columns=128).moved((0.0, _TOP, 0.0))
    flat = 0.5 + 0.5 * top.vertices[:, [0, 2]] / _RADIUS
    planks = wood((512, 512), paint("maple"), 0.75 * paint("oak"), seed=seed, planks=6)
    rim = torus(_RADIUS, 0.026, columns=160).moved((0.0, _TOP - 0.025, 0.0))
    ring = torus(0.36, 0.02, columns=128).moved((0.0, _TOP - 0.3, 0.0))
    parts: list[Part] = [
        (replace(top, uv=flat), planks),
        (rim, stripes((16, 1024), 48, paints("red", "cream"))),
        (ring, stripes((16, 1024), 40, paints("teal", "amber"))),
    ]
    for quarter in range(4):
        turn = rotation_about("y", 45.0 + 90.0 * quarter)
        parts += placed(leg(), (0.0, _TOP - 0.04, 0.0), rotation=turn)
    return parts


def leg() -> list[Part]:
    """One leg below the origin, splayed towards +Z."""
    turned = [(0, 0.01), (0.04, 0.0), (0.042, -0.06), (0.02, -0.1), (0.046, -0.15), (0.02, -0.2),
              (0.03, -0.28), (0.022, -0.36), (0.038, -0.4), (0.03, -0.44), (0, -0.45)]  # fmt: skip
    profile = rounded_profile([(float(r), float(y)) for r, y in turned])
    colors = paints("blue", "cream", "coral", "cream", "teal", "amber", "blue")
    edges = [0.2, 0.28, 0.42, 0.5, 0.72, 0.84]
    shape = lathe(profile, columns=32).moved((0, 0, 0.38), rotation=rotation_about("x", -8.0))
    return [(shape, bands((256, 8), edges, colors))]

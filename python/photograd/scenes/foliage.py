"""A bush in a pot: a thousand small leaves that hide one another. Detail without a surface."""

from __future__ import annotations

import numpy as np
from photograd_course import random

from photograd.scenes.curves import smooth_curve
from photograd.scenes.daylight import blue_sky, warm_sun
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.lathe import lathe, rounded_profile
from photograd.scenes.paints import paint, paints, within_range
from photograd.scenes.parts import Part, as_meshes
from photograd.scenes.shapes import ico_sphere
from photograd.scenes.surface import Surface, joined, rotation_about
from photograd.scenes.textures import painted_tiles
from photograd.scenes.tube import tube
from photograd.types import FloatArray

_CROWN = np.array([0.0, 0.12, 0.0])
"""Middle of the leaves, and where the branches fork."""

_REACH = np.array([0.52, 0.44, 0.52])
"""Half axes of the crown in metres."""

_LEAVES = 900
_BERRIES = 60


def foliage(seed: int) -> SceneDescription:
    """A bush within 0.7 m of the origin; `seed` places leaves, berries and branches."""
    parts = [*pot(seed=seed), *branches(seed=seed), *leaves(seed=seed), berries(seed=seed)]
    meshes = as_meshes(parts)
    return SceneDescription("foliage", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def crown_points(count: int, *, seed: int, dimension: int) -> FloatArray:
    """(count, 3) points of the crown, most of them near its outside."""
    u = np.stack(
        [random.uniform(seed, pixel=np.arange(count), dimension=dimension + k) for k in range(3)],
        axis=-1,
    )
    height = 2.0 * u[:, 0] - 1.0
    angle = 2.0 * np.pi * u[:, 1]
    across = np.sqrt(1.0 - height**2)
    outward = np.stack([across * np.sin(angle), height, across * np.cos(angle)], axis=-1)
    shell = (0.25 + 0.75 * u[:, 2]) ** (1.0 / 3.0)
    points: FloatArray = _CROWN + shell[:, None] * outward * _REACH
    return points


def leaves(*, seed: int) -> list[Part]:
    """Pointed, slightly thick leaves that look outwards and up; dark stalks, six kinds of tips."""
    names = ("grass", "lime", "green", "pine", "forest", "amber")
    stalks = crown_points(_LEAVES, seed=seed, dimension=0)
    turns = random.uniform(seed, pixel=np.arange(_LEAVES), dimension=3)
    tilts = random.uniform(seed, pixel=np.arange(_LEAVES), dimension=4)
    profile = [(0.0, 0.075), (0.012, 0.06), (0.024, 0.03), (0.016, 0.008), (0.0, 0.0)]
    blade = lathe(rounded_profile(profile, count=8), columns=8)
    groups: list[list[Surface]] = [[] for _ in names]
    for index, (stalk, turn, tilt) in enumerate(zip(stalks, turns, tilts, strict=True)):
        flat = rotation_about("x", 20.0 + 90.0 * float(tilt)) @ np.diag([1.0, 1.0, 0.2])
        outward = float(np.degrees(np.arctan2(stalk[0], stalk[2]))) + 120.0 * (float(turn) - 0.5)
        leaf = blade.moved(tuple(stalk), rotation=rotation_about("y", outward) @ flat)
        groups[index % len(names)].append(leaf)
    along = (blade.vertices[:, 1] / blade.vertices[:, 1].max())[:, None]
    parts: list[Part] = []
    for group, name in zip(groups, names, strict=True):
        blended = (1.0 - along) * paint("forest") + along * paint(name)
        parts.append((joined(group), np.tile(within_range(blended), (len(group), 1))))
    return parts


def berries(*, seed: int) -> Part:
    """Blue balls among the leaves."""
    ball = ico_sphere(0.014, subdivisions=1)
    points = crown_points(_BERRIES, seed=seed, dimension=5)
    return joined([ball.moved(tuple(point)) for point in points]), paint("blue")


def branches(*, seed: int) -> list[Part]:
    """A trunk, and branches from it to points of the crown."""
    count = 24
    foot = np.array([0.0, -0.42, 0.0])
    trunk = smooth_curve(np.stack([foot, [0.015, -0.25, 0.01], [0.0, -0.1, 0.0]]), 16)
    wood = [tube(trunk, np.linspace(0.035, 0.022, 16), sides=10)]
    for index, tip in enumerate(crown_points(count, seed=seed, dimension=8)):
        start = trunk[8 + index % 8]
        bend = 0.5 * (start + tip) + np.array([0.0, 0.05, 0.0])
        curve = smooth_curve(np.stack([start, bend, tip]), 12)
        wood.append(tube(curve, np.linspace(0.012, 0.004, 12), sides=6))
    return [(surface, paint("walnut")) for surface in wood]


def pot(*, seed: int) -> list[Part]:
    """A tiled pot, and the earth in it."""
    corners = [(0.0, -0.4), (0.17, -0.4), (0.2, -0.37), (0.18, -0.5), (0.14, -0.62), (0.0, -0.62)]
    body = lathe(rounded_profile(corners, count=64), columns=96)
    tiles = painted_tiles(
        (140, 420), (2, 12), paints("blue", "white", "sky", "navy"), paint("cream"), seed=seed
    )
    return [(body, tiles)]

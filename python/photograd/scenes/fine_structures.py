"""Scenes finer than a voxel: wires, leaves, fur.

The wires of `thin_structures` are 14 mm thick in a scene of 1.2 m. At 128 voxels across, one voxel
is 10 mm.
"""

from __future__ import annotations

import numpy as np
from photograd_course import random

from photograd.scenes.curves import smooth_curve
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.noise import fractal_noise
from photograd.scenes.parts import (
    Part,
    as_meshes,
    blue_sky,
    paint,
    paints,
    placed,
    warm_sun,
    within_range,
)
from photograd.scenes.shapes import ico_sphere, sphere, torus
from photograd.scenes.surface import (
    Surface,
    from_grid,
    joined,
    lathe,
    rotation_about,
    rounded_profile,
    tube,
)
from photograd.scenes.textures import checker, painted_tiles, stripes
from photograd.types import FloatArray

_WIRE = 0.007
_FLOOR = -0.5
_RADIUS = 0.42
_SHOULDER = 0.18
"""Height at which the upright wires begin to bend into the dome."""


def thin_structures(seed: int) -> SceneDescription:
    """A cage within 0.7 m of the origin; `seed` turns the knot and bends the climbing plant."""
    parts = [*cage(), *knot(seed=seed), *climber(seed=seed)]
    meshes = as_meshes(parts)
    return SceneDescription("thin_structures", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def cage(*, wires: int = 20) -> list[Part]:
    """Upright wires that meet in a dome, three hoops, a checkered floor, a ring to hang it by."""
    upright = _outline()
    names = ("teal", "coral", "amber", "violet", "sky")
    parts: list[Part] = []
    for index in range(wires):
        wire = tube(upright, _WIRE, sides=8)
        color = checker((512, 4), (64, 1), paints(names[index % len(names)], "cream"))
        parts += placed([(wire, color)], rotation=rotation_about("y", 360.0 * index / wires))
    for height, name in ((_FLOOR + 0.06, "red"), (-0.16, "blue"), (_SHOULDER, "red")):
        hoop = torus(_RADIUS, 1.4 * _WIRE, rows=12, columns=128).moved((0.0, height, 0.0))
        parts.append((hoop, stripes((4, 512), 64, paints(name, "cream"))))
    base = [
        (0, _FLOOR + 0.02),
        (0.43, _FLOOR + 0.02),
        (0.455, _FLOOR),
        (0.44, _FLOOR - 0.05),
        (0, _FLOOR - 0.06),
    ]
    floor = lathe(rounded_profile(base), columns=128)
    top = float(upright[-1, 1])
    ball = sphere(0.035, rows=24, columns=48).moved((0.0, top + 0.02, 0.0))
    handle = torus(0.055, _WIRE, rows=12, columns=64).moved(rotation=rotation_about("x", 90.0))
    return [
        *parts,
        (floor, checker((320, 640), (20, 32), paints("navy", "amber"))),
        (ball, stripes((64, 128), 8, paints("red", "amber"))),
        (handle.moved((0.0, top + 0.105, 0.0)), paint("orange")),
    ]


def knot(*, seed: int) -> list[Part]:
    """A trefoil, striped in all colors of the rainbow."""
    angle = 2.0 * np.pi * np.arange(360) / 360
    radius = 2.0 + np.cos(3.0 * angle)
    curve = np.stack(
        [radius * np.cos(2.0 * angle), radius * np.sin(2.0 * angle), 1.1 * np.sin(3.0 * angle)], -1
    )
    names = ("red", "orange", "yellow", "green", "teal", "sky", "blue", "violet", "magenta")
    twice = [name for name in names for _ in range(2)]
    twice[5::6] = ["cream"] * 3
    rows = checker((864, 4), (54, 1), paints(*twice))
    turn = rotation_about("y", 360.0 * float(random.uniform(seed)))
    return placed(
        [(tube(0.095 * curve, 0.05, sides=24, closed=True), rows)], (0.0, -0.12, 0.0), rotation=turn
    )


def climber(*, seed: int) -> list[Part]:
    """A plant that winds around the cage, with leaves."""
    turns, count = 2.25, 14
    step = np.linspace(0.0, 1.0, count)
    sway = random.uniform(seed, pixel=np.arange(count), dimension=1) - 0.5
    angle = 2.0 * np.pi * turns * step + 0.25 * sway
    height = _FLOOR + 0.05 + 0.72 * step
    reach = _RADIUS + 0.02
    stem = smooth_curve(
        np.stack([reach * np.sin(angle), height, reach * np.cos(angle)], axis=-1), 240
    )
    parts: list[Part] = [(tube(stem, 0.008, sides=10), paint("forest"))]
    names = ("lime", "green", "grass", "yellow")
    for index, at in enumerate(range(10, 236, 9)):
        tilt = 70.0 * float(random.uniform(seed, pixel=index, dimension=2)) - 10.0
        parts.append(_leaf(stem[at], tilt, names[index % len(names)]))
    return parts


def _leaf(stalk: FloatArray, tilt: float, name: str) -> Part:
    """A pointed, slightly thick leaf that grows outwards from the stem."""
    profile = [(0.0, 0.1), (0.016, 0.08), (0.036, 0.042), (0.026, 0.012), (0.0, 0.0)]
    blade = lathe(rounded_profile(profile, count=24), columns=24)
    flat = rotation_about("x", tilt) @ np.diag([1.0, 1.0, 0.3])
    outward = rotation_about("y", float(np.degrees(np.arctan2(stalk[0], stalk[2]))))
    return blade.moved(tuple(stalk), rotation=outward @ flat), paint(name)


def _outline() -> FloatArray:
    """One wire in the plane x = 0, from the floor to the crown."""
    crown = 0.5
    angle = np.linspace(0.0, 0.5 * np.pi, 24)
    dome = np.stack(
        [0 * angle, _SHOULDER + (crown - _SHOULDER) * np.sin(angle), _RADIUS * np.cos(angle)], -1
    )
    foot = np.array([[0.0, _FLOOR + 0.01, _RADIUS]])
    return smooth_curve(np.concatenate([foot, foot + np.array([0.0, 0.3, 0.0]), dome]), 72)


# A bush in a pot: a thousand small leaves that hide one another. Detail without a surface.


_CROWN = np.array([0.0, 0.12, 0.0])
"""Middle of the leaves, and where the branches fork."""

_REACH = np.array([0.52, 0.44, 0.52])
"""Half axes of the crown in meters."""

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


# A furry ball on its feet: thousands of strands thinner than a voxel of any grid used here.


_BODY = 0.38
_STRANDS = 4000
_POINTS = 5
_THICKNESS = 0.0045
"""Half the width of a strand at its root, in meters; at its tip it is a tenth of it."""


def fur(seed: int) -> SceneDescription:
    """A creature within 0.7 m of the origin; `seed` combs its fur."""
    parts: list[Part] = [(sphere(_BODY, rows=48, columns=96), paint("walnut"))]
    parts += strands(seed=seed)
    for x in (-0.15, 0.15):
        foot = sphere(0.1, rows=24, columns=48).moved((x, -0.5, 0.12))
        parts.append((foot, stripes((64, 128), 8, paints("amber", "orange"))))
        eye = sphere(0.075, rows=24, columns=48).moved((0.8 * x, 0.16, 0.36))
        parts.append((eye, paint("white")))
        pupil = sphere(0.04, rows=16, columns=32).moved((0.8 * x, 0.165, 0.405))
        parts.append((pupil, paint("navy")))
    meshes = as_meshes(parts)
    return SceneDescription("fur", meshes, warm_sun(), blue_sky(), bounds_of(meshes))


def strands(*, seed: int) -> list[Part]:
    """Strands that grow outwards and hang down, darker at the root, in patches of color."""
    roots = _sphere_lattice(_STRANDS)
    names = ("coral", "magenta", "violet", "blue", "teal", "lime")
    value = fractal_noise(1.3 * roots, seed=seed, octaves=2)
    patch = np.argsort(np.argsort(value)) * len(names) // _STRANDS
    length = 0.14 + 0.09 * random.uniform(seed, pixel=np.arange(_STRANDS), dimension=1)
    lean = np.stack(
        [random.uniform(seed, pixel=np.arange(_STRANDS), dimension=2 + k) - 0.5 for k in range(3)],
        axis=-1,
    )
    groups: list[list[Surface]] = [[] for _ in names]
    for index in range(_STRANDS):
        outward = roots[index] + 0.5 * lean[index]
        groups[patch[index]].append(_strand(roots[index], outward, float(length[index])))
    parts: list[Part] = []
    for group, name in zip(groups, names, strict=True):
        tuft = joined(group)
        # v runs from a strand's tip, 0, to its root, 1.
        parts.append((tuft, within_range((1.0 - 0.6 * tuft.uv[:, 1:]) * paint(name))))
    return parts


def _strand(root: FloatArray, outward: FloatArray, length: float) -> Surface:
    """A three-sided spike that starts below the skin and bends down under its weight."""
    way = np.linspace(0.0, 1.0, _POINTS)[:, None]
    outward = outward / np.linalg.norm(outward)
    center = 0.97 * _BODY * root + length * way * outward - 0.35 * length * way**2 * _UP
    side = np.cross(outward, _UP if abs(outward[1]) < 0.9 else np.array([1.0, 0.0, 0.0]))
    side /= np.linalg.norm(side)
    other = np.cross(outward, side)
    angle = 2.0 * np.pi * np.arange(3) / 3
    ring = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * other
    width = _THICKNESS * np.clip(1.0 - way, 0.1, None)
    points = center[:, None] + width[:, None] * ring
    ends = [np.repeat(center[k][None, None], 3, axis=1) for k in (0, -1)]
    return from_grid(np.concatenate([ends[0], points, ends[1]])[::-1], closed_columns=True)


_UP = np.array([0.0, 1.0, 0.0])


def _sphere_lattice(count: int) -> FloatArray:
    """(count, 3) evenly spread unit vectors [Gonzalez2010]."""
    height = 1.0 - 2.0 * (np.arange(count) + 0.5) / count
    angle = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    return np.stack([across * np.sin(angle), height, across * np.cos(angle)], axis=-1)

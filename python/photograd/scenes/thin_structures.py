"""A cage of thin wires with a painted knot inside: what a coarse grid, or a loss that blurs, loses.

The wires are 14 mm thick in a scene of 1.2 m. At 128 voxels across, one voxel is 10 mm.
"""

from __future__ import annotations

import numpy as np
from photograd_course import random

from photograd.scenes.curves import smooth_curve
from photograd.scenes.daylight import blue_sky, warm_sun
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.lathe import lathe, rounded_profile
from photograd.scenes.paints import paint, paints
from photograd.scenes.parts import Part, as_meshes, placed
from photograd.scenes.shapes import sphere, torus
from photograd.scenes.surface import rotation_about
from photograd.scenes.textures import checker, stripes
from photograd.scenes.tube import tube
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
    base = [(0, _FLOOR + 0.02), (0.43, _FLOOR + 0.02), (0.455, _FLOOR), (0.44, _FLOOR - 0.05),
            (0, _FLOOR - 0.06)]  # fmt: skip
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
    """A trefoil, striped in all colours of the rainbow."""
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
        [(tube(0.095 * curve, 0.05, sides=24, closed=True), rows)],
        (0.0, -0.12, 0.0),
        rotation=turn,
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

"""The scene of the demo: painted toys on a round table, in the light of a low, warm sun."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from photograd.scenes.curves import smooth_curve
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.parts import Color, Part, as_meshes, blue_sky, paint, paints, placed, warm_sun
from photograd.scenes.shapes import rounded_box, sphere, torus
from photograd.scenes.surface import lathe, rotation_about, rounded_profile, tube
from photograd.scenes.textures import bands, checker, marble, painted_tiles, stripes, wood


def ring_tower() -> list[Part]:
    """Five rings in the colors of the rainbow, checkered, on a pole with a ball on top."""
    foot = [(0, 0.045), (0.15, 0.045), (0.165, 0.02), (0.165, 0), (0.165, 0), (0, 0)]
    base = lathe(rounded_profile(foot))
    parts: list[Part] = [(base, stripes((8, 256), 32, paints("walnut", "amber")))]
    names = ["red", "orange", "yellow", "green", "blue"]
    height = 0.045
    for index, name in enumerate(names):
        thickness = 0.046 - 0.003 * index
        ring = torus(0.108 - 0.014 * index, thickness).moved((0.0, height + 0.9 * thickness, 0.0))
        parts.append((ring, checker((256, 256), (2, 12), paints(name, "cream"))))
        height += 1.75 * thickness
    pole = tube(np.array([[0, 0.05, 0], [0, height + 0.03, 0]]), 0.02)
    ball = sphere(0.045).moved((0.0, height + 0.05, 0.0))
    return [
        *parts,
        (pole, paint("cream")),
        (ball, stripes((64, 256), 8, paints("magenta", "amber"))),
    ]


def rainbow() -> list[Part]:
    """Four nested arches in the plane z = 0, with gaps between them to look through."""
    names = [("violet", "pink"), ("teal", "lime"), ("amber", "yellow"), ("red", "coral")]
    angle = np.linspace(np.pi, 0.0, 64)
    parts: list[Part] = []
    for index, (name, other) in enumerate(names):
        radius = 0.085 + 0.062 * index
        arch = np.stack([radius * np.cos(angle), 0.026 + radius * np.sin(angle), 0 * angle], -1)
        count = 6 + 4 * index
        pattern = checker((16 * count, 4), (count, 1), paints(name, other))
        parts.append((tube(arch, 0.025, sides=24), pattern))
    return parts


def beach_ball(radius: float = 0.15) -> list[Part]:
    """Six gores and two caps, leaning a little."""
    gores = stripes((256, 384), 6, paints("red", "white", "blue", "yellow", "teal", "orange"))
    v = (np.arange(256) + 0.5) / 256
    gores[(v < 0.08) | (v > 0.92)] = paint("white")
    gores[(np.abs(v - 0.08) < 0.012) | (np.abs(v - 0.92) < 0.012)] = paint("navy")
    lean = rotation_about("z", -28.0) @ rotation_about("y", 20.0)
    return [(sphere(radius, rows=64, columns=128).moved((0, radius, 0), rotation=lean), gores)]


def mug(*, seed: int) -> list[Part]:
    """A hollow mug in glazed tiles, with a handle towards +X."""
    wall = [(0, 0.035), (0.085, 0.035), (0.105, 0.06), (0.112, 0.235), (0.12, 0.25)]
    wall += [(0.134, 0.235), (0.13, 0.06), (0.115, 0), (0.115, 0), (0, 0)]
    profile = rounded_profile(wall, count=90)
    # The curve is evenly spaced, so rows of the texture are lengths along it: the rim first.
    rim = int(np.argmax(profile[:, 1])) / len(profile)
    tiles = painted_tiles(
        (192, 768),
        (2, 8),
        paints("white", "blue", "sky", "navy", "yellow"),
        paint("cream"),
        seed=seed,
    )
    texture = bands((512, 768), [rim - 0.02, rim + 0.02], paints("coral", "navy", "white"))
    start = int((rim + 0.02) * 512)
    texture[start : start + 192] = tiles
    curve = np.array(
        [[0.12, 0.2, 0], [0.185, 0.205, 0], [0.21, 0.13, 0], [0.18, 0.065, 0], [0.12, 0.06, 0]]
    )
    handle = tube(smooth_curve(curve, 40), 0.019)
    return [(lathe(profile), texture), (handle, paint("coral"))]


def blocks(*, seed: int) -> list[Part]:
    """Two building blocks and one across them."""
    tiles = paints("yellow", "green", "white", "magenta", "orange")
    faces: list[Color] = [
        painted_tiles((192, 192), (2, 2), tiles, paint("ink"), seed=seed),
        checker((64, 64), (4, 4), paints("violet", "amber")),
        stripes((64, 128), 10, paints("teal", "cream"), lean=4),
    ]
    cube = rounded_box((0.08, 0.08, 0.08), 0.015)
    beam = rounded_box((0.15, 0.05, 0.07), 0.015)
    return [
        (cube.moved((-0.1, 0.08, 0.01), rotation=rotation_about("y", 12.0)), faces[0]),
        (cube.moved((0.105, 0.08, 0.0), rotation=rotation_about("y", -20.0)), faces[1]),
        (beam.moved((0.0, 0.21, 0.0), rotation=rotation_about("y", 5.0)), faces[2]),
    ]


def spinning_top(*, seed: int) -> list[Part]:
    """Marbled, leaning as if it turned, on its tip."""
    profile = [
        (0, 0.27),
        (0.017, 0.27),
        (0.017, 0.255),
        (0.014, 0.18),
        (0.03, 0.165),
        (0.12, 0.135),
        (0.125, 0.115),
        (0.07, 0.055),
        (0.015, 0.012),
        (0, 0),
    ]
    colors = marble((192, 512), paints("magenta", "white", "violet", "amber"), seed=seed, veins=4)
    body = lathe(rounded_profile(profile))
    return placed([(body, colors)], rotation=rotation_about("z", 16.0) @ rotation_about("x", 9.0))


def caterpillar() -> list[Part]:
    """Balls in a wave along X, with eyes and two thin feelers."""
    names = ["lime", "green", "lime", "green", "lime"]
    parts: list[Part] = []
    for index, name in enumerate(names):
        radius = 0.045 + 0.004 * index
        at = (0.078 * (index - 2), radius, 0.022 * np.sin(1.7 * index))
        dots = checker((64, 128), (3, 10), paints(name, "yellow"))
        parts.append((sphere(radius, rows=32, columns=64).moved(at), dots))
    x, y, z = 0.25, 0.105, 0.03
    head = sphere(0.068, rows=40, columns=80).moved((x, y, z), rotation=rotation_about("z", -90.0))
    parts.append((head, bands((64, 8), [0.28, 0.34], paints("coral", "cream", "red"))))
    for side in (-1.0, 1.0):
        eye = sphere(0.017, rows=16, columns=32).moved((x + 0.052, y + 0.025, z + side * 0.03))
        feeler = smooth_curve(
            np.array(
                [
                    [x, y + 0.05, z + side * 0.02],
                    [x + 0.01, y + 0.11, z + side * 0.045],
                    [x + 0.045, y + 0.145, z + side * 0.06],
                ]
            ),
            16,
        )
        tip = sphere(0.017, rows=16, columns=32).moved((x + 0.045, y + 0.15, z + side * 0.06))
        parts += [(eye, paint("ink")), (tube(feeler, 0.008), paint("ink")), (tip, paint("amber"))]
    return parts


# The scene of the demo: painted toys on a round table, in the light of a low, warm sun.


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
    turned = [
        (0, 0.01),
        (0.04, 0.0),
        (0.042, -0.06),
        (0.02, -0.1),
        (0.046, -0.15),
        (0.02, -0.2),
        (0.03, -0.28),
        (0.022, -0.36),
        (0.038, -0.4),
        (0.03, -0.44),
        (0, -0.45),
    ]
    profile = rounded_profile([(float(r), float(y)) for r, y in turned])
    colors = paints("blue", "cream", "coral", "cream", "teal", "amber", "blue")
    edges = [0.2, 0.28, 0.42, 0.5, 0.72, 0.84]
    shape = lathe(profile, columns=32).moved((0, 0, 0.38), rotation=rotation_about("x", -8.0))
    return [(shape, bands((256, 8), edges, colors))]

"""Painted wooden toys, each standing on y = 0 around the Y axis, about 0.3 m large.

Most have a texture that tells every spot of them from its neighbours; some are hollow, have gaps to
look through, or thin parts that a coarse grid gets wrong.
"""

from __future__ import annotations

import numpy as np

from photograd.scenes.curves import smooth_curve
from photograd.scenes.lathe import lathe, rounded_profile
from photograd.scenes.paints import Color, paint, paints
from photograd.scenes.parts import Part, placed
from photograd.scenes.shapes import rounded_box, sphere, torus
from photograd.scenes.surface import rotation_about
from photograd.scenes.textures import bands, checker, marble, painted_tiles, stripes
from photograd.scenes.tube import tube


def ring_tower() -> list[Part]:
    """Five rings in the colours of the rainbow, checkered, on a pole with a ball on top."""
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
    curve = np.array([[0.12, 0.2, 0], [0.185, 0.205, 0], [0.21, 0.13, 0], [0.18, 0.065, 0],
                      [0.12, 0.06, 0]])  # fmt: skip
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
    profile = [(0, 0.27), (0.017, 0.27), (0.017, 0.255), (0.014, 0.18), (0.03, 0.165),
               (0.12, 0.135), (0.125, 0.115), (0.07, 0.055), (0.015, 0.012), (0, 0)]  # fmt: skip
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
            np.array([[x, y + 0.05, z + side * 0.02], [x + 0.01, y + 0.11, z + side * 0.045],
                      [x + 0.045, y + 0.145, z + side * 0.06]]), 16)  # fmt: skip
        tip = sphere(0.017, rows=16, columns=32).moved((x + 0.045, y + 0.15, z + side * 0.06))
        parts += [(eye, paint("ink")), (tube(feeler, 0.008), paint("ink")), (tip, paint("amber"))]
    return parts

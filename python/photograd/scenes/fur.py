"""A furry ball on its feet: thousands of strands thinner than a voxel of any grid used here."""

from __future__ import annotations

import numpy as np
from photograd_course import random

from photograd.scenes.daylight import blue_sky, warm_sun
from photograd.scenes.description import SceneDescription, bounds_of
from photograd.scenes.noise import fractal_noise
from photograd.scenes.paints import paint, paints, within_range
from photograd.scenes.parts import Part, as_meshes
from photograd.scenes.shapes import sphere
from photograd.scenes.surface import Surface, from_grid, joined
from photograd.scenes.textures import stripes
from photograd.types import FloatArray

_BODY = 0.38
_STRANDS = 4000
_POINTS = 5
_THICKNESS = 0.0045
"""Half the width of a strand at its root, in metres; at its tip it is a tenth of it."""


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
    """Strands that grow outwards and hang down, darker at the root, in patches of colour."""
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
    centre = 0.97 * _BODY * root + length * way * outward - 0.35 * length * way**2 * _UP
    side = np.cross(outward, _UP if abs(outward[1]) < 0.9 else np.array([1.0, 0.0, 0.0]))
    side /= np.linalg.norm(side)
    other = np.cross(outward, side)
    angle = 2.0 * np.pi * np.arange(3) / 3
    ring = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * other
    width = _THICKNESS * np.clip(1.0 - way, 0.1, None)
    points = centre[:, None] + width[:, None] * ring
    ends = [np.repeat(centre[k][None, None], 3, axis=1) for k in (0, -1)]
    return from_grid(np.concatenate([ends[0], points, ends[1]])[::-1], closed_columns=True)


_UP = np.array([0.0, 1.0, 0.0])


def _sphere_lattice(count: int) -> FloatArray:
    """(count, 3) evenly spread unit vectors [Gonzalez2010]."""
    height = 1.0 - 2.0 * (np.arange(count) + 0.5) / count
    angle = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    return np.stack([across * np.sin(angle), height, across * np.cos(angle)], axis=-1)

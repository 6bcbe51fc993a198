"""A carved cube, a ring of glass and a figure of clay: bodies of signed distances."""

from __future__ import annotations

import numpy as np

from photograd.geometry.sdf_shapes import (
    Shape,
    box,
    capsule,
    difference,
    intersection,
    placed,
    rounded_box,
    smooth_union,
    sphere,
    torus,
    union,
)
from photograd.lights import QuadLight
from photograd.transport.camera_place import camera_at
from photograd.transport.scene import Environment, Material, Scene
from photograd.transport.sdf_shape import SdfShape
from photograd.transport.shapes import rectangle

HALF = float(np.sqrt(0.5))
QUARTER = {"x": (HALF, HALF, 0, 0), "z": (HALF, 0, 0, HALF)}  # turns about an axis


def carved_cube() -> Shape:
    """A cube with corners cut by a ball, bored along all three axes, 0.5 m to each side."""
    rod = capsule(0.7, 0.27)
    bores = union(rod, placed(rod, quat=QUARTER["x"]), placed(rod, quat=QUARTER["z"]))
    return difference(intersection(rounded_box([0.5] * 3, 0.04), sphere(0.64)), bores)


def figure() -> Shape:
    """A body, a head and two arms, grown together; 1.1 m high."""
    arm = capsule(0.2, 0.09)
    arms = union(
        placed(arm, [0.33, 0.55, 0.1], [0.92, 0, 0.1, 0.38]),
        placed(arm, [-0.33, 0.55, 0.1], [0.92, 0, -0.1, -0.38]),
    )
    trunk = smooth_union(
        placed(capsule(0.2, 0.26), [0, 0.4, 0]), placed(sphere(0.2), [0, 0.9, 0]), 0.2
    )
    return intersection(smooth_union(trunk, arms, 0.18), placed(box([2, 1, 2]), [0, 1, 0]))


def carved(size: int = 256) -> Scene:
    """A bored cube, a figure of clay and a ring of glass on a table, none of them of triangles."""
    turned = placed(carved_cube(), [-1.05, 0.5, -0.1], [0.94, 0, 0.34, 0])
    ring = placed(torus(0.36, 0.15), [1.0, 0.5, 0.2], [0.66, 0.6, 0.3, 0.1])
    shapes = (
        rectangle("table", [-4, 0, 3], [8, 0, 0], [0, 0, -7], "table"),
        SdfShape("cube", turned, "bronze"),
        SdfShape("figure", placed(figure(), [0.05, 0.0, -0.3]), "clay"),
        SdfShape("ring", ring, "glass"),
    )
    materials = {
        "table": Material("lambert", {"albedo": [0.5, 0.48, 0.45]}),
        "bronze": Material("ggx_metal", {"f0": [0.85, 0.62, 0.4], "roughness": 0.3}),
        "clay": Material("lambert", {"albedo": [0.62, 0.34, 0.24]}),
        "glass": Material("glass", {"eta": 1.5, "tint": [1.0, 1.0, 1.0]}),
    }
    camera = camera_at([0.0, 1.3, 4.6], [0.0, 0.48, 0.0], 33.0, size, size)
    lamp = QuadLight([-2.6, 3.2, 1.4], [1.6, 0.0, 0.0], [0.0, -0.8, 1.0], [20.0, 18.5, 16.5])
    sky = Environment(np.array([0.3, 0.42, 0.6]), np.full(3, 0.25), np.full(3, 0.1))
    return Scene("carved", shapes, materials, camera, sky, (lamp,))

"""A carved cube, a ring of glass and a figure of clay: bodies of signed distances."""

from __future__ import annotations

import numpy as np

from photograd.geometry import sdf_shapes as sdf
from photograd.lights import QuadLight
from photograd.transport.camera_place import camera_at
from photograd.transport.scene import Environment, Material, Scene
from photograd.transport.sdf_shape import SdfShape
from photograd.transport.shapes import rectangle

HALF = float(np.sqrt(0.5))
QUARTER = {"x": (HALF, HALF, 0, 0), "z": (HALF, 0, 0, HALF)}  # turns about an axis


def carved_cube() -> sdf.Shape:
    """A cube with corners cut by a ball, bored along all three axes, 0.5 m to each side."""
    rod = sdf.capsule(0.7, 0.27)
    bores = sdf.union(rod, sdf.placed(rod, quat=QUARTER["x"]), sdf.placed(rod, quat=QUARTER["z"]))
    return sdf.difference(
        sdf.intersection(sdf.rounded_box([0.5] * 3, 0.04), sdf.sphere(0.64)), bores
    )


def figure() -> sdf.Shape:
    """A body, a head and two arms, grown together; 1.1 m high."""
    arm = sdf.capsule(0.2, 0.09)
    arms = sdf.union(
        sdf.placed(arm, [0.33, 0.55, 0.1], [0.92, 0, 0.1, 0.38]),
        sdf.placed(arm, [-0.33, 0.55, 0.1], [0.92, 0, -0.1, -0.38]),
    )
    trunk = sdf.smooth_union(
        sdf.placed(sdf.capsule(0.2, 0.26), [0, 0.4, 0]),
        sdf.placed(sdf.sphere(0.2), [0, 0.9, 0]),
        0.2,
    )
    return sdf.intersection(
        sdf.smooth_union(trunk, arms, 0.18), sdf.placed(sdf.box([2, 1, 2]), [0, 1, 0])
    )


def carved(size: int = 256) -> Scene:
    """A bored cube, a figure of clay and a ring of glass on a table, none of them of triangles."""
    turned = sdf.placed(carved_cube(), [-1.05, 0.5, -0.1], [0.94, 0, 0.34, 0])
    ring = sdf.placed(sdf.torus(0.36, 0.15), [1.0, 0.5, 0.2], [0.66, 0.6, 0.3, 0.1])
    shapes = (
        rectangle("table", [-4, 0, 3], [8, 0, 0], [0, 0, -7], "table"),
        SdfShape("cube", turned, "bronze"),
        SdfShape("figure", sdf.placed(figure(), [0.05, 0.0, -0.3]), "clay"),
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

"""A room with a picture on its back wall, a block of copper and a ball: the scene of W2 and W3.

Made so that another program can describe the same: docs/bench.md says what they measure.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd_course.suggest import choose_from

from photograd.errors import RangeError, message
from photograd.transport.builtin import camera_at
from photograd.transport.material import Material
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape, box, rectangle
from photograd.transport.texture import Texture, TextureUse
from photograd.types import Array

COPPER = {"eta": [0.2004, 0.9240, 1.1022], "k": [3.9129, 2.4528, 2.1421]}
ALUMINIUM = {"eta": [1.6574, 0.8803, 0.5212], "k": [9.2238, 6.2695, 4.8370]}
ALPHA = {"block": 0.2, "ball": 0.1}
"""Widths of the facets' slopes; the models' roughness is the root of them."""
BALLS = {
    "metal": Material("ggx_conductor", {**ALUMINIUM, "roughness": ALPHA["ball"] ** 0.5}),
    "principled": Material(
        "principled", {"base_color": [0.75, 0.45, 0.15], "metalness": 0.3, "roughness": 0.35}
    ),
}
"""What the ball may be made of."""


def wall_picture(size: int = 64) -> Array:
    """(size, size, 3) float32 albedo in 0.15..0.85: other ripples in each channel, row 0 on top."""
    c = (np.arange(size) + 0.5) / size
    v, u = np.meshgrid(c, c, indexing="ij")
    channels = [
        0.5
        + 0.25 * np.sin(2 * np.pi * (3 + k) * u)
        + 0.25 * np.sin(2 * np.pi * (4 - k) * v * (1 + u))
        for k in range(3)
    ]
    ripples = np.stack(channels, axis=-1).astype(np.float32)
    return (0.15 + 0.7 * ripples).astype(np.float32)


def metal_room(size: int = 256, ball: str = "principled") -> Scene:
    """The room, open towards the camera, for square pictures.

    Args:
        size: pixels along each side.
        ball: of `BALLS`.

    Raises:
        RangeError: another ball.
    """
    if ball not in BALLS:
        known = choose_from(ball, BALLS)
        raise RangeError(message("metal_room", "ball", "a material of BALLS", ball, known))
    materials = {
        "white": Material("lambert", {"albedo": [0.725, 0.71, 0.68]}),
        "red": Material("lambert", {"albedo": [0.63, 0.065, 0.05]}),
        "green": Material("lambert", {"albedo": [0.14, 0.45, 0.091]}),
        "black": Material("lambert", {"albedo": [0.0, 0.0, 0.0]}),
        "picture": Material(
            "lambert", {"albedo": [1.0, 1.0, 1.0]}, textures={"albedo": TextureUse("picture")}
        ),
        "block": Material("ggx_conductor", {**COPPER, "roughness": ALPHA["block"] ** 0.5}),
        "ball": BALLS[ball],
    }
    shapes = (
        rectangle("floor", [-1, -1, 1], [2, 0, 0], [0, 0, -2], "white"),
        rectangle("ceiling", [-1, 1, -1], [2, 0, 0], [0, 0, 2], "white"),
        rectangle("left", [-1, -1, 1], [0, 0, -2], [0, 2, 0], "red"),
        rectangle("right", [1, -1, -1], [0, 0, 2], [0, 2, 0], "green"),
        _back(),
        rectangle("lamp", [-0.25, 0.99, -0.25], [0.5, 0, 0], [0, 0, 0.5], "black", [15.0] * 3),
        box("block", [0.38, -0.4, -0.3], [0.6, 1.2, 0.6], "block", turn=18.0),
        _round("ball", [-0.42, -0.65, 0.3], 0.35),
    )
    picture = Texture(wall_picture(), ("clamp", "clamp"))
    # 39.3077 degrees wide, as the other programs have it.
    camera = camera_at([0.0, 0.0, 3.9], [0.0, 0.0, 0.0], 39.3077, size, size)
    return Scene("metal-room", shapes, materials, camera, textures={"picture": picture})


def _back() -> MeshShape:
    """The wall z = -1; v of its texture runs downwards."""
    plain = rectangle("back", [-1, -1, -1], [2, 0, 0], [0, 2, 0], "picture")
    uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)
    return MeshShape("back", plain.vertices, plain.faces, "picture", uv=uv)


def _round(name: str, center: Any, radius: float, nu: int = 64, nv: int = 32) -> MeshShape:
    """A ball of 2 nu (nv - 1) triangles with smooth normals; rings along y, then the poles."""
    theta = np.append(np.repeat(np.pi * np.arange(1, nv) / nv, nu), [0.0, np.pi])
    phi = np.append(np.tile(2 * np.pi * np.arange(nu) / nu, nv - 1), [0.0, 0.0])
    outward = np.stack(
        [np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], axis=-1
    )
    here = np.arange(nu)
    following = (here + 1) % nu
    ring = nu * np.arange(nv - 2)[:, None]
    a, b = ring + here, ring + following
    c, d = a + nu, b + nu
    last = (nv - 2) * nu
    north = np.full(nu, (nv - 1) * nu)
    faces = np.concatenate(
        [
            np.stack([a, b, c], -1).reshape(-1, 3),
            np.stack([b, d, c], -1).reshape(-1, 3),
            np.stack([north, following, here], -1),
            np.stack([north + 1, last + here, last + following], -1),
        ]
    )
    vertices = radius * outward + np.asarray(center)
    return MeshShape(name, vertices, faces, "ball", normals=outward)

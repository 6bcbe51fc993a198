"""Normal maps and brushed metal: frames that follow the texture coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.transport import Material, MeshShape, NormalMap, PathOptions, PathTracer, Scene
from photograd.transport.shapes import rectangle

from tests.transport.scenes import BLACK, view
from tests.transport.test_textures import BARE, WALL, wall


def lit(bent: NormalMap | None, towards: Any) -> float:
    """How bright a gray wall is under one far, small light."""
    camera = view(4, (0.0, 0.0, 3.0), (0.0, 0.0, 0.0))
    wall_shape = rectangle("wall", *WALL, "wall")
    direction = np.array(towards) / np.linalg.norm(towards)
    across = np.cross(direction, [0.3, 0.5, 0.7])
    across /= np.linalg.norm(across)
    middle, other = 60 * direction, np.cross(direction, across)
    lamp = rectangle("lamp", middle - 0.5 * (across + other), other, across, "black", [1e4] * 3)
    gray = Material("lambert", {"albedo": [0.5] * 3}, {}, bent)
    scene = Scene("s", (wall_shape, lamp), {"wall": gray, "black": BLACK}, camera)
    options = PathOptions("light", max_depth=2)
    return float(PathTracer(scene).render(spp=16, seed=1, options=options).mean.mean())


def test_normal_maps_turn_the_cosine() -> None:
    tilt = np.array([0.3, 0.4, np.sqrt(0.75)])  # along u, against v, outwards: +x, +y, +z here
    bent = NormalMap(np.broadcast_to(tilt, (2, 2, 3)).copy())
    flat = NormalMap(np.broadcast_to([0.0, 0.0, 1.0], (2, 2, 3)).copy())
    for towards in ([0.0, 0.0, 1.0], [0.5, 0.1, 0.8], [-0.2, 0.6, 0.7]):
        way = np.array(towards) / np.linalg.norm(towards)
        plain = lit(None, towards)
        assert plain > 0.1
        assert lit(flat, towards) == pytest.approx(plain, rel=1e-5)
        ratio = float(way @ tilt) / way[2]
        assert lit(bent, towards) / plain == pytest.approx(ratio, rel=1e-3)  # measured: 3e-4


def test_bent_normals_gain_no_light() -> None:
    # White under an even sky of 1: never brighter than 1, however wildly the normals lean.
    g = np.random.default_rng(4)
    lean, turn = np.radians(g.uniform(0, 75, (16, 16))), g.uniform(0, 2 * np.pi, (16, 16))
    tilts = [np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)]
    white = Material("lambert", {"albedo": [1.0] * 3}, {}, NormalMap(np.stack(tilts, axis=-1)))
    for options in (BARE, PathOptions()):
        found = PathTracer(wall(white, {}, 16)).render(spp=256, seed=2, options=options)
        noise_of_pixel = found.standard_error
        assert (found.mean <= 1 + 5 * noise_of_pixel + 1e-4).all()
        assert 0.6 < found.mean.mean() < 0.99


def brushed(turned: bool, rotation: float) -> Any:
    """A brushed wall between two lights, and the noise; its u runs along x, or along y."""
    metal = {"f0": [0.9, 0.7, 0.5], "roughness": 0.3, "anisotropy": 0.8, "rotation": rotation}
    shape = rectangle("wall", *WALL, "wall")
    if turned:
        uv = np.asarray(shape.uv)[:, ::-1] * [-1.0, 1.0]
        shape = MeshShape("wall", shape.vertices, shape.faces, "wall", uv=uv)
    lamp = rectangle("lamp", [1.2, -0.3, 1.0], [0, 0, 0.6], [0, 0.6, 0], "black", [9.0] * 3)
    materials = {"wall": Material("ggx_anisotropic", metal), "black": BLACK}
    camera = view(6, (0.0, 0.0, 3.0), (0.0, 0.0, 0.0))
    sums = PathTracer(Scene("s", (shape, lamp), materials, camera)).render(
        spp=512, seed=1, options=PathOptions(max_depth=2)
    )
    return sums.mean, sums.standard_error


def test_brushed_metal_follows_the_texture() -> None:
    # Coordinates turned by a right angle are a turned brush: (u, v) = (-v, u) has u along -y or y.
    plain, noise_of_plain = brushed(False, 0.0)
    turned, noise_of_turned = brushed(True, 0.0)
    by_parameter, noise_of_parameter = brushed(False, np.pi / 2)
    error = np.hypot(noise_of_turned, noise_of_parameter) + 1e-6
    assert (np.abs(turned - by_parameter) < 5 * error).all()
    assert (np.abs(turned - plain) > 8 * np.hypot(noise_of_turned, noise_of_plain)).any()

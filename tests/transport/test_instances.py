"""One mesh at several places: the picture and the derivatives of as many meshes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.transport import (
    Environment,
    Material,
    MeshShape,
    NormalMap,
    PathOptions,
    PathTracer,
    Scene,
    Texture,
    TextureUse,
)
from photograd.transport.mesh_files.model_file import moved
from photograd.transport.shapes import rectangle
from photograd_course.gradcheck import check_gradient

from tests.transport.scenes import FLOOR, GRAY, view
from tests.transport.test_adjoint import proof


def dome() -> tuple[Any, Any, Any, Any]:
    """A coarse half ball with smooth normals and coordinates."""
    up, round_ = np.meshgrid(np.linspace(0.15, 1.4, 4), np.linspace(0, 2 * np.pi, 9), indexing="ij")
    ball = np.stack([np.sin(up) * np.sin(round_), np.cos(up), np.sin(up) * np.cos(round_)], axis=-1)
    number = np.arange(36).reshape(4, 9)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    faces = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    uv = np.stack([round_ / (2 * np.pi), up / 1.4], axis=-1).reshape(-1, 2)
    points = ball.reshape(-1, 3)
    return 0.4 * points, faces, points, uv


def place(x: float, z: float, turn: float, size: Any) -> Any:
    c, s = np.cos(turn), np.sin(turn)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) * np.asarray(size, float)
    matrix[:3, 3] = [x, 0.05, z]
    return matrix


PLACES = (place(-0.6, 0.0, 0.3, [1, 1, 1]), place(0.5, -0.3, 1.2, [0.7, 1.6, 1.0]))


def scenes(size: int) -> tuple[Scene, Scene]:
    """Instances, and the same meshes moved one by one."""
    values = np.random.default_rng(1).uniform(0.3, 0.9, (4, 6, 3))
    tilt = NormalMap(np.broadcast_to([0.2, 0.1, 1.0], (2, 2, 3)).copy())
    gloss = Material(
        "gltf",
        {"base_color": [1.0] * 3, "metalness": 0.3, "roughness": 0.4},
        {"base_color": TextureUse("paint")},
        tilt,
    )
    materials = {"gloss": gloss, "gray": GRAY}
    floor = rectangle("floor", *FLOOR, "gray")
    vertices, faces, normals, uv = dome()
    glow = np.array([0.5, 0.4, 0.3])
    one = MeshShape("dome", vertices, faces, "gloss", glow, normals, uv, PLACES)
    apart = []
    for number, matrix in enumerate(PLACES):
        parts = moved((vertices, faces, normals, uv), matrix)
        apart.append(MeshShape(f"dome {number}", *parts[:2], "gloss", glow, *parts[2:]))
    camera = view(size, (0.0, 1.4, 3.0), (0.0, 0.2, 0.0))
    sky = Environment(np.full(3, 0.9), np.full(3, 0.5), np.full(3, 0.1))
    paint = {"paint": Texture(values)}
    together = Scene("together", (one, floor), materials, camera, sky, textures=paint)
    return together, replace(together, name="apart", shapes=(*apart, floor))


def test_instances_look_like_meshes_of_their_own() -> None:
    options = PathOptions(max_depth=4, roulette_from=None, sampler="independent")
    together, apart = (PathTracer(scene, dtype=np.float64) for scene in scenes(24))
    a, b = (t.render(spp=16, seed=1, options=options).mean for t in (together, apart))
    # Transformed in float by one, in double by the other: single paths fall the other way.
    same = np.isclose(a, b, rtol=1e-3, atol=1e-4).all(axis=2)
    assert same.mean() > 0.9
    assert a.mean(axis=(0, 1)) == pytest.approx(b.mean(axis=(0, 1)), rel=2e-3)
    d = np.ones((24, 24, 3)) / 576
    g, h = (t.render_backward(d, spp=16, seed=1, options=options) for t in (together, apart))
    shared = ("textures.paint", "materials.gloss.roughness", "materials.gray.albedo")
    for name in shared:
        assert np.linalg.norm(h[name]) > 1e-3
        assert np.linalg.norm(g[name] - h[name]) < 0.02 * np.linalg.norm(h[name])
    assert (g["emission.dome"] > 0.01).all()
    both = h["emission.dome 0"] + h["emission.dome 1"]
    np.testing.assert_allclose(g["emission.dome"], both, rtol=0.01)
    np.testing.assert_allclose(
        together.scene.shapes[0].box,
        np.array(
            [
                np.min([s.box[0] for s in apart.scene.shapes[:2]], axis=0),
                np.max([s.box[1] for s in apart.scene.shapes[:2]], axis=0),
            ]
        ),
        atol=0.12,
    )  # the box of a turned box is larger


def test_their_derivatives() -> None:
    function, backward, start = proof(scenes(6)[0])
    report = check_gradient(function, backward, start, seed=2, coordinates=3, directions=3)
    assert report, str(report)


def test_wrong_places_are_refused() -> None:
    vertices, faces, normals, uv = dome()
    for matrix, error, words in (
        (np.diag([1.0, 1, -1, 1]), RangeError, "a positive determinant"),
        (np.diag([1.0, 1, 0, 1]), RangeError, "a positive determinant"),
        (np.eye(3), ShapeError, r"expected shape \(4, 4\)"),
        (np.full((4, 4), np.nan), RangeError, "finite"),
    ):
        with pytest.raises(error, match=words):
            MeshShape("d", vertices, faces, "gray", np.zeros(3), normals, uv, (matrix,))
    with pytest.raises(ShapeError, match=r"d\.uv"):
        MeshShape("d", vertices, faces, "gray", np.zeros(3), normals, uv[:3])

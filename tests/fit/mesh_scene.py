"""A cube with a smooth texture, and photographs of it that its own renderer has taken."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.view import View
from photograd.fields import TexturedMesh
from photograd.fields.textured_mesh import MeshPolicy
from photograd.fitting.evaluate import render_camera
from photograd.fitting.model import Model
from photograd.geometry.mesh import Mesh
from photograd_course.color import srgb_encode, unpremultiply

from tests.fit import scene

HALF = 0.4  # m


@cache
def cube() -> Mesh:
    """Six faces, each with a rectangle of the texture, 3 x 2 of them."""
    vertices, faces, uv = [], [], []
    for number in range(6):
        axis, sign = number // 2, 2 * (number % 2) - 1
        column, row = number % 3, number // 3
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            corner = np.empty(3)
            corner[axis], corner[axis - 2], corner[axis - 1] = sign, a, b
            vertices.append(HALF * corner)
            uv.append([(column + 0.5 + 0.4 * a) / 3, (row + 0.5 + 0.4 * b) / 2])
        faces += [[4 * number + k for k in part] for part in ((0, 1, 2), (0, 2, 3))]
    return Mesh(np.array(vertices), np.array(faces), np.array(uv))


@cache
def truth() -> Model:
    """24 x 24 texels: waves, other ones in each channel."""
    v, u = np.meshgrid(*[(np.arange(24) + 0.5) / 24] * 2, indexing="ij")
    texels = [2 * np.sin(5 * u + k) * np.cos(4 * v - k) for k in range(3)]
    return Model.of(
        TexturedMesh(np.stack(texels, -1).astype(np.float32), cube(), MeshPolicy(0.0303))
    )


def photograph(camera: Camera) -> Any:
    """(H, W, 4) float32, display-encoded, straight alpha."""
    color, opacity, _ = render_camera(truth(), camera)
    straight = np.clip(srgb_encode(unpremultiply(color, opacity)), 0, 1)
    return np.concatenate([straight, opacity[..., None]], axis=-1).astype(np.float32)


@cache
def capture() -> Capture:
    """Ten training views, two held out."""
    views = [
        View(f"view_{k}", camera, photograph(camera))
        for k, camera in enumerate(
            scene.cameras(6, elevation=40.0)
            + scene.cameras(4, elevation=-35.0)
            + scene.cameras(2, elevation=10.0)
        )
    ]
    return Capture(
        tuple(views[:10]),
        tuple(views[10:]),
        "memory",
        Path("memory"),
        "display",
        True,  # alpha
        bounds=scene.BOX,
    )


def write_obj(path: Path, mesh: Mesh) -> Path:
    """The mesh as a file; its v is upwards."""
    assert mesh.uv is not None
    lines = [f"v {x} {y} {z}" for x, y, z in mesh.vertices.tolist()]
    lines += [f"vt {u} {1 - v}" for u, v in mesh.uv.tolist()]
    lines += ["f " + " ".join(f"{k}/{k}" for k in face) for face in (mesh.faces + 1).tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path

"""Gaussians as glTF with KHR_gaussian_splatting, read back with pygltflib.

SplatTransform 2.7.1 writes the same numbers from the same .ply file, but for half a turn about the
vertical axis: of biker.ply scales, opacities and coefficients of degree 0 to the bit.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
import pytest
import trimesh
from photograd import sh
from photograd.splats.coding import opacity_of
from photograd.splats.files import write_gaussians
from photograd.splats.frames import half_turn
from photograd.splats.splatting import Gaussians, render

from tests.splat import oracle

KHR = "KHR_gaussian_splatting"


def attributes(path: Path) -> tuple[Any, dict[str, Any]]:
    """The primitive, and its attributes as arrays."""
    file = pygltflib.GLTF2().load(str(path))
    part = json.loads(file.gltf_to_json())["meshes"][0]["primitives"][0]
    blob = file.binary_blob()
    found = {}
    for name, number in part["attributes"].items():
        accessor = file.accessors[number]
        view = file.bufferViews[accessor.bufferView]
        columns = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
        assert accessor.componentType == pygltflib.FLOAT
        rows = np.frombuffer(blob, "<f4", accessor.count * columns, view.byteOffset)
        found[name] = rows.reshape(accessor.count, columns)
    return part, found


def harmonics(highest: int) -> list[str]:
    """Names of the attributes up to a degree, in the order of the coefficients."""
    degrees = [degree for degree in range(highest + 1) for _ in range(2 * degree + 1)]
    return [
        f"{KHR}:SH_DEGREE_{degree}_COEF_{k - degree * degree}" for k, degree in enumerate(degrees)
    ]


@pytest.mark.parametrize("degree", [0, 2, 3])
def test_attributes_are_those_of_the_extension(tmp_path: Path, degree: int) -> None:
    g = oracle.cloud(50, 1, degree=degree).astype(np.float32)
    write_gaussians(tmp_path / "a.glb", g)
    part, found = attributes(tmp_path / "a.glb")
    assert part["mode"] == 0
    assert part["extensions"][KHR] == {
        "kernel": "ellipse",
        "colorSpace": "srgb_rec709_display",
        "sortingMethod": "cameraDistance",
        "projection": "perspective",
    }
    np.testing.assert_array_equal(found["POSITION"], g.means * [1, -1, -1])  # +y up
    np.testing.assert_allclose(found[f"{KHR}:SCALE"], np.exp(g.log_scales), rtol=1e-6)
    alpha = opacity_of(g.opacity_logits)
    np.testing.assert_allclose(found[f"{KHR}:OPACITY"][:, 0], alpha, rtol=1e-6)
    np.testing.assert_allclose(found["COLOR_0"][:, 3], alpha, rtol=1e-6)
    assert ((found["COLOR_0"] >= 0) & (found["COLOR_0"] <= 1)).all()
    assert set(harmonics(degree)) == {name for name in found if "SH_DEGREE" in name}


def test_the_harmonics_of_the_file_show_the_colors_that_were_fitted(tmp_path: Path) -> None:
    """Evaluated by the functions of the extension, written out here with their signs.

    Its draft prints z (2 z^2 - 3 x - 3 y) for degree 3, order 0: the basis would not be orthogonal.
    """
    g = oracle.cloud(20, 3, degree=3).astype(np.float32)
    write_gaussians(tmp_path / "a.glb", g)
    _, found = attributes(tmp_path / "a.glb")
    d = np.array([0.48, -0.6, 0.64])
    x, y, z = d
    basis = {
        (0, 0): 0.2820947917738781,
        (1, 0): -0.4886025119029199 * y,
        (1, 1): 0.4886025119029199 * z,
        (1, 2): -0.4886025119029199 * x,
        (2, 0): 1.092548430592079 * x * y,
        (2, 1): -1.092548430592079 * y * z,
        (2, 2): 0.3153915652525200 * (2 * z * z - x * x - y * y),
        (2, 3): -1.092548430592079 * x * z,
        (2, 4): 0.5462742152960395 * (x * x - y * y),
        (3, 0): -0.5900435899266435 * y * (3 * x * x - y * y),
        (3, 1): 2.890611442640554 * x * y * z,
        (3, 2): -0.4570457994644657 * y * (4 * z * z - x * x - y * y),
        (3, 3): 0.3731763325901154 * z * (2 * z * z - 3 * x * x - 3 * y * y),
        (3, 4): -0.4570457994644657 * x * (4 * z * z - x * x - y * y),
        (3, 5): 1.445305721320277 * z * (x * x - y * y),
        (3, 6): -0.5900435899266435 * x * (x * x - 3 * y * y),
    }
    color = sum(
        value * found[f"{KHR}:SH_DEGREE_{degree}_COEF_{n}"] for (degree, n), value in basis.items()
    )
    before = np.array([1, -1, -1]) * d  # the same direction, in the frame of .ply files
    expected = np.einsum("k,nkc->nc", sh.basis(before[None], 3)[0], g.sh.astype(np.float64))
    np.testing.assert_allclose(color, expected, atol=1e-5)
    assert np.abs(expected).max() > 0.3


def test_a_turned_camera_sees_the_same(tmp_path: Path) -> None:
    g, camera = oracle.cloud(40, 1, degree=3).astype(np.float32), oracle.camera()
    write_gaussians(tmp_path / "a.gltf", g)
    _, found = attributes_of_gltf(tmp_path / "a.gltf")
    with np.errstate(divide="ignore"):
        logits = np.log(found[f"{KHR}:OPACITY"][:, 0]) - np.log1p(-found[f"{KHR}:OPACITY"][:, 0])
    read = Gaussians(
        found["POSITION"],
        np.log(found[f"{KHR}:SCALE"]),
        found[f"{KHR}:ROTATION"][:, [3, 0, 1, 2]],
        logits,
        np.stack([found[name] for name in harmonics(3)], axis=1),
    )
    pose = camera.world_from_camera.copy()
    pose[:3] = np.diag([1.0, -1, -1]) @ pose[:3]
    ours = render(g, camera)[0].color
    theirs = render(read, replace(camera, world_from_camera=pose))[0].color
    assert np.abs(ours - theirs).max() < 1e-4
    assert ours.max() > 0.3


def attributes_of_gltf(path: Path) -> tuple[Any, dict[str, Any]]:
    """The same of a .gltf file, whose bytes lie in it."""
    file = pygltflib.GLTF2().load(str(path))
    file.convert_buffers(pygltflib.BufferFormat.BINARYBLOB)
    file.save(str(path.with_suffix(".glb")))
    return attributes(path.with_suffix(".glb"))


def test_what_knows_no_gaussians_sees_points(tmp_path: Path) -> None:
    g = oracle.cloud(50, 1).astype(np.float32)
    write_gaussians(tmp_path / "a.glb", g)
    points = trimesh.load(tmp_path / "a.glb", force="scene").geometry["gaussians"]
    np.testing.assert_allclose(points.vertices, half_turn(g).means, atol=1e-6)

"""Meshes of fields: closed, in the right place, outwards, and of the colors that were there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
import pytest
import trimesh
from photograd.errors import DtypeError, IoError, RangeError
from photograd.fields import HashGrid
from photograd.fields.tabulate import radiance_of
from photograd.fitting import Model
from photograd.fitting.isosurface import ColoredMesh, extract_mesh
from photograd.fitting.mesh_files import write_colored_mesh
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import Gaussians
from photograd_course.color import srgb_encode
from plyfile import PlyData

from tests.fit import scene

pytestmark = pytest.mark.usefixtures("core")


@pytest.fixture(scope="module")
def balls() -> ColoredMesh:
    """Three balls of extinction 40/m, cut where it is 20/m: at their radii."""
    return extract_mesh(Model.of(scene.truth()), level=20.0)


def test_the_surface_is_that_of_the_balls(balls: ColoredMesh) -> None:
    distance = np.stack([np.linalg.norm(balls.vertices - c, axis=1) - r for c, r, _ in scene.BALLS])
    nearest = np.abs(distance).min(axis=0)
    assert nearest.max() < 0.008  # of voxels of 0.05; measured 0.0048
    mesh = trimesh.Trimesh(balls.vertices, balls.faces, process=False)
    assert mesh.is_watertight
    assert mesh.body_count == 3
    volume = sum(4 / 3 * np.pi * r**3 for _, r, _ in scene.BALLS)
    assert mesh.volume == pytest.approx(volume, rel=0.03)  # corners are cut off
    own = np.argmin(np.abs(distance), axis=0)
    outward = balls.vertices - np.array([c for c, _, _ in scene.BALLS])[own]
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    assert (outward * balls.normals).sum(axis=1).min() > 0.85  # measured 0.90


def test_colors_are_those_of_the_balls(balls: ColoredMesh) -> None:
    distance = [np.abs(np.linalg.norm(balls.vertices - c, axis=1) - r) for c, r, _ in scene.BALLS]
    own = np.argmin(distance, axis=0)
    expected = srgb_encode(np.array([color for _, _, color in scene.BALLS]))[own]
    off = np.abs(balls.colors - expected).max(axis=1)
    assert np.quantile(off, 0.99) < 0.004  # measured 0.0019; more where two balls nearly touch
    assert off.mean() < 3e-4  # measured 1.1e-4


def glb_rows(path: Path, name: str) -> Any:
    """An attribute (V, 3) of the only mesh of a .glb file."""
    file = pygltflib.GLTF2().load(str(path))
    accessor = file.accessors[file.meshes[0].primitives[0].attributes.__dict__[name]]
    start = file.bufferViews[accessor.bufferView].byteOffset
    rows = np.frombuffer(file.binary_blob(), "<f4", 3 * accessor.count, start)
    return rows.reshape(-1, 3).astype(np.float64)


def test_files_are_read_by_trimesh(balls: ColoredMesh, tmp_path: Path) -> None:
    for name in ("a.ply", "a.glb"):
        write_colored_mesh(tmp_path / name, balls)
        found: Any = trimesh.load(tmp_path / name, force="mesh", process=False)
        np.testing.assert_allclose(found.vertices, balls.vertices, atol=1e-6)
        np.testing.assert_array_equal(found.faces, balls.faces)
        if name == "a.ply":
            colors = found.visual.vertex_colors[:, :3] / 255
            vertex = PlyData.read(str(tmp_path / name))["vertex"]  # trimesh leaves normals aside
            normals = np.stack([vertex[axis] for axis in ("nx", "ny", "nz")], axis=1)
        else:  # linear, in float32
            normals = glb_rows(tmp_path / name, "NORMAL")
            colors = srgb_encode(glb_rows(tmp_path / name, "COLOR_0"))
        np.testing.assert_allclose(normals, balls.normals, atol=1e-5)
        assert np.abs(colors - balls.colors).max() < 0.51 / 255
    with pytest.raises(IoError, match=r"ends in \.ply or \.glb"):
        write_colored_mesh(tmp_path / "a.obj", balls)


def test_networks_are_asked_at_points() -> None:
    field = HashGrid.example(seed=1, dtype=np.float32)
    mesh = extract_mesh(Model.of(field), resolution=40, level=0.3)
    assert len(mesh.faces) > 200
    sigma_t, _ = radiance_of(field, 0.01)(mesh.vertices, mesh.normals)
    middle, half = field.box.mean(axis=0), 0.45 * np.ptp(field.box, axis=0)
    inner = (np.abs(mesh.vertices - middle) < half).all(axis=1)  # where the box cuts nothing off
    assert inner.sum() > 20
    assert np.abs(sigma_t[inner] - 0.3).max() < 0.02


def test_depths_of_gaussians_are_fused() -> None:
    """Opaque Gaussians on a sphere of radius 0.5, red above and green below."""
    k = np.arange(1200)
    height = (2 * k + 1) / 1200 - 1
    turn = np.pi * (3 - np.sqrt(5)) * k
    level = np.sqrt(1 - height**2)
    means = 0.5 * np.stack([level * np.cos(turn), height, level * np.sin(turn)], axis=1)
    color = np.where(means[:, 1:2] > 0, [0.9, 0.1, 0.1], [0.1, 0.7, 0.1])
    gaussians = Gaussians(
        means.astype(np.float32),
        np.full((1200, 3), np.log(0.03), np.float32),
        np.tile(np.array([1, 0, 0, 0], np.float32), (1200, 1)),
        np.full(1200, 4.0, np.float32),
        ((color - 0.5) / 0.2820948)[:, None].astype(np.float32),
    )
    model = Model.of(GaussianScene(gaussians, extent=1.0))
    mesh = extract_mesh(model, resolution=32)
    assert trimesh.Trimesh(mesh.vertices, mesh.faces).is_watertight
    radius = np.linalg.norm(mesh.vertices, axis=1)
    assert 0.47 < radius.mean() < 0.56
    assert radius.std() < 0.02
    assert (mesh.normals * mesh.vertices).sum(axis=1).min() > 0.2
    far = np.abs(mesh.vertices[:, 1]) > 0.15
    above = mesh.vertices[far, 1] > 0
    assert ((mesh.colors[far, 0] > mesh.colors[far, 1]) == above).mean() > 0.99
    with pytest.raises(RangeError, match="no level for gaussians, whose depths are fused"):
        extract_mesh(model, level=3.0)


def test_what_has_no_surface_is_refused() -> None:
    model = Model.of(scene.truth())
    with pytest.raises(RangeError, match=r"expected a level between 0 and .*, got 1000"):
        extract_mesh(model, level=1000.0)
    with pytest.raises(RangeError, match="resolution"):
        extract_mesh(model, resolution=4)
    with pytest.raises(DtypeError, match="load_model reads one"):
        extract_mesh(model.field)  # type: ignore[arg-type]

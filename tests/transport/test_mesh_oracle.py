"""Our readers of meshes against trimesh, on random meshes that both can read."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from photograd.transport import read_model

from support.missing import need_module
from tests.transport.test_mesh_files import corners

trimesh = need_module("trimesh")


def random_mesh(seed: int, textured: bool) -> Any:
    g = np.random.default_rng(seed)
    vertices = g.normal(size=(40, 3)).astype(np.float32)
    faces = np.array([g.choice(40, 3, replace=False) for _ in range(60)])
    visual = trimesh.visual.TextureVisuals(uv=g.random((40, 2))) if textured else None
    return trimesh.Trimesh(vertices, faces, visual=visual, process=False)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["m.obj", "m.ply", "t.ply", "m.stl", "t.stl"])
def test_triangles_are_those_that_were_written(tmp_path: Path, name: str, seed: int) -> None:
    mesh = random_mesh(seed, textured=name == "m.obj")
    kind = {"t.ply": "ply", "t.stl": "stl_ascii"}.get(name, name[2:])
    more = {"encoding": "ascii"} if name == "t.ply" else {}
    if kind == "obj":
        more = {"include_texture": False, "digits": 9}
    data = mesh.export(file_type=kind, **more)
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    shape = read_model(path).shapes[0]
    theirs = trimesh.load(path, process=False)
    # Texts have eight digits.
    np.testing.assert_array_equal(rounded(shape), rounded(theirs))


def rounded(mesh: Any) -> Any:
    """(60, 3, 3) corners of its triangles, in the order of the smallest; each keeps its turn."""
    vertices = np.asarray(mesh.vertices, np.float64).round(5) + 0.0
    return corners(SimpleNamespace(shapes=[SimpleNamespace(vertices=vertices, faces=mesh.faces)]))

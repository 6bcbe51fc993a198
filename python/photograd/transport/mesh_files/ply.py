"""Meshes in .ply files, text or binary."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from photograd._ply import read_ply
from photograd.errors import IoError, SceneError, message
from photograd.transport.mesh_files.container import NAME
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.mesh_files.simple_formats import (
    GRAY,
    Note,
    finite_or_none,
    model_of_meshes,
)
from photograd.types import Array


def read_ply_mesh(path: Path, note: Note) -> ModelFile:
    """Vertices, faces and, if there are any, normals and texture coordinates.

    Args:
        path: of the file.
        note: called with sentences.

    Raises:
        IoError: a damaged file.
        SceneError: no faces; 3D Gaussians have none.
    """
    elements = read_ply(NAME, path)
    names = set(elements["vertex"].dtype.names or ()) if "vertex" in elements else set()
    if "face" not in elements and names & {"scale_0", "packed_scale"}:
        remedy = "'photograd render' draws them"
        raise SceneError(message(NAME, f"{path}", "a mesh", "3D Gaussians", remedy))
    for element in ("vertex", "face"):
        if element not in elements:
            raise SceneError(message(NAME, f"{path}", f"an element '{element}'", sorted(elements)))
    vertices = _columns(path, elements["vertex"], ("x", "y", "z"))
    if vertices is None:
        raise IoError(message(NAME, f"{path}", "numbers x, y and z for each vertex", "none"))
    normals = _columns(path, elements["vertex"], ("nx", "ny", "nz"))
    pairs = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
    found = [_columns(path, elements["vertex"], pair) for pair in pairs]
    uv = next((pair for pair in found if pair is not None), None)
    if uv is not None:
        uv = uv * np.array([1, -1], np.float32) + np.array([0, 1], np.float32)  # v downwards
    arrays = (vertices, _fans(path, elements["face"]), finite_or_none(normals), finite_or_none(uv))
    return model_of_meshes(path, [(path.stem, arrays, "gray")], {"gray": GRAY}, {}, note)


def _columns(path: Path, table: Array, names: tuple[str, ...]) -> Array | None:
    """(rows, names) float32, or None unless all are there."""
    if not set(names).issubset(table.dtype.names or ()):
        return None
    if any(table.dtype[name].kind not in "fiu" for name in names):
        raise IoError(message(NAME, f"{path}", f"numbers {', '.join(names)}", "lists"))
    with np.errstate(over="ignore", invalid="ignore"):
        return np.stack([table[name].astype(np.float32) for name in names], axis=1)


def _fans(path: Path, table: Array) -> Array:
    """(F, 3) int64: polygons as fans around their first corner."""
    known = [
        name for name in ("vertex_indices", "vertex_index") if name in (table.dtype.names or ())
    ]
    if not known or table.dtype[known[0]].kind != "O":
        raise IoError(message(NAME, f"{path}", "a list 'vertex_indices' for each face", "none"))
    polygons = [np.asarray(row).reshape(-1) for row in table[known[0]]]
    if any(row.dtype.kind not in "iu" for row in polygons):
        raise IoError(message(NAME, f"{path}", "whole vertex numbers", "others"))
    lengths = np.array([len(row) for row in polygons], np.int64)
    faces = [np.empty((0, 3), np.int64)]
    for length in np.unique(lengths[lengths >= 3]):
        rows = np.stack([polygons[i] for i in np.flatnonzero(lengths == length)]).astype(np.int64)
        faces += [rows[:, [0, k, k + 1]] for k in range(1, int(length) - 1)]
    return np.concatenate(faces)

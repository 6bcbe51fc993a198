"""Triangles in .stl files: 50 bytes each, or, to be read alone, a text of lines "vertex"."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write
from photograd_course.input_files import read_file

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import IoError, message
from photograd.transport.mesh_files.container import NAME
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.mesh_files.simple_formats import GRAY, Note, model_of_meshes
from photograd.types import Array

_HEADER = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_CORNER = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_stl(path: Path, note: Note) -> ModelFile:
    """The triangles of a file; its normals and attributes are left out.

    Args:
        path: of the file.
        note: called with sentences.

    Raises:
        IoError: neither of the two layouts.
        SceneError: no triangle.
    """
    data = read_file(NAME, path)
    count = int.from_bytes(data[80:_HEADER], "little")
    if len(data) >= _HEADER and len(data) == _HEADER + count * _TRIANGLE.itemsize:
        corners = np.frombuffer(data, _TRIANGLE, count, _HEADER)["corners"].reshape(-1, 3)
    elif data[:5].lower() == b"solid":
        corners = _text(path, data)
    else:
        expected = f"{_HEADER} + 50 x {count} bytes, as its header says, or text"
        raise IoError(message(NAME, f"{path}", expected, f"{len(data)} bytes"))
    faces = np.arange(len(corners)).reshape(-1, 3)
    arrays = (np.array(corners, np.float32), faces, None, None)
    return model_of_meshes(path, [(path.stem, arrays, "gray")], {"gray": GRAY}, {}, note)


def _text(path: Path, data: bytes) -> Array:
    try:
        with np.errstate(over="ignore"):
            rows = [[float(word) for word in found] for found in _CORNER.findall(data)]
    except ValueError as failure:
        got = " ".join(str(failure).split())[:80]
        raise IoError(message(NAME, f"{path}", "three numbers for each vertex", got)) from failure
    if len(rows) % 3:
        raise IoError(message(NAME, f"{path}", "three corners for each triangle", len(rows)))
    with np.errstate(over="ignore"):
        return np.array(rows, np.float64).reshape(-1, 3).astype(np.float32)


@typed_call
def write_stl(path: Path, vertices: Array, faces: Array) -> None:
    """Write triangles as a binary .stl file, atomically.

    Args:
        path: of the file.
        vertices: (V, 3). The format has no unit; 3D printers take millimeters.
        faces: (F, 3) vertex numbers, counter-clockwise seen from outside.

    Raises:
        ShapeError, RangeError: arrays of other shapes, numbers that are not finite or name no
            vertex.
        IoError: the file cannot be written.
    """
    call = Arguments("write_stl", np.float32)
    vertices = call.array("vertices", vertices, ("V", 3))
    last = len(vertices) - 1
    faces = call.array("faces", faces, ("F", 3), dtype=np.int64, low=0, high=last)
    rows = np.zeros(len(faces), _TRIANGLE)
    corners = rows["corners"] = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.sqrt(np.square(normals).sum(axis=1, keepdims=True))
    rows["normal"] = normals / np.where(length > 0, length, 1.0)
    header = bytes(80) + len(faces).to_bytes(4, "little")
    atomic_write(path, header + rows.tobytes())

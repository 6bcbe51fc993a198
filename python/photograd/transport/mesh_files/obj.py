"""Meshes in .obj files: positions, texture coordinates and normals are counted each for itself.

A corner of a face names one of each, "v/vt/vn". Here a vertex has all three, so corners that agree
in all become one vertex. A material is a part of its own; `mtl` reads what it is.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from photograd_course.input_files import read_file

from photograd.errors import IoError, message
from photograd.transport.mesh_files.container import NAME
from photograd.transport.mesh_files.model_file import Arrays, ModelFile
from photograd.transport.mesh_files.mtl import read_libraries
from photograd.transport.mesh_files.simple_formats import (
    GRAY,
    Note,
    finite_or_none,
    model_of_meshes,
)
from photograd.types import Array

_KINDS = {"v": 3, "vt": 2, "vn": 3}
Corner = tuple[int, int, int]


@dataclass
class _Part:
    """Faces of one material, by numbers of its own corners."""

    corners: dict[Corner, int] = field(default_factory=dict)
    faces: list[tuple[int, int, int]] = field(default_factory=list)


def read_obj(path: Path, note: Note) -> ModelFile:
    """Polygons as fans around their first corner, by material.

    Args:
        path: of the file.
        note: called with sentences.

    Raises:
        IoError: a damaged file; names the line.
        SceneError: no triangle.
    """
    text = read_file(NAME, path).decode("utf-8", "replace").replace("\\\n", " ")
    rows: dict[str, list[list[float]]] = {kind: [] for kind in _KINDS}
    parts: dict[str, _Part] = {}
    libraries: list[str] = []
    material = ""
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split()
        if not words:
            continue
        try:
            if words[0] in _KINDS:
                rows[words[0]].append(_numbers(words[1:], _KINDS[words[0]]))
            elif words[0] == "f":
                counts = (len(rows["v"]), len(rows["vt"]), len(rows["vn"]))
                _add_face(parts.setdefault(material, _Part()), words[1:], counts)
        except ValueError as failure:
            where = f"{path}: line {number}"
            raise IoError(message(NAME, where, "numbers of an .obj file", failure)) from failure
        if words[0] == "usemtl":
            material = " ".join(words[1:])
        elif words[0] == "mtllib":
            libraries.append(line.split(maxsplit=1)[1] if len(words) > 1 else "")
    materials, textures = read_libraries(path, libraries, note)
    meshes = []
    for name, part in parts.items():
        if name and name not in materials:
            note(f"{path.name}: usemtl {name[:60]}: no such material in its .mtl files; gray")
        known = name if name in materials else "gray"
        meshes.append((name or path.stem, _arrays(part, rows), known))
    without = {name for _, arrays, name in meshes if arrays[3] is None}
    for name in without & {n for n, made in materials.items() if made.needs_uv}:
        note(f"{path.name}: material {name}: faces without texture coordinates; no texture")
        materials[name] = GRAY
    return model_of_meshes(path, meshes, {"gray": GRAY, **materials}, textures, note)


def _numbers(words: list[str], width: int) -> list[float]:
    """The first numbers of a line; ValueError if there are too few."""
    if len(words) < width:
        raise ValueError(f"{len(words)} of {width}")
    return [float(word) for word in words[:width]]


def _add_face(part: _Part, words: list[str], counts: Corner) -> None:
    """A polygon; ValueError if its corners name nothing."""
    numbers = []
    for word in words:
        if word.startswith("#"):
            break
        given = [int(entry) if entry else 0 for entry in word.split("/")]
        if not 1 <= len(given) <= 3:
            raise ValueError(word[:40])
        # From 1, or back from what has been read so far; 0 is none.
        found = [
            index - 1 if index > 0 else count + index if index < 0 else -1
            for index, count in zip(given + [0] * (3 - len(given)), counts, strict=True)
        ]
        if given[0] == 0 or any(
            not (0 <= at < count)
            for at, count, index in zip(found, counts, given, strict=False)
            if index
        ):
            raise ValueError(f"{word[:40]}, with {counts} v, vt and vn so far")
        corner = (found[0], found[1], found[2])
        numbers.append(part.corners.setdefault(corner, len(part.corners)))
    if len(numbers) < 3:
        raise ValueError(f"a face of {len(numbers)} corners")
    part.faces += [(numbers[0], numbers[k], numbers[k + 1]) for k in range(1, len(numbers) - 1)]


def _arrays(part: _Part, rows: dict[str, list[list[float]]]) -> Arrays:
    """Vertices of a part; v runs upwards in the file, downwards here."""
    which = np.array(list(part.corners), np.int64).reshape(-1, 3)
    with np.errstate(over="ignore", invalid="ignore"):
        vertices, uv, normals = (
            _chosen(np.array(rows[kind], np.float64).reshape(-1, width), which[:, column])
            for column, (kind, width) in enumerate(_KINDS.items())
        )
        assert vertices is not None  # every corner has a position
        if uv is not None:
            uv = (uv * [1, -1] + [0, 1]).astype(np.float32)
        normals = None if normals is None else normals.astype(np.float32)
        faces = np.array(part.faces, np.int64).reshape(-1, 3)
        return vertices.astype(np.float32), faces, finite_or_none(normals), finite_or_none(uv)


def _chosen(rows: Array, which: Array) -> Array | None:
    """Rows by number; None unless every corner has one."""
    if not len(rows) or bool((which < 0).any()):
        return None
    chosen: Array = rows[which]
    return chosen

"""The one door to mesh files."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path

from photograd_course.suggest import choose_from

from photograd._typed import typed_call
from photograd.errors import IoError, message
from photograd.transport.mesh_files.container import NAME
from photograd.transport.mesh_files.gltf import read_gltf
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.mesh_files.obj import read_obj
from photograd.transport.mesh_files.ply import read_ply_mesh
from photograd.transport.mesh_files.stl import read_stl

READERS: dict[str, Callable[[Path, Callable[[str], None]], ModelFile]] = {
    ".glb": read_gltf,
    ".gltf": read_gltf,
    ".obj": read_obj,
    ".ply": read_ply_mesh,
    ".stl": read_stl,
}
SUFFIXES = tuple(READERS)
_NUMBER = re.compile(r"\[\d+\]")
NOTES = 40
"""So many things left out are named; a damaged file has no end of them."""


@typed_call
def read_model(path: str | Path) -> ModelFile:
    """The shapes, materials and textures of a mesh file; of .glb and .gltf cameras and lights, too.

    Positions are meters, +Y up, as glTF has it; files that say nothing of units or axes are taken
    as they are. Normals and texture coordinates are read where there are any. Triangles without
    area or with corners that are not finite are dropped. Warnings (UserWarning) count what was
    dropped and name what is not supported, with where it stands in the file.

    Args:
        path: of the file: .glb, .gltf, .obj, .ply or .stl.

    Returns:
        What the file holds; `default_scene` makes a `Scene` of it.

    Raises:
        IoError: a missing or damaged file, another kind of file, or compressed geometry.
        RangeError: numbers in a glTF file that are not finite.
        SceneError: nothing that can be drawn.

    Example:
        >>> model = photograd.read_model("cube.obj")
        >>> [len(shape.faces) for shape in model.shapes], model.box.shape
        ([12], (2, 3))
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in READERS:
        known = choose_from(suffix, READERS)
        raise IoError(message(NAME, f"{path}", "a mesh file", suffix or "no suffix", known))
    notes: dict[str, None] = {}

    def note(text: str) -> None:
        notes.setdefault(text)

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = READERS[suffix](path, note)
    for warning in caught:
        notes.setdefault(f"{path.name}: {warning.message}")
    told = _together(notes)
    for text in told[:NOTES]:
        warnings.warn(text, UserWarning, stacklevel=2)
    if len(told) > NOTES:
        text = f"{path.name}: and {len(told) - NOTES} things more"
        warnings.warn(text, UserWarning, stacklevel=2)
    return model


def _together(notes: Iterable[str]) -> list[str]:
    """Notes that differ in the number of an entry alone become one."""
    alike: dict[str, list[str]] = {}
    for text in notes:
        alike.setdefault(_NUMBER.sub("[]", text, count=1), []).append(text)
    return [
        same[0] if len(same) == 1 else f"{same[0]} (and in {len(same) - 1} more)"
        for same in alike.values()
    ]

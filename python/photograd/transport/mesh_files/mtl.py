"""Materials of .obj files: of an .mtl file, the diffuse color Kd and its picture map_Kd."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.input_files import read_file

from photograd._files import inside
from photograd.errors import Error, RangeError, message
from photograd.transport.material import Material
from photograd.transport.mesh_files.container import NAME
from photograd.transport.mesh_files.simple_formats import Note
from photograd.transport.texture import Texture, TextureUse, read_texture

_BLACK_MEANS_NOTHING = ("Ks", "Ke", "Tf")
_ONE_MEANS_NOTHING = ("d",)


def read_libraries(
    path: Path, names: list[str], note: Note
) -> tuple[dict[str, Material], dict[str, Texture]]:
    """Materials and textures of the files that an .obj names; what is missing is noted.

    Args:
        path: of the .obj file.
        names: of the files.
        note: called with sentences.
    """
    materials: dict[str, Material] = {}
    textures: dict[str, Texture] = {}
    for name in dict.fromkeys(names):
        try:
            library = _beside(path, name)
            text = read_file(f"{NAME}: {path.name}: mtllib", library).decode("utf-8", "replace")
        except Error as failure:
            note(f"left out: {failure}")
            continue
        for material, entries in _tables(text).items():
            label = f"{library.name}: newmtl {material[:60]}"
            try:
                materials[material] = _material(library, entries, textures, label, note)
            except (ValueError, Error) as failure:
                note(f"{label}: left out: {failure}")
    return materials, textures


def _beside(path: Path, name: str) -> Path:
    """A file in the folder of another.

    Raises:
        IoError: a name that leads out of it.
    """
    relative = name.strip().replace("\\", "/")
    return inside(NAME, path.name, path.parent, relative, portable=True)


def _tables(text: str) -> dict[str, dict[str, str]]:
    """{material: {key: the rest of its line}}."""
    tables: dict[str, dict[str, str]] = {}
    current: dict[str, str] = {}
    for line in text.splitlines():
        key, _, rest = line.strip().partition(" ")
        if key == "newmtl":
            current = tables.setdefault(rest.strip(), {})
        elif key and not key.startswith("#"):
            current[key] = rest.strip()
    return tables


def _material(
    library: Path, entries: dict[str, str], textures: dict[str, Texture], label: str, note: Note
) -> Material:
    """A Lambertian surface; ValueError or RangeError for numbers that are none."""
    for key, rest in entries.items():
        black = key in _BLACK_MEANS_NOTHING and not any(_floats(rest))
        opaque = key in _ONE_MEANS_NOTHING and _floats(rest) == [1.0]
        known = key in ("Kd", "map_Kd", "Ka", "Ns", "Ni", "illum", "Tr") or black or opaque
        if not known:
            note(f"{label}: {key}: not supported, left out")
    if "map_Kd" in entries:
        try:
            file = _beside(library, entries["map_Kd"])
            textures.setdefault(file.name, read_texture(file))
            use = {"albedo": TextureUse(file.name)}
            return Material("lambert", {"albedo": [1.0, 1.0, 1.0]}, use)
        except Error as failure:
            note(f"{label}: map_Kd: left out: {failure}")
    color = _floats(entries.get("Kd", "0.7 0.7 0.7"))
    if len(color) != 3 or not np.isfinite(color).all():
        raise RangeError(message(NAME, f"{label}: Kd", "three finite numbers", entries["Kd"][:60]))
    return Material("lambert", {"albedo": np.clip(color, 0, 1)})


def _floats(rest: str) -> list[float]:
    return [float(word) for word in rest.split()]

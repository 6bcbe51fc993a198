"""What fills the bodies of a glTF file: KHR_materials_volume [Khronos2022]."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from photograd.transport.media_list import is_closed
from photograd.transport.medium import Medium
from photograd.transport.mesh_files.gltf_materials import FileMaterial
from photograd.transport.shapes import Shape


def filled_shapes(
    shapes: Sequence[Shape], materials: Mapping[str, FileMaterial], note: Callable[[str], None]
) -> tuple[tuple[Shape, ...], dict[str, Medium]]:
    """Shapes with their interiors, and the media by the names of their materials.

    An open mesh has no inside: it is left as it is, with a note.

    Args:
        shapes: of the file.
        materials: of the file, by name.
        note: called with sentences.
    """
    filled: list[Shape] = []
    media: dict[str, Medium] = {}
    for shape in shapes:
        medium = materials[shape.material].interior
        if medium is None:
            filled.append(shape)
        elif not is_closed(shape):
            note(f"{shape.name}: an open mesh has no inside: attenuation left out")
            filled.append(shape)
        else:
            media[shape.material] = medium
            filled.append(replace(shape, interior=shape.material))
    return tuple(filled), media

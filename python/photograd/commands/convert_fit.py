"""Fitted models as files of other programs, for `photograd convert`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from photograd.errors import IoError, RangeError, message
from photograd.fitting.isosurface import RESOLUTION, extract_mesh
from photograd.fitting.mesh_files import MESHES, write_colored_mesh
from photograd.fitting.model import Model, load_model


def convert_fit(
    source: Path, target: Path, *, mesh: bool, resolution: int | None, level: float | None
) -> dict[str, Any]:
    """Write what a model exports, or a mesh of it; returns what the command reports.

    What a representation writes itself comes first: of Gaussians a .ply file holds Gaussians, of a
    fitted mesh a .glb file that mesh; `mesh` makes a new one of those, too.

    Raises:
        IoError: a name that the model has no file for, or a bad model.
        RangeError: options of a mesh for another file, or no surface.
    """
    model, suffix = load_model(source), target.suffix.lower()
    own = suffix in model.field.export_suffixes and not mesh
    if (own or suffix not in MESHES) and (mesh or resolution is not None or level is not None):
        expected = "a mesh to make, .glb or .ply, with --mesh, --level or --resolution"
        raise RangeError(message("convert", "OUT", expected, target.name, "leave the option out"))
    if own:
        notes = model.field.export(target, model.background)
        told: dict[str, Any] = {"representation": model.field.name}
    elif suffix in MESHES:
        told, notes = _mesh(model, target, resolution or RESOLUTION, level)
    else:
        kinds = dict.fromkeys((*model.field.export_suffixes, *MESHES))
        expected = f"a name that ends in {', '.join(kinds)} for a model of {model.field.name}"
        raise IoError(message("convert", "OUT", expected, target.name))
    lines = [{"writing": target.name, "note": line} for line in notes]
    return {**told, "bytes_out": target.stat().st_size, "out": target, "notes": lines}


def _mesh(
    model: Model, target: Path, resolution: int, level: float | None
) -> tuple[dict[str, Any], tuple[str, ...]]:
    mesh = extract_mesh(model, resolution=resolution, level=level)
    write_colored_mesh(target, mesh)
    told = {
        "representation": model.field.name,
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.faces),
        "level": round(mesh.level, 4),
    }
    of_depths = "the surface is that of depths, fused: half of the light ends there"
    of_level = f"the surface is where extinction is {mesh.level:.4g}/m"
    return told, (of_level if mesh.level else of_depths, "colors hold the light of the photographs")

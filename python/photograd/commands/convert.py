"""`photograd convert`: Gaussians or meshes from one file format to another, and what changed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from photograd_course.cli import DebugOption, JsonOption, emit

from photograd.commands.convert_model import READABLE, convert_model
from photograd.commands.convert_model import WRITABLE as GLTF
from photograd.errors import IoError, RangeError, message
from photograd.splats.coding import differences
from photograd.splats.files import SUFFIXES, WRITABLE, codings_of, read_gaussians, write_gaussians
from photograd.splats.frames import USUAL_UP, dropped, with_usual_up

SPZ_VERSION = 3


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("convert")(convert)


def convert(
    source: Annotated[
        Path,
        typer.Argument(
            help=f"File of Gaussians: {', '.join(SUFFIXES)}; or, to make glTF of it, a scene or "
            f"meshes: {', '.join(READABLE)}.",
            metavar="IN",
        ),
    ],
    target: Annotated[
        Path, typer.Argument(help=f"File to write: {', '.join((*WRITABLE, *GLTF))}.", metavar="OUT")
    ],
    spz_version: Annotated[
        int | None,
        typer.Option("--spz-version", min=2, max=4, help="Version of an .spz file; by default 3."),
    ] = None,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Convert a file of Gaussians, and say by how much each attribute was rounded.

    What is up stays up; what OUT has no place for, such as a background, is named.

    Where OUT is .glb or .gltf, IN is a scene or a mesh file; what the file cannot hold, or is read
    back changed, is named.

    Example: photograd convert scene.ply scene.spz
    """
    if spz_version is not None and target.suffix.lower() != ".spz":
        expected = "a file .spz to write with --spz-version"
        raise RangeError(message("convert", "OUT", expected, target.name, "leave the option out"))
    if target.suffix.lower() in GLTF:
        _check_other(source, target)
        emit(convert_model(source, target), as_json=as_json, title="convert")
        return
    version = SPZ_VERSION if spz_version is None else spz_version
    emit(convert_file(source, target, version), as_json=as_json, title="convert")


def convert_file(source: Path, target: Path, spz_version: int) -> dict[str, Any]:
    """Convert and read back; returns what the command reports.

    Raises:
        IoError: a bad file, or the same for both.
    """
    _check_other(source, target)
    before = read_gaussians(source)
    gaussians, told, suffix = before.gaussians, before.presentation, target.suffix.lower()
    left_out = []
    if suffix != ".ply" and told.up not in (None, USUAL_UP):
        gaussians = with_usual_up(gaussians, told.up)
        left_out.append(f"rotated from {told.up} up to {USUAL_UP} up, which {suffix} files have")
    write_gaussians(target, gaussians, spz_version=spz_version, presentation=told)
    after = read_gaussians(target)
    if after.gaussians.degree < gaussians.degree:
        degrees = f"{after.gaussians.degree + 1} to {gaussians.degree}"
        left_out.append(f"harmonics of degree {degrees} are dropped")
    left_out += dropped(suffix, told)
    notes = [{"reading": source.name, "note": line} for line in before.conversions]
    notes += [{"reading": target.name, "note": line} for line in (*after.conversions, *left_out)]
    codings = codings_of(target, gaussians, spz_version=spz_version)
    changes = [
        {
            "attribute": each.attribute,
            "unit": each.unit,
            "largest_change": float(f"{each.largest:.4g}"),
            "format_allows": float(f"{each.bound:.4g}"),
            "clamped": each.clamped,
        }
        for each in differences(gaussians, after.gaussians, codings)
    ]
    return {
        "gaussians": len(before.gaussians),
        "degree": after.gaussians.degree,
        "bytes_in": source.stat().st_size,
        "bytes_out": target.stat().st_size,
        "out": target,
        "changes": changes,
        "notes": notes,
    }


def _check_other(source: Path, target: Path) -> None:
    if target.exists() and source.exists() and target.samefile(source):
        expected = "another file than IN"
        raise IoError(message("convert", "OUT", expected, f"{target}", "choose another name"))

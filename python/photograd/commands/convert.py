"""`photograd convert`: Gaussians, meshes, models and cameras to files of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from photograd_course.cli import DebugOption, JsonOption, emit

from photograd._checkpoint import FILE_NAME
from photograd._checks import typed
from photograd._run_lock import one_run_for, one_run_in
from photograd.capture.export import Form
from photograd.commands.convert_capture import CAMERAS, convert_capture
from photograd.commands.convert_fit import convert_fit
from photograd.commands.convert_model import READABLE, convert_model
from photograd.commands.convert_model import WRITABLE as GLTF
from photograd.errors import IoError, RangeError, message
from photograd.splats.coding import differences
from photograd.splats.files import (
    SUFFIXES,
    WRITABLE,
    codings_of,
    holds_gaussians,
    is_gaussian_ply,
    read_gaussians,
    reread,
    write_gaussians,
)
from photograd.splats.frames import USUAL_UP, dropped, with_usual_up

SPZ_VERSION = 3
FormOption = Annotated[
    str, typer.Option("--colmap", help="Files of a COLMAP model: binary or text.")
]

MeshOption = Annotated[
    bool,
    typer.Option(
        "--mesh",
        help="Make a mesh of a fit also where its own files have that suffix, as Gaussians do.",
    ),
]
LevelOption = Annotated[
    float | None,
    typer.Option(
        "--level",
        min=0.0,
        help="Extinction (1/m) on the surface of a mesh; by default one that halves light over "
        "2 % of the diagonal of the box.",
    ),
]
LatticeOption = Annotated[
    int | None,
    typer.Option(
        "--resolution",
        min=8,
        max=1024,
        help="Points along the longest edge, for a mesh of what is no grid; by default 128.",
    ),
]


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("convert")(convert)


def convert(
    context: typer.Context,
    source: Annotated[
        Path,
        typer.Argument(
            help=f"File of Gaussians: {', '.join(SUFFIXES)}; a scene or meshes: "
            f"{', '.join(READABLE)}; the folder of a fit, or its model.npz; or the folder of a "
            "capture.",
            metavar="IN",
        ),
    ],
    target: Annotated[
        Path,
        typer.Argument(
            help=f"Of Gaussians: {', '.join(WRITABLE)}. Of scenes and meshes: {', '.join(GLTF)}. "
            "Of a fit: a mesh .glb or .ply, a grid .vdb, or all arrays .npz. Of a capture: "
            f"transforms{CAMERAS}, or a folder for a COLMAP model.",
            metavar="OUT",
        ),
    ],
    spz_version: Annotated[
        int | None,
        typer.Option("--spz-version", min=2, max=4, help="Version of an .spz file; by default 3."),
    ] = None,
    mesh: MeshOption = False,
    level: LevelOption = None,
    resolution: LatticeOption = None,
    colmap: FormOption = "binary",
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Convert Gaussians, scenes, fitted models and captures to files of other programs.

    Of Gaussians it says by how much each attribute was rounded. What is up stays up; what OUT has
    no place for, such as a background, is named.

    A mesh of a fit is found by marching cubes and has the colors of the fit at its vertices. The
    cameras of a capture are written as transforms.json or as a COLMAP model; photographs stay
    where they are.

    Example: photograd convert scene.ply scene.spz

    Example: photograd convert model mesh.glb

    Example: photograd convert photos transforms.json
    """
    _check_other(source, target)
    _hold(context, target)
    suffix, form = target.suffix.lower(), typed("convert", "--colmap", Form, colmap)
    if spz_version is not None and suffix != ".spz":
        expected = "a file .spz to write with --spz-version"
        raise RangeError(message("convert", "OUT", expected, target.name, "leave the option out"))
    if (source / FILE_NAME).is_file() or _is_model(source):
        found = convert_fit(source, target, mesh=mesh, resolution=resolution, level=level)
        emit(found, as_json=as_json, title="convert")
        return
    options = {"--mesh": mesh, "--level": level is not None, "--resolution": resolution is not None}
    for option, given in options.items():
        if given:
            expected = f"a fit to make a mesh of with {option}"
            remedy = "leave the option out"
            raise RangeError(message("convert", "IN", expected, source.name, remedy))
    if source.is_dir() or source.suffix.lower() == CAMERAS:
        found = convert_capture(source, target, form)
    elif suffix in GLTF and not _are_gaussians(source):
        found = convert_model(source, target)
    else:
        found = convert_file(source, target, SPZ_VERSION if spz_version is None else spz_version)
    emit(found, as_json=as_json, title="convert")


def _hold(context: typer.Context, target: Path) -> None:
    """Find out before the work whether OUT can be written; its folder is made."""
    if target.suffix and not target.is_dir():
        held = one_run_for("convert", target, argument="OUT", parents=True)
    else:
        held = one_run_in("convert", target, argument="OUT")
    context.with_resource(held)


def _is_model(source: Path) -> bool:
    return source.suffix.lower() == ".npz" and source.is_file() and not holds_gaussians(source)


def _are_gaussians(source: Path) -> bool:
    """By the name, and of a .ply file by its header: it may hold a mesh as well."""
    if source.suffix.lower() == ".ply":
        return is_gaussian_ply(source)
    return holds_gaussians(source)


def convert_file(source: Path, target: Path, spz_version: int) -> dict[str, Any]:
    """Convert and read back; returns what the command reports.

    Raises:
        IoError: a bad file, or a name that no format has.
    """
    before = read_gaussians(source)
    gaussians, told, suffix = before.gaussians, before.presentation, target.suffix.lower()
    left_out = []
    if suffix != ".ply" and told.up not in (None, USUAL_UP):
        gaussians = with_usual_up(gaussians, told.up)
        left_out.append(f"rotated from {told.up} up to {USUAL_UP} up, which {suffix} files have")
    write_gaussians(target, gaussians, spz_version=spz_version, presentation=told)
    written, after = reread(target, gaussians)
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
        for each in differences(written, after.gaussians, codings)
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

"""`photograd capture --photos`: cameras and points from one's own photographs."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer
from photograd_course.cli import note

from photograd._run_lock import one_run_in
from photograd.capture.sfm.engine import Settings

_PANEL = "Photographs"
_OF_SCENES = ("scene", "views", "test_views", "size", "spp")
_OF_PHOTOGRAPHS = ("max_size", "pairs")
_FEW = 0.75  # of the photographs; with fewer, something is probably wrong with them

MaxSizeOption = Annotated[
    int,
    typer.Option(
        "--max-size", min=200, rich_help_panel=_PANEL,
        help="Longer side in pixels at which features are looked for.",
    ),
]  # fmt: skip
PairsOption = Annotated[
    str,
    typer.Option(
        "--pairs", rich_help_panel=_PANEL,
        help="Photographs to compare: all, walk (neighbours by name), or auto: all up to 60.",
    ),
]  # fmt: skip


def refuse_mixture(context: typer.Context, photos: Path | None) -> None:
    """Options of the one kind of capture mean nothing to the other.

    Raises:
        BadParameter: one of them was given.
    """
    for name in _OF_PHOTOGRAPHS if photos is None else _OF_SCENES:
        source = context.get_parameter_source(name)
        if source is not None and source.name == "COMMANDLINE":
            option = "--" + name.replace("_", "-")
            other = "without --photos" if photos is None else "beside --photos"
            raise typer.BadParameter(f"has no meaning {other}", param_hint=option)


def beside(photos: Path) -> Path:
    """Where the capture goes by default; a folder may also be called "." or ".."."""
    folder = photos if photos.name not in ("", "..") else photos.resolve()
    return folder.parent / f"{folder.name}_capture"


def capture_photographs(
    photos: Path, out: Path, *, pairs: str, max_size: int, seed: int, threads: int, overwrite: bool
) -> dict[str, Any]:
    """Recover cameras under progress bars; returns what the command reports.

    Raises:
        BadParameter: `pairs` is none of its values.
        IoError, SceneError: as `photograd.capture.sfm.reconstruct.reconstruct` does.
    """
    from photograd.capture.sfm.reconstruct import PICTURE, reconstruct

    exhaustive = {"auto": None, "all": True, "walk": False}
    if pairs not in exhaustive:
        raise typer.BadParameter("one of auto, all, walk", param_hint="--pairs")
    began = time.monotonic()
    with one_run_in("capture", out):
        capture, report = reconstruct(
            photos, out, Settings(seed=seed, max_size=max_size), threads=threads,
            exhaustive=exhaustive[pairs], overwrite=overwrite, note=note,
        )  # fmt: skip
    for line in capture.conversions:
        note(line)
    if report.left_out:
        listed = ", ".join(report.left_out[:8]) + (", ..." if len(report.left_out) > 8 else "")
        note(f"without a pose: {listed}", style="yellow")
    if report.registered < _FEW * report.photographs:
        note(
            "warning: many photographs found no place; more overlap helps, or --pairs all",
            style="yellow",
        )
    return {
        "out": out,
        "photographs": report.photographs,
        "registered": report.registered,
        "points": report.points,
        "reprojection_error_px": round(report.error, 3),
        "cameras": report.cameras,
        "unconnected_parts": report.models - 1,
        "picture": out / PICTURE,
        "seconds": round(time.monotonic() - began, 1),
        "next": f"photograd fit {out} --out model",
    }

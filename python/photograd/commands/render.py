"""`photograd render`: look at a model from a circle of cameras."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer
from photograd_course.cli import (
    Column,
    DebugOption,
    JsonOption,
    Progress,
    ThreadsOption,
    emit,
    note,
)

from photograd.commands.shared import use_threads
from photograd.data.gaussian_files import holds_gaussians, read_gaussians
from photograd.evaluate import display_image
from photograd.fog import RAMPS, load_fog
from photograd.model import load_model
from photograd.orbit import orbit_cameras
from photograd.representation import Array
from photograd.splat_orbit import UP_AXES, orbit_splats
from photograd.volumes import SUFFIXES


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("render")(render)


def render(
    model: Annotated[
        Path,
        typer.Argument(
            help="Folder that a fit wrote, its model.npz; a volume: .vdb, .vtk, .nii, .vol; or a "
            "file of Gaussians: .ply, .splat, .spz, .npz.",
            metavar="MODEL",
        ),
    ],
    orbit: Annotated[int, typer.Option("--orbit", min=1, help="Frames on the circle.")] = 60,
    out: Annotated[
        Path, typer.Option("--out", help="A .gif file, or a folder for PNG frames.")
    ] = Path("turntable.gif"),
    size: Annotated[int, typer.Option("--size", min=8, help="Pixels along an edge.")] = 256,
    elevation: Annotated[
        float, typer.Option("--elevation", min=-89.0, max=89.0, help="Degrees above the horizon.")
    ] = 25.0,
    ramp: Annotated[
        str, typer.Option("--ramp", help=f"Colours of a volume: {', '.join(RAMPS)}.")
    ] = "white",
    sigma_t: Annotated[
        float | None,
        typer.Option("--sigma-t", min=0.0, help="Extinction (1/m) of a volume at value 1."),
    ] = None,
    resolution: Annotated[
        int, typer.Option("--resolution", min=2, help="Voxels along a volume's longest edge.")
    ] = 128,
    window: Annotated[
        tuple[float, float] | None,
        typer.Option("--window", help="Values of a volume that count as 0 and as 1."),
    ] = None,
    up: Annotated[
        str, typer.Option("--up", help=f"What is up among Gaussians: {', '.join(UP_AXES)}.")
    ] = "-y",
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001
) -> None:
    """Render a turntable of a recovered scene, of a volume or scan, or of Gaussians.

    Example: photograd render model --orbit 60 --out turntable.gif
    """
    use_threads(threads)
    if holds_gaussians(model):
        found = read_gaussians(model)
        for line in found.conversions:
            note(line)
        views = orbit_splats(found.gaussians, orbit, size=size, elevation=elevation, up=up)
        _save(_drawn(views, orbit), out, as_json=as_json)
        return
    if model.name.lower().endswith((".vdb", *SUFFIXES)):
        loaded = load_fog(model, ramp=ramp, sigma_t=sigma_t, resolution=resolution, window=window)
    else:
        loaded = load_model(model)
    cameras = orbit_cameras(loaded.field.box, orbit, size=size, elevation=elevation)
    _save(
        _drawn((display_image(loaded, camera) for camera in cameras), orbit), out, as_json=as_json
    )


def _drawn(views: Iterable[Array], count: int) -> list[Array]:
    """All pictures, while a bar shows how many there are."""
    frames = []
    with Progress("render", count, [Column("frame", "{:.0f}".format)]) as bar:
        for view in views:
            frames.append(view)
            bar.update(len(frames), frame=len(frames))
    return frames


def _save(frames: list[Array], out: Path, *, as_json: bool) -> None:
    """Write the frames to a .gif or a folder, and say so."""
    from photograd_course.viz import write_frames, write_gif

    if out.suffix.lower() == ".gif":
        write_gif(frames, out)
    else:
        write_frames(frames, out)
    emit({"out": out, "frames": len(frames)}, as_json=as_json, title="render")

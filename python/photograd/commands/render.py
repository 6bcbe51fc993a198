"""`photograd render`: look at a model from a circle of cameras."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
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

from photograd._checks import typed
from photograd.capture.orbit import orbit_cameras
from photograd.commands.drawable import check_rendered, is_volume
from photograd.commands.shared import SizeOption, check_output_name, out_option, use_threads
from photograd.errors import RangeError, message
from photograd.fitting.evaluate import display_image
from photograd.fitting.fog import RAMPS, Ramp, load_fog
from photograd.fitting.model import Model, load_model
from photograd.images.write import write_png
from photograd.splats.files import holds_gaussians, read_gaussians
from photograd.splats.frames import UP_AXES, USUAL_UP
from photograd.splats.orbit import orbit_splats
from photograd.types import Array

AUTO = "auto"
STILL = ".png"
OutOption = Annotated[
    Path,
    out_option(
        "A .gif file; a name without a suffix: a folder for PNG frames; or, with --orbit 1, a "
        ".png file."
    ),
]
UpOption = Annotated[
    str,
    typer.Option(
        "--up",
        help=f"What is up in a file of Gaussians: {', '.join(UP_AXES)}; by default what its header "
        f"says, else {USUAL_UP}.",
    ),
]


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
    out: OutOption = Path("turntable.gif"),
    size: SizeOption = 256,
    elevation: Annotated[
        float, typer.Option("--elevation", min=-89.0, max=89.0, help="Degrees above the horizon.")
    ] = 25.0,
    ramp: Annotated[
        str, typer.Option("--ramp", help=f"Colors of a volume: {', '.join(RAMPS)}.")
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
    up: UpOption = AUTO,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001
) -> None:
    """Render a turntable of a recovered scene, of a volume or scan, or of Gaussians.

    Example: photograd render model --orbit 60 --out turntable.gif
    """
    use_threads(threads)
    _check_options(out, orbit, up)
    check_rendered(model)
    circle = {"count": orbit, "size": size, "elevation": elevation}
    if holds_gaussians(model):
        views = _splat_views(model, up, circle)
    elif is_volume(model):
        colors = typed("render", "--ramp", Ramp, ramp)
        fog = load_fog(model, ramp=colors, sigma_t=sigma_t, resolution=resolution, window=window)
        views = _model_views(fog, circle)
    else:
        views = _model_views(load_model(model), circle)
    _save(_drawn(views, orbit), out, as_json=as_json)


def _check_options(out: Path, orbit: int, up: str) -> None:
    """Refuse, before anything is drawn, names and axes that mean nothing."""
    check_output_name("render", out, (".gif", STILL), folder="PNG frames")
    if out.suffix.lower() == STILL and orbit > 1:
        expected = f"--orbit 1 for one picture {out.name}"
        remedy = "for a turntable name a .gif file, or a folder"
        raise RangeError(message("render", "--orbit", expected, orbit, remedy))
    if up not in (AUTO, *UP_AXES):
        raise RangeError(message("render", "--up", f"{AUTO} or one of {', '.join(UP_AXES)}", up))


def _splat_views(path: Path, up: str, circle: Mapping[str, Any]) -> Iterable[Array]:
    """The pictures of a file of Gaussians, one after the other."""
    found = read_gaussians(path)
    for line in found.conversions:
        note(line)
    told = found.presentation if up == AUTO else replace(found.presentation, up=up)
    return orbit_splats(found.gaussians, presentation=told, **circle)


def _model_views(model: Model, circle: Mapping[str, Any]) -> Iterable[Array]:
    """The pictures of a model: its own turntable, or cameras around its box."""
    own = model.field.turntable(background=model.background, **circle)
    if own is not None:
        return own
    cameras = orbit_cameras(model.field.box, **circle)
    return (display_image(model, camera) for camera in cameras)


def _drawn(views: Iterable[Array], count: int) -> list[Array]:
    """All pictures, while a bar shows how many there are."""
    frames = []
    with Progress("render", count, [Column("frame", "{:.0f}".format)]) as bar:
        for view in views:
            frames.append(view)
            bar.update(len(frames), frame=len(frames))
    return frames


def _save(frames: list[Array], out: Path, *, as_json: bool) -> None:
    """Write the frames to a .gif, a .png or a folder, and say so."""
    from photograd_course.viz import write_frames, write_gif

    if out.suffix.lower() == ".gif":
        write_gif(frames, out)
    elif out.suffix.lower() == STILL:
        write_png(out, frames[0].astype(np.float32))
    else:
        write_frames(frames, out)
    emit({"out": out, "frames": len(frames)}, as_json=as_json, title="render")

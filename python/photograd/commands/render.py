"""`photograd render`: look at a model from cameras on a path, as pictures, a video or numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import typer
from photograd_course.cli import Column, DebugOption, JsonOption, Progress, ThreadsOption, emit

from photograd._checks import typed
from photograd.capture.camera import Camera
from photograd.commands.drawable import check_rendered
from photograd.commands.render_output import (
    SHOWN,
    FpsOption,
    Output,
    RangeOption,
    RenderOutOption,
    ShowOption,
)
from photograd.commands.render_paths import (
    ORBIT,
    CaptureOption,
    ElevationOption,
    FramesOption,
    HeightOption,
    PathChoice,
    PathOption,
    RenderSizeOption,
    SplitOption,
    WidthOption,
    chosen_size,
)
from photograd.commands.render_subjects import AUTO, Subject, UpOption, check_up, subject_of
from photograd.commands.shared import use_threads
from photograd.fitting.drawing import Picture
from photograd.fitting.fog import RAMPS


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("render")(render)


def render(
    context: typer.Context,
    model: Annotated[
        Path,
        typer.Argument(
            help="Folder that a fit wrote, its model.npz; a volume: .vdb, .vtk, .nii, .vol; or a "
            "file of Gaussians: .ply, .splat, .spz, .npz.",
            metavar="MODEL",
        ),
    ],
    path: PathOption = ORBIT,
    frames: FramesOption = None,
    out: RenderOutOption = Path("turntable.gif"),
    show: ShowOption = "color",
    capture: CaptureOption = None,
    split: SplitOption = "all",
    size: RenderSizeOption = None,
    width: WidthOption = None,
    height: HeightOption = None,
    elevation: ElevationOption = None,
    fps: FpsOption = 20.0,
    depth_range: RangeOption = None,
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
    """Render a recovered scene, a volume or scan, or Gaussians along a path of cameras.

    The path is a circle by default, a turntable. Others go through the photographs that a model was
    fitted to, or come from a file; what is written is a GIF, a video, pictures, or numbers.

    Example: photograd render model --frames 60 --out turntable.gif

    Example: photograd render model --path between --frames 240 --out flight.mp4

    Example: photograd render model --path views --split test --show depth --out depths
    """
    use_threads(threads)
    output = Output.checked(context, out, typed("render", "--show", SHOWN, show), fps, depth_range)
    check_up(up)
    check_rendered(model)
    pixels = chosen_size(size, width, height)
    choice = PathChoice.checked(path, frames, pixels, elevation, split, capture)
    volume = {"ramp": ramp, "sigma_t": sigma_t, "resolution": resolution, "window": window}
    subject = subject_of(model, up, volume)
    cameras = choice.cameras(subject)
    output.check_cameras(cameras)
    told = output.write(_pictures(subject, cameras), cameras)
    emit({"out": out, "frames": len(cameras), **told}, as_json=as_json, title="render")


def _pictures(subject: Subject, cameras: Sequence[Camera]) -> Iterator[Picture]:
    """Drawn one after the other under a progress bar."""
    with Progress("render", len(cameras), [Column("frame", "{:.0f}".format)]) as bar:
        for number, camera in enumerate(cameras, 1):
            yield subject.draw(camera)
            bar.update(number, frame=number)

"""`photograd capture`: input for a fit, from a built-in scene or from one's own photographs."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer
from photograd_course.cli import (
    Column,
    DebugOption,
    JsonOption,
    Progress,
    SeedOption,
    ThreadsOption,
    emit,
    note,
)

from photograd._run_lock import one_run_in
from photograd.capture.sfm.engine import Settings
from photograd.capture.write import require_free_folder, write_blender_capture
from photograd.commands.shared import SizeOption, SppOption, ViewsOption, out_option, use_threads
from photograd.scenes.capture import capture_scene
from photograd.scenes.direct_light import DirectLight
from photograd.scenes.registry import scene as build_scene
from photograd.scenes.registry import scenes

_PANEL = "Photographs"
_OF_SCENES = ("scene", "views", "test_views", "size", "spp")
_OF_PHOTOGRAPHS = ("max_size", "pairs")
_FEW = 0.75  # of the photographs; with fewer, something is probably wrong with them

MaxSizeOption = Annotated[
    int,
    typer.Option(
        "--max-size",
        min=200,
        rich_help_panel=_PANEL,
        help="Longer side in pixels at which features are looked for.",
    ),
]
PairsOption = Annotated[
    str,
    typer.Option(
        "--pairs",
        rich_help_panel=_PANEL,
        help="Photographs to compare: all, walk (neighbors by name), or auto: all up to 60.",
    ),
]


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
            photos,
            out,
            Settings(seed=seed, max_size=max_size),
            threads=threads,
            exhaustive=exhaustive[pairs],
            overwrite=overwrite,
            note=note,
        )
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


# `photograd capture`: input for a fit, from a built-in scene or from one's own photographs.


DEFAULT_SCENE = next(iter(scenes()))


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("capture")(capture)


def capture(
    context: typer.Context,
    out: Annotated[
        Path | None, out_option("Folder to create; beside the photographs if they are given.")
    ] = None,
    photos: Annotated[
        Path | None,
        typer.Option("--photos", help="Folder of your own photographs, instead of a scene."),
    ] = None,
    scene: Annotated[
        str, typer.Option("--scene", help=f"One of: {', '.join(scenes())}.")
    ] = DEFAULT_SCENE,
    views: ViewsOption = 60,
    test_views: Annotated[int, typer.Option("--test-views", min=0, help="Held-out views.")] = 8,
    size: SizeOption = 128,
    spp: SppOption = 64,
    max_size: MaxSizeOption = Settings.max_size,
    pairs: PairsOption = "auto",
    overwrite: Annotated[
        bool,
        typer.Option("--overwrite", help="Replace the capture in OUT; other files there stay."),
    ] = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Make a capture: render a built-in scene, or recover the cameras of your own photographs.

    Of a scene, with direct light and soft shadows, OUT is in the NeRF/Blender layout:
    transforms_train.json, transforms_test.json, PNG images with alpha (display values) and EXR
    images (linear radiance). Of photographs, OUT holds a COLMAP model with points, and a picture of
    the cameras; if interrupted, the same command goes on. Large reconstructions, of more than
    50,000 observations, are the same to the bit with --threads 1 only.

    Example: photograd capture --scene textured --views 60 --test-views 8 --out my_capture

    Example: photograd capture --photos my_photographs
    """
    use_threads(threads)
    refuse_mixture(context, photos)
    if photos is not None:
        result = capture_photographs(
            photos,
            out or beside(photos),
            pairs=pairs,
            max_size=max_size,
            seed=seed,
            threads=threads,
            overwrite=overwrite,
        )
    elif out is None:
        raise typer.BadParameter("a scene needs one", param_hint="--out")
    else:
        result = make_capture(
            scene,
            out,
            views=views,
            test_views=test_views,
            size=size,
            spp=spp,
            seed=seed,
            overwrite=overwrite,
        )
    emit(result, as_json=as_json, title="capture")


def make_capture(
    name: str,
    out: Path,
    *,
    views: int,
    test_views: int,
    size: int,
    spp: int,
    seed: int,
    overwrite: bool = False,
) -> dict[str, Any]:
    """Render and write a capture under a progress bar; returns what the command reports."""
    description = build_scene(name, seed=seed)
    with one_run_in("capture", out):
        require_free_folder("capture", out, overwrite=overwrite)
        light = DirectLight(description)
        with Progress("capture", views + test_views, [Column("view", "{:.0f}".format)]) as bar:
            splits = capture_scene(
                description,
                light.render_view,
                views=views,
                test_views=test_views,
                size=size,
                seed=seed,
                spp=spp,
                on_view=lambda done, _total: bar.update(done, view=done),
            )
        others = write_blender_capture(out, splits, aabb=description.bounds, overwrite=overwrite)
    if others:
        note(f"not ours, left as it is: {', '.join(others)}")
    return {"out": out, "scene": name, "views": views, "test_views": test_views, "spp": spp}

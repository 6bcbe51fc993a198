"""`photograd capture`: input for a fit, from a built-in scene or from one's own photographs."""

from __future__ import annotations

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
from photograd.commands.photo_capture import (
    MaxSizeOption,
    PairsOption,
    beside,
    capture_photographs,
    refuse_mixture,
)
from photograd.commands.shared import out_option, use_threads
from photograd.scenes.capture import capture_scene
from photograd.scenes.direct_light import DirectLight
from photograd.scenes.registry import scene as build_scene
from photograd.scenes.registry import scenes

DEFAULT_SCENE = next(iter(scenes()))


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("capture")(capture)


def capture(
    context: typer.Context,
    out: Annotated[
        Path | None,
        out_option("Folder to create; beside the photographs if they are given."),
    ] = None,
    photos: Annotated[
        Path | None,
        typer.Option("--photos", help="Folder of your own photographs, instead of a scene."),
    ] = None,
    scene: Annotated[
        str, typer.Option("--scene", help=f"One of: {', '.join(scenes())}.")
    ] = DEFAULT_SCENE,
    views: Annotated[int, typer.Option("--views", min=2, help="Training views.")] = 60,
    test_views: Annotated[int, typer.Option("--test-views", min=0, help="Held-out views.")] = 8,
    size: Annotated[int, typer.Option("--size", min=8, help="Pixels along an edge.")] = 128,
    spp: Annotated[int, typer.Option("--spp", min=1, help="Samples a pixel.")] = 64,
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
            photos, out or beside(photos), pairs=pairs,
            max_size=max_size, seed=seed, threads=threads, overwrite=overwrite,
        )  # fmt: skip
    elif out is None:
        raise typer.BadParameter("a scene needs one", param_hint="--out")
    else:
        result = make_capture(
            scene, out, views=views, test_views=test_views, size=size, spp=spp, seed=seed,
            overwrite=overwrite,
        )  # fmt: skip
    emit(result, as_json=as_json, title="capture")


def make_capture(
    name: str, out: Path, *, views: int, test_views: int, size: int, spp: int, seed: int,
    overwrite: bool = False,
) -> dict[str, Any]:  # fmt: skip
    """Render and write a capture under a progress bar; returns what the command reports."""
    description = build_scene(name, seed=seed)
    with one_run_in("capture", out):
        require_free_folder("capture", out, overwrite=overwrite)
        light = DirectLight(description)
        with Progress("capture", views + test_views, [Column("view", "{:.0f}".format)]) as bar:
            splits = capture_scene(
                description, light.render_view, views=views, test_views=test_views, size=size,
                seed=seed, spp=spp, on_view=lambda done, _total: bar.update(done, view=done),
            )  # fmt: skip
        others = write_blender_capture(out, splits, aabb=description.bounds, overwrite=overwrite)
    if others:
        note(f"not ours, left as it is: {', '.join(others)}")
    return {"out": out, "scene": name, "views": views, "test_views": test_views, "spp": spp}

"""`photograd demo`: the main job on a built-in scene, from photographs to a recovered volume."""

from __future__ import annotations

import resource
import time
from pathlib import Path
from typing import Annotated

import typer
from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit, note

from photograd._run_lock import one_run_in
from photograd._signals import stop_on_signals
from photograd.capture.load import load_capture
from photograd.capture.orbit import orbit_cameras
from photograd.commands.capture import DEFAULT_SCENE, make_capture
from photograd.commands.evaluate import draw_picked
from photograd.commands.fit import run_with_bar
from photograd.commands.gradients import draw_gradients
from photograd.commands.shared import (
    SizeOption,
    SppOption,
    StepsOption,
    ViewsOption,
    out_option,
    use_threads,
)
from photograd.fitting import FitOptions
from photograd.fitting.evaluate import display_image, evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("demo")(demo)


def demo(
    context: typer.Context,
    out: Annotated[Path, out_option("Folder for capture, model and figures.")] = Path("out/demo"),
    scene: Annotated[str, typer.Option("--scene", help="A built-in scene.")] = DEFAULT_SCENE,
    steps: StepsOption = 700,
    resolution: Annotated[
        int, typer.Option("--resolution", min=8, help="Voxels along the longest edge.")
    ] = 96,
    views: ViewsOption = 60,
    size: SizeOption = 128,
    spp: SppOption = 64,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Photograph a built-in scene, recover it, score it, and draw where the loss pulled.

    Takes about a minute on two free cores, and half a GiB. Nothing is opened: the table at the end
    names the folder of figures.

    Example: photograd demo --out out/demo
    """
    from photograd_course.viz import write_gif

    began = time.perf_counter()
    use_threads(threads)
    context.with_resource(one_run_in("demo", out))
    context.with_resource(one_run_in("demo", out / "model"))
    photos = out / "capture"
    make_capture(
        scene, photos, views=views, test_views=8, size=size, spp=spp, seed=seed, overwrite=True
    )
    capture = load_capture(photos)
    job = Fit.start(capture, FitOptions(steps=steps, resolution=resolution, seed=seed))
    with stop_on_signals() as stopping:
        fitted = run_with_bar(job, out / "model", stopping)
    if not fitted.finished:
        note(f"stopped; continue with: photograd fit {out}/capture --out {out}/model --resume")
        raise typer.Exit(stopping.exit_code)
    model = load_model(out / "model")
    scores = evaluate(model, capture.test)
    pictures = out / "figures"
    pictures.mkdir(parents=True, exist_ok=True)
    draw_picked(scores, pictures / "comparison.png")
    signs = draw_gradients(model, out / "model", capture, pictures, 1 << 18, seed)
    cameras = orbit_cameras(model.field.box, 40, size=192)
    write_gif([display_image(model, camera) for camera in cameras], pictures / "turntable.gif")
    emit(
        {
            "scene": scene,
            "psnr": scores.psnr,
            "ssim": scores.ssim,
            "steps": fitted.step,
            "fit_seconds": round(fitted.seconds, 1),
            "seconds": round(time.perf_counter() - began, 1),
            "peak_gib": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20, 2),
            "occupied_negative": signs.get("occupied_negative"),
            "background_positive": signs.get("background_positive"),
            "protocol": scores.protocol,
            "model": out / "model",
            "figures": pictures,
        },
        as_json=as_json,
        title="demo",
    )

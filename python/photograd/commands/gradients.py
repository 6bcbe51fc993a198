"""`photograd gradients`: pictures of the loss's gradient in space, and of how the fit went."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from photograd_course import viz
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

from photograd.commands.shared import CaptureArgument, DownscaleOption, ModelArgument, use_threads
from photograd.data.capture import Capture
from photograd.data.load import load_capture
from photograd.density_gradient import density_gradient, voxel_masks
from photograd.model import Model, load_model
from photograd.pixels import TrainingPixels
from photograd.representation import Array
from photograd.snapshots import load_snapshots

EXPLAIN = "Blue: more density lowers the loss. Red: less density does. White: no effect."


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("gradients")(gradients)


def gradients(
    model: ModelArgument,
    capture: CaptureArgument,
    out: Annotated[Path, typer.Option("--out", help="Folder for the pictures.")],
    rays: Annotated[int, typer.Option("--rays", min=1, help="Random rays a gradient.")] = 1 << 18,
    downscale: DownscaleOption = 1,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001
) -> None:
    """Draw the gradient of the loss in every voxel, from the start of the fit to its end.

    Example: photograd gradients model photos --out pictures
    """
    use_threads(threads)
    result = draw_gradients(
        load_model(model), model, load_capture(capture, downscale=downscale), out, rays, seed
    )
    emit(result, as_json=as_json, title="gradients")


def draw_gradients(
    model: Model, folder: Path, capture: Capture, out: Path, rays: int, seed: int
) -> dict[str, Any]:
    """All pictures of one fit; returns the files and, where alpha tells, the sign shares."""
    out.mkdir(parents=True, exist_ok=True)
    pixels = TrainingPixels(capture.train, capture.color_space)
    snapshots = load_snapshots(folder) or {int(model.meta["step"]): model.field}
    fields: dict[int, Array] = {}
    with Progress("gradients", len(snapshots), [Column("loss", "{:.2e}".format)]) as bar:
        for number, (step, field) in enumerate(snapshots.items()):
            background = None if model.background is None else model.background
            found = density_gradient(field, pixels, seed=seed, background=background, rays=rays)
            fields[step] = found.d_sigma_t
            bar.update(number + 1, loss=found.loss)
    first = min(fields)
    result: dict[str, Any] = {"out": out, "steps": sorted(fields)}
    box, start = model.field.box, snapshots[first]
    caption, outline = EXPLAIN, None
    if capture.has_alpha:
        masks = voxel_masks(start, capture)
        if masks.occupied.any() and masks.background_only.any():
            report = viz.sign_report(
                fields[first], occupied=masks.occupied, background_only=masks.background_only
            )
            caption, outline = report.caption(), masks.occupied
            result["occupied_negative"] = report.occupied_fraction
            result["background_positive"] = report.background_fraction
        else:
            note("no voxel lies in all silhouettes, or none outside: signs are shown, not weighed")
    pictures = {
        "gradient_slices": viz.signed_slices(
            fields[first], start.box, outline=outline, caption=caption,
            title=f"Gradient of the loss at step {first}",
        ),
        "gradient_projections": viz.signed_projections(
            fields[first], start.box, outline=outline, caption=caption,
            title=f"Largest gradient along each axis, step {first}",
        ),
        "gradient_steps": viz.projection_steps(
            fields, box, common_scale=False, title="The gradient as the fit goes on",
            caption=EXPLAIN
        ),
    }  # fmt: skip
    if len(model.history) > 1:
        pictures["curves"] = viz.fit_curves(curves_of(model), title="How the fit went")
    for name, figure in pictures.items():
        viz.save_figure(figure, out / f"{name}.png")
        result[name] = out / f"{name}.png"
    return result


def curves_of(model: Model) -> viz.FitCurves:
    """The history of a fit as curves, with its refinements marked."""
    steps, loss, psnr = np.asarray(model.history).T
    events = {s: f"{r}³" for s, r in model.options.levels().items() if 0 < s <= steps[-1]}
    return viz.FitCurves(steps=steps.astype(int), loss=loss, psnr=psnr, events=events)

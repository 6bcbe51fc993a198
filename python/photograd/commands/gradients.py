"""`photograd gradients`: pictures of the loss's gradient in space, and of how the fit went."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
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

from photograd.checkpoint import make_folder
from photograd.commands.shared import (
    AllowOutsideOption,
    CaptureArgument,
    DownscaleOption,
    ModelArgument,
    out_option,
    use_threads,
)
from photograd.data.capture import Capture
from photograd.data.load import load_capture
from photograd.density_gradient import density_gradient
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.fitted import FittedField
from photograd.fields.gaussians import GaussianScene
from photograd.fields.octree_sh import OctreeSh
from photograd.model import Model, load_model
from photograd.pixels import TrainingPixels
from photograd.representation import Array
from photograd.run_lock import one_run_in
from photograd.snapshots import load_snapshots
from photograd.splats.clone_split_prune import CloneSplitPrune
from photograd.splats.view_gradients import pressure_picture, view_gradients
from photograd.training_views import TrainingViews

if TYPE_CHECKING:
    from photograd_course import viz

EXPLAIN = "Blue: more density lowers the loss. Red: less density does. White: no effect."


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("gradients")(gradients)


def gradients(
    context: typer.Context,
    model: ModelArgument,
    capture: CaptureArgument,
    out: Annotated[Path, out_option("Folder for the pictures.")],
    rays: Annotated[int, typer.Option("--rays", min=1, help="Random rays a gradient.")] = 1 << 18,
    downscale: DownscaleOption = 1,
    allow_outside: AllowOutsideOption = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001
) -> None:
    """Draw the gradient of the loss in every voxel, from the start of the fit to its end.

    Of Gaussians: where their means are pulled, which should be denser, and which will be split.

    Example: photograd gradients model photos --out pictures
    """
    use_threads(threads)
    context.with_resource(one_run_in("gradients", out))
    photographs = load_capture(capture, downscale=downscale, allow_outside=allow_outside)
    result = draw_gradients(load_model(model), model, photographs, out, rays, seed)
    emit(result, as_json=as_json, title="gradients")


def draw_gradients(
    model: Model, folder: Path, capture: Capture, out: Path, rays: int, seed: int
) -> dict[str, Any]:
    """All pictures of one fit; returns the files and, where alpha tells, the sign shares."""
    from photograd_course import viz

    from photograd.sign_claim import sign_claim

    make_folder(out)
    if isinstance(model.field, GaussianScene):
        return draw_gaussians(model, folder, capture, out)
    fields, starts = gradients_of_steps(model, folder, capture, rays, seed)
    first = min(fields)
    start, gradient = starts[first], fields[first]
    result: dict[str, Any] = {"out": out, "steps": sorted(fields)}
    caption, outline = EXPLAIN, None
    claim = sign_claim(start, capture, rays=rays, seed=seed) if capture.has_alpha else None
    if claim is not None:
        caption, outline, gradient = claim.caption(), claim.occupied, claim.d_sigma_t
        result["occupied_negative"] = claim.report.occupied_fraction
        result["background_positive"] = claim.report.background_fraction
        result["views_of_signs"] = claim.views
    else:
        note("no voxel is known to be matter, or none to be empty: signs are shown, not weighed")
    pictures = {
        "gradient_slices": viz.signed_slices(
            gradient, start.box, outline=outline, caption=caption,
            title=f"Gradient of the loss at step {first}",
        ),
        "gradient_projections": viz.signed_projections(
            gradient, start.box, outline=outline, caption=caption,
            title=f"Largest gradient along each axis, step {first}",
        ),
        "gradient_steps": viz.projection_steps(
            fields, start.box, common_scale=False, title="The gradient as the fit goes on",
            caption=EXPLAIN
        ),
    }  # fmt: skip
    if len(model.history) > 1:
        pictures["curves"] = viz.fit_curves(curves_of(model), title="How the fit went")
    for name, figure in pictures.items():
        viz.save_figure(figure, out / f"{name}.png")
        result[name] = out / f"{name}.png"
    return result


def draw_gaussians(model: Model, folder: Path, capture: Capture, out: Path) -> dict[str, Any]:
    """The picture of a fit of Gaussians at three of its steps, and its curves."""
    from photograd_course import viz

    from photograd.splats.drawings import draw_gaussian_gradients

    views = TrainingViews(capture.train)
    found: dict[int, Any] = load_snapshots(folder) or {int(model.meta["step"]): model.field}
    steps = sorted(found)
    chosen = sorted({steps[0], steps[len(steps) // 2], steps[-1]})
    rows = {}
    with Progress("gradients", len(chosen), [Column("loss", "{:.2e}".format)]) as bar:
        for number, step in enumerate(chosen):
            scene: GaussianScene = found[step]
            here = view_gradients(scene, views, 0, ssim_weight=model.options.ssim_weight)
            camera = views.views[0].camera
            rows[step] = here, pressure_picture(scene.gaussians, here.pressure, camera)
            bar.update(number + 1, loss=here.loss)
    pictures = {
        "gaussian_gradients": draw_gaussian_gradients(
            rows, threshold=CloneSplitPrune.threshold, title="What the loss asks of each Gaussian"
        )
    }
    if len(model.history) > 1:
        pictures["curves"] = viz.fit_curves(curves_of(model), title="How the fit went")
    files = {
        name: viz.save_figure(figure, out / f"{name}.png") for name, figure in pictures.items()
    }
    return {"out": out, "steps": chosen, **files}


def gradients_of_steps(
    model: Model, folder: Path, capture: Capture, rays: int, seed: int
) -> tuple[dict[int, Array], dict[int, DenseGrid]]:
    """{step: dL/dsigma_t} and {step: field} of every snapshot of a fit, under a progress bar."""
    pixels = TrainingPixels(capture.train, capture.color_space)
    found_fields = load_snapshots(folder) or {int(model.meta["step"]): model.field}
    snapshots = {step: dense_grid(field) for step, field in found_fields.items()}
    fields: dict[int, Array] = {}
    with Progress("gradients", len(snapshots), [Column("loss", "{:.2e}".format)]) as bar:
        for number, (step, field) in enumerate(snapshots.items()):
            found = density_gradient(
                field, pixels, seed=seed, background=model.background, rays=rays
            )
            fields[step] = found.d_sigma_t
            bar.update(number + 1, loss=found.loss)
    return fields, snapshots


def dense_grid(field: FittedField) -> DenseGrid:
    """The field, if it is one whose gradient can be drawn voxel by voxel; else RangeError."""
    if not isinstance(field, DenseGrid):
        raise RangeError(message("gradients", "model", "a model of dense_grid", repr(field.name)))
    return field


def curves_of(model: Model) -> viz.FitCurves:
    """The history of a fit as curves, with its refinements marked."""
    from photograd_course import viz

    steps, loss, psnr = np.asarray(model.history).T
    still = isinstance(model.field, GaussianScene | OctreeSh)
    levels = {} if still else model.options.levels()
    events = {s: f"{r}³" for s, r in levels.items() if 0 < s <= steps[-1]}
    return viz.FitCurves(steps=steps.astype(int), loss=loss, psnr=psnr, events=events)

"""`photograd gradients`: pictures of the loss's gradient in space, and of how the fit went."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer
from numpy.typing import NDArray
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

from photograd._checkpoint import make_folder
from photograd._run_lock import one_run_in
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.commands.shared import (
    AllowOutsideOption,
    CaptureArgument,
    DownscaleOption,
    ModelArgument,
    out_option,
    use_threads,
)
from photograd.fields.voxel_field import VoxelField
from photograd.fitting.data import TrainingPixels, TrainingViews
from photograd.fitting.model import Model, load_model, load_snapshots
from photograd.fitting.view_gradients import grad2d_picture, view_gradients
from photograd.fitting.voxel_gradients import DensityGradient, density_gradient
from photograd.splats.clone_split_prune import CloneSplitPrune
from photograd.splats.model import GaussianScene
from photograd.types import Array

if TYPE_CHECKING:
    from photograd_course import viz

    from photograd.fitting.group_gradients import GroupGradients
    from photograd.fitting.sign_claim import SignClaim

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
    """Draw the gradient of the loss in every voxel or leaf, from the start of the fit to its end.

    Of Gaussians: where their means are pulled, which should be denser, and which will be split.
    Of a mesh: where its vertices are pulled, by silhouettes and inside of faces.

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
    make_folder(out)
    found = DRAWERS[model.field.gradient_picture](model, folder, capture, out, rays, seed)
    return {"out": out, **found}


def save_pictures(model: Model, pictures: dict[str, Any], out: Path) -> dict[str, Path]:
    """The files of some figures, and of the curves of the fit."""
    from photograd_course import viz

    if len(model.history) > 1:
        curves = viz.fit_curves(curves_of(model), title="How the fit went")
        pictures = {**pictures, "curves": curves}
    return {name: viz.save_figure(figure, out / f"{name}.png") for name, figure in pictures.items()}


def draw_voxels(
    model: Model, folder: Path, capture: Capture, out: Path, rays: int, seed: int
) -> dict[str, Any]:
    """The gradient in every voxel or leaf."""
    from photograd_course import viz

    steps = gradients_of_steps(model, folder, capture, rays, seed)
    explain = explanation(steps)
    result: dict[str, Any] = {"steps": list(steps.strongest)}
    claim = claim_of(steps.start, capture, rays, seed)
    gradient, outline, caption = steps.gradient.d_sigma_t, None, explain
    if claim is not None:
        gradient, outline, caption = claim.d_sigma_t, claim.occupied, claim.caption()
        result["occupied_negative"] = claim.report.occupied_fraction
        result["background_positive"] = claim.report.background_fraction
        result["views_of_signs"] = claim.views
    box, active, first = steps.start.box, steps.gradient.active, min(steps.strongest)
    pictures = {
        "gradient_slices": viz.signed_slices(
            gradient,
            box,
            outline=outline,
            active=active,
            caption=caption,
            title=f"Gradient of the loss at step {first}",
        ),
        "gradient_projections": viz.signed_projections(
            gradient,
            box,
            outline=outline,
            active=active,
            caption=caption,
            title=f"Largest gradient along each axis, step {first}",
        ),
        "gradient_steps": viz.projection_steps(
            steps.strongest,
            box,
            active=steps.active,
            common_scale=False,
            caption=explain,
            title="The gradient as the fit goes on",
        ),
    }
    return result | save_pictures(model, pictures, out)


def explanation(steps: StepGradients) -> str:
    """What the colors of these pictures mean."""
    sentences = [EXPLAIN]
    if steps.start.gradient_note:
        sentences.append(steps.start.gradient_note)
    if not all(mask.all() for mask in (steps.gradient.active, *steps.active.values())):
        sentences.append("Gray: nothing there to differentiate.")
    return " ".join(sentences)


def claim_of(start: VoxelField, capture: Capture, rays: int, seed: int) -> SignClaim | None:
    """The signs of the first gradient, weighed; None, with a note, where nothing can be claimed."""
    from photograd.fitting.sign_claim import sign_claim

    if not start.starts_empty:
        note("the fit began with the matter of another model: signs are shown, not weighed")
        return None
    claim = sign_claim(start, capture, rays=rays, seed=seed) if capture.has_alpha else None
    if claim is None:
        note("no voxel is known to be matter, or none to be empty: signs are shown, not weighed")
    return claim


def few_snapshots(model: Model, folder: Path) -> dict[int, Any]:
    """{step: field} of the first, the middle and the last snapshot of a fit."""
    found: dict[int, Any] = load_snapshots(folder) or {int(model.meta["step"]): model.field}
    steps = sorted(found)
    return {step: found[step] for step in sorted({steps[0], steps[len(steps) // 2], steps[-1]})}


def draw_groups(
    model: Model, folder: Path, capture: Capture, out: Path, rays: int, seed: int
) -> dict[str, Any]:
    """The gradient of any field, in pixels and groups, at three steps of its fit."""
    from photograd.fitting.group_gradients import draw_group_gradients

    rows = gradients_of_groups(model, folder, capture, rays, seed)
    pictures = {"group_gradients": draw_group_gradients(rows)}
    return {"steps": list(rows), **save_pictures(model, pictures, out)}


def draw_networks(
    model: Model, folder: Path, capture: Capture, out: Path, rays: int, seed: int
) -> dict[str, Any]:
    """The same of a field of networks, and by level and layer."""
    from photograd.fitting.group_gradients import draw_group_gradients
    from photograd.fitting.network_gradients import draw_layer_gradients, draw_level_gradients
    from photograd.network import HashEncoding

    field: Any = model.field
    rows = gradients_of_groups(model, folder, capture, rays, seed)
    networks = {"density": field.density, "color": field.color}
    inside = {step: found.gradients for step, found in rows.items()}
    pictures = {
        "group_gradients": draw_group_gradients(rows),
        "layer_gradients": draw_layer_gradients(inside, networks),
    }
    if isinstance(field.encoding, HashEncoding):
        tables = {step: gradients["table"] for step, gradients in inside.items()}
        pictures["level_gradients"] = draw_level_gradients(tables, field.encoding)
    return {"steps": list(rows), **save_pictures(model, pictures, out)}


def gradients_of_groups(
    model: Model, folder: Path, capture: Capture, rays: int, seed: int
) -> dict[int, GroupGradients]:
    """{step: gradients} of a few snapshots of a fit, under a progress bar."""
    from photograd.fitting.group_gradients import group_gradients

    chosen, rows = few_snapshots(model, folder), {}
    with Progress("gradients", len(chosen), [Column("loss", "{:.2e}".format)]) as bar:
        for number, (step, field) in enumerate(chosen.items()):
            rows[step] = group_gradients(model, field, capture, seed=seed, max_rays=rays)
            bar.update(number + 1, loss=rows[step].loss)
    return rows


def draw_gaussians(
    model: Model, folder: Path, capture: Capture, out: Path, rays: int, seed: int
) -> dict[str, Any]:
    """The picture of a fit of Gaussians at three of its steps, and its curves."""
    from photograd.fitting.gradient_drawings import draw_gaussian_gradients

    del rays, seed  # whole views, and nothing random
    views = TrainingViews(capture.train)
    chosen = few_snapshots(model, folder)
    rows = {}
    with Progress("gradients", len(chosen), [Column("loss", "{:.2e}".format)]) as bar:
        for number, step in enumerate(chosen):
            scene: GaussianScene = chosen[step]
            here = view_gradients(scene, views, 0, ssim_weight=model.options.ssim_weight)
            camera = views.views[0].camera
            rows[step] = here, grad2d_picture(scene.gaussians, here.grad2d, camera)
            bar.update(number + 1, loss=here.loss)
    pictures = {
        "gaussian_gradients": draw_gaussian_gradients(
            rows, threshold=CloneSplitPrune.threshold, title="What the loss asks of each Gaussian"
        )
    }
    return {"steps": list(chosen), **save_pictures(model, pictures, out)}


def draw_surface(
    model: Model, folder: Path, capture: Capture, out: Path, rays: int, seed: int
) -> dict[str, Any]:
    """The picture of a fit of a mesh at three of its steps, and its curves."""
    from photograd.fitting.surface_gradients import draw_surface_gradients, surface_gradients

    del rays, seed  # a whole view, and nothing random
    view = TrainingViews(capture.train).views[0]
    weight = model.options.ssim_weight
    rows = {
        step: surface_gradients(field, view, ssim_weight=weight)
        for step, field in few_snapshots(model, folder).items()
    }
    title = "What the loss asks of each vertex"
    pictures = {"surface_gradients": draw_surface_gradients(rows, title=title)}
    return {"steps": list(rows), **save_pictures(model, pictures, out)}


DRAWERS = {
    "voxels": draw_voxels,
    "gaussians": draw_gaussians,
    "surface": draw_surface,
    "networks": draw_networks,
    "groups": draw_groups,
}
"""What draws the gradient of a field, by its `gradient_picture`."""


@dataclass(frozen=True)
class StepGradients:
    """The gradient at the first of a fit's snapshots, and what its pictures need of all of them.

    `strongest` {step: (X, Y, 1)} is the largest gradient along z, `active` where that meets voxels:
    whole grids of all steps would take several times the memory of the fit.
    """

    start: VoxelField
    gradient: DensityGradient
    strongest: dict[int, Array]
    active: dict[int, NDArray[np.bool_]]


def gradients_of_steps(
    model: Model, folder: Path, capture: Capture, rays: int, seed: int
) -> StepGradients:
    """The gradients of every snapshot of a fit, in order, under a progress bar."""
    from photograd_course import viz

    pixels = TrainingPixels(capture.train, capture.color_space)
    fields: dict[int, Any] = load_snapshots(folder) or {int(model.meta["step"]): model.field}
    start: tuple[VoxelField, DensityGradient] | None = None
    strongest, active = {}, {}
    with Progress("gradients", len(fields), [Column("loss", "{:.2e}".format)]) as bar:
        for number, (step, field) in enumerate(sorted(fields.items())):
            found = density_gradient(
                field, pixels, seed=seed, background=model.background, rays=rays
            )
            start = start or (field, found)
            strongest[step] = viz.signed_projection(found.d_sigma_t, 2)[..., None]
            active[step] = np.asarray(found.active.any(axis=2, keepdims=True))
            bar.update(number + 1, loss=found.loss)
    assert start is not None
    return StepGradients(*start, strongest, active)


def curves_of(model: Model) -> viz.FitCurves:
    """The history of a fit as curves, with its refinements marked."""
    from photograd_course import viz

    steps, loss, psnr = np.asarray(model.history).T
    marked = model.field.events(model.options)
    events = {step: label for step, label in marked.items() if 0 < step <= steps[-1]}
    return viz.FitCurves(steps=steps.astype(int), loss=loss, psnr=psnr, events=events)

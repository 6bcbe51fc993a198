"""`photograd fit`: recover a scene from a capture."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import asdict, fields
from pathlib import Path
from typing import Annotated, Any

import typer
from photograd_course.cli import (
    Column,
    DebugOption,
    JsonOption,
    SeedOption,
    ThreadsOption,
    emit,
    note,
)

from photograd._checkpoint import FILE_NAME
from photograd._descend import LOSS_COLUMN, progress_bar, run_folder
from photograd._fit_options import FitOptions
from photograd._signals import stop_on_signals
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.commands.fit_image import fit_picture, is_picture
from photograd.commands.fit_mesh import (
    LaplacianOption,
    NormalConsistencyOption,
    OpacityOption,
    RemeshOption,
    read_mesh_for,
)
from photograd.commands.fit_options import (
    AllowBlindOption,
    BackgroundOption,
    CheckpointOption,
    DecodeOption,
    DegreeOption,
    DensityControlOption,
    FreezeOption,
    GaussiansOption,
    ImportanceOption,
    LearningRateOption,
    PruneOption,
    RaysOption,
    RepresentationOption,
    ResolutionOption,
    ResumeOption,
    StartFromOption,
    StepsOption,
    TotalVariationOption,
    ViewOption,
)
from photograd.commands.shared import (
    AllowOutsideOption,
    CaptureArgument,
    DownscaleOption,
    is_given,
    out_option,
    use_threads,
)
from photograd.commands.view_follow import shown_in_browser
from photograd.errors import RangeError, message
from photograd.fields import TexturedMesh
from photograd.fitting.checks import require_startable
from photograd.fitting.data import learned_background
from photograd.fitting.freeze import learn_freeze_refine
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import (
    FitResult,
    Progress,
    options_for,
    refuse_without_effect,
    summary,
)
from photograd.transport.mesh_files import SUFFIXES as MESH_SUFFIXES

DEFAULTS = FitOptions()


def _start(capture: Capture, options: FitOptions, first: Model | None, *, allow_blind: bool) -> Fit:
    """Begin a fit; its warnings become notes."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        job = Fit.start(capture, options, allow_blind=allow_blind, start_from=first)
    for warning in caught:
        note(f"warning: {warning.message}")
    note(job.start_rule)
    return job


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("fit")(fit)


def fit(
    context: typer.Context,
    capture: CaptureArgument,
    out: Annotated[Path, out_option("Folder for the model and its checkpoints.")],
    representation: RepresentationOption = DEFAULTS.representation,
    steps: StepsOption = None,
    resolution: ResolutionOption = None,
    rays: RaysOption = None,
    learning_rate: LearningRateOption = DEFAULTS.learning_rate,
    total_variation: TotalVariationOption = DEFAULTS.total_variation,
    degree: DegreeOption = None,
    prune: PruneOption = None,
    gaussians: GaussiansOption = DEFAULTS.gaussians,
    density_control: DensityControlOption = DEFAULTS.density_control,
    decode: DecodeOption = DEFAULTS.decode,
    importance: ImportanceOption = DEFAULTS.importance,
    laplacian: LaplacianOption = DEFAULTS.laplacian,
    normal_consistency: NormalConsistencyOption = DEFAULTS.normal_consistency,
    opacity: OpacityOption = DEFAULTS.opacity,
    remesh: RemeshOption = DEFAULTS.remesh,
    start_from: StartFromOption = None,
    freeze: FreezeOption = False,
    background: BackgroundOption = DEFAULTS.background,
    downscale: DownscaleOption = 1,
    allow_outside: AllowOutsideOption = False,
    checkpoint_seconds: CheckpointOption = 30.0,
    allow_blind: AllowBlindOption = False,
    view: ViewOption = False,
    resume: ResumeOption = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Recover a scene from photographs with known cameras, or fit a network to a picture.

    Writes OUT/model.npz: every 30 seconds, on Ctrl-C or SIGTERM, and at the end. --resume continues
    and ends with the same bits as a fit that was never interrupted. A fit of Gaussians also leaves
    OUT/gaussians.ply for other programs: with -y up, as they expect, and a learned background in a
    comment. A fit of a textured_mesh, whose vertices are held, of a mesh or of a textured_surface
    leaves OUT/mesh.glb.

    A warning says if all cameras look from nearly one direction, or stand at nearly one place: if
    their longest baseline is below a tenth of their distance from the scene, depth is uncertain.

    In the place of CAPTURE, a picture (.png, .jpg) is fitted by a network behind an encoding:
    --representation hash_grid, frequencies, nerf or one_blob, --resolution of the finest level,
    --rays pixels a step. OUT then holds image.npz and picture.png.

    Example: photograd fit photos --out model --steps 1500 --resolution 128
    """
    use_threads(threads)
    if is_picture(capture):
        fit_picture(context, capture, out)
        return
    if not resume:
        require_startable(representation)
    context.with_resource(run_folder("fit", out, FILE_NAME, resume=resume, argument="--out"))
    loaded = load_and_describe(capture, downscale, allow_outside=allow_outside)
    if resume:
        job = Fit.resume(loaded, out)
        refuse_other_options(context, job.options)
        note(f"resumed at step {job.step_number} of {job.options.steps}")
    else:
        given = [field.name for field in fields(FitOptions) if is_given(context, field.name)]
        refuse_without_effect(representation, given, prefix="--")
        chosen: dict[str, Any] = {"steps": steps, "resolution": resolution, "seed": seed}
        chosen |= {"learning_rate": learning_rate, "total_variation": total_variation}
        chosen |= {"background": background, "degree": degree, "prune": prune}
        chosen |= {"gaussians": gaussians, "density_control": density_control, "decode": decode}
        chosen |= {"importance": importance, "rays": rays, "opacity": opacity, "remesh": remesh}
        chosen |= {"laplacian": laplacian, "normal_consistency": normal_consistency}
        options = options_for(representation, **chosen)
        first = first_model(start_from, representation) if start_from else None
        job = _start(loaded, options, first, allow_blind=allow_blind)
    run_and_emit(job, out, checkpoint_seconds, freeze=freeze, view=view, as_json=as_json)


def run_and_emit(
    job: Fit, out: Path, checkpoint_seconds: float, *, freeze: bool, view: bool, as_json: bool
) -> None:
    """Run a fit, write what it leaves, and say how it went.

    Args:
        job: the fit.
        out: its folder.
        checkpoint_seconds: between two checkpoints.
        freeze: as for `run_and_score`.
        view: whether a browser can show it.
        as_json: whether the report is one line of JSON.

    Raises:
        typer.Exit: it was stopped.
    """
    with stop_on_signals() as stopping, shown_in_browser(job, out, view=view) as look:
        result, moments = run_and_score(
            job, out, stopping, checkpoint_seconds, freeze=freeze, look=look
        )
    emit(summary(result) | moments | exported(job, out), as_json=as_json, title="fit")
    if not result.finished:
        note(f"stopped at step {result.step}; continue with --resume")
        raise typer.Exit(stopping.exit_code or 1)


def run_and_score(
    job: Fit,
    out: Path,
    stopping: Callable[[], bool],
    checkpoint_seconds: float,
    *,
    freeze: bool,
    look: Callable[[Fit], None],
) -> tuple[FitResult, dict[str, Any]]:
    """Run a fit; with `freeze` also {"frozen": ..., "refined": ...}, once it has ended.

    Args:
        job: the fit.
        out: its folder.
        stopping: asked after each step.
        checkpoint_seconds: between two checkpoints.
        freeze: whether its structure is held once it is known, and both moments are scored.
        look: called with the fit after each step.
    """
    if not freeze:
        return run_with_bar(job, out, stopping, checkpoint_seconds, look), {}
    results = []

    def run(fit: Fit, folder: Path, enough: Callable[[], bool]) -> FitResult:
        either = lambda: stopping() or enough()  # noqa: E731
        results.append(run_with_bar(fit, folder, either, checkpoint_seconds, look))
        return results[-1]

    found = learn_freeze_refine(job, out, run=run)
    return results[-1], {} if found is None else asdict(found)


def first_model(path: Path, representation: str = TexturedMesh.name) -> Model:
    """What a fit starts from: a model, or a mesh without colors yet.

    What a mesh file holds that is not supported is said on stderr. Raises what `load_model`,
    `read_mesh_surface` or `read_textured_mesh` raises.
    """
    if path.suffix.lower() not in MESH_SUFFIXES:
        return load_model(path)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        field = read_mesh_for(representation, path)
    for warning in caught:
        note(f"{warning.message}")
    return Model.of(field)


def exported(job: Fit, out: Path) -> dict[str, str]:
    """Write a finished field for other programs, where it has a form for them, and say how."""
    name = job.model.exported_as
    if job.step_number < job.options.steps or not name:
        return {}
    behind = None if job.background is None else learned_background(job.background)
    for line in job.model.export(out / name, behind):
        note(f"{name}: {line}")
    return {job.model.name: str(out / name)}


def load_and_describe(folder: Path, downscale: int, *, allow_outside: bool = False) -> Capture:
    """Load a capture and say on stderr what was converted and assumed."""
    loaded = load_capture(folder, downscale=downscale, allow_outside=allow_outside)
    for line in loaded.conversions:
        note(line)
    note(
        f"{len(loaded.train)} training views, {len(loaded.test)} held out, "
        f"split {loaded.split_hash()}"
    )
    return loaded


def refuse_other_options(context: typer.Context, stored: FitOptions) -> None:
    """A resumed fit keeps its options: raise RangeError for one that says something else."""
    for field in fields(FitOptions):
        if not is_given(context, field.name):
            continue
        given, kept = context.params[field.name], getattr(stored, field.name)
        if given != kept:
            option = "--" + field.name.replace("_", "-")
            expected = f"{kept}, which the checkpoint was started with"
            raise RangeError(
                message("fit", option, expected, f"{given}", "leave it out with --resume")
            )


def run_with_bar(
    job: Fit,
    out: Path,
    stopping: Callable[[], bool],
    checkpoint_seconds: float = 30.0,
    look: Callable[[Fit], None] = lambda _: None,
) -> FitResult:
    """Run a fit under a live progress bar on stderr; `look` is called with it after each step."""
    columns = (
        LOSS_COLUMN,
        Column("psnr", "{:.2f} dB".format, label="PSNR"),
        Column("resolution", "{:.0f}".format, label=job.model.counts),
        Column("rays_per_second", "{:.2e}".format, label="rays/s"),
    )
    with progress_bar("fit", job, columns) as on_step:

        def after_step(progress: Progress) -> None:
            if on_step is not None:
                on_step(progress)
            look(job)

        return job.run(
            out, on_step=after_step, should_stop=stopping, checkpoint_seconds=checkpoint_seconds
        )

"""`photograd fit`: recover a scene from a capture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any, TypeAlias

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
from photograd_course.cli import Progress as Bar

from photograd._run_lock import one_run_in
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.commands.shared import (
    AllowOutsideOption,
    CaptureArgument,
    DownscaleOption,
    out_option,
    stop_on_signals,
    use_threads,
)
from photograd.errors import RangeError, message
from photograd.fitting.checkpoint import FILE_NAME
from photograd.fitting.checks import require_startable
from photograd.fitting.data import learned_background
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model
from photograd.fitting.options import (
    BACKGROUNDS,
    DEFAULTS_OF,
    DENSITY_CONTROLS,
    MOST_DEGREE,
    USERS_OF,
    FitOptions,
    FitResult,
    Progress,
    options_for,
    summary,
)
from photograd.fitting.start import FITTED
from photograd.splats.files import write_gaussians
from photograd.splats.frames import USUAL_UP, WORLD_UP, Presentation, half_turn
from photograd.splats.model import GaussianScene


def _defaults(option: str) -> str:
    """The default of an option, and of what has one of its own."""
    others = ", ".join(
        f"{name}: {given[option]}" for name, given in DEFAULTS_OF.items() if option in given
    )
    return f"{getattr(FitOptions(), option)}; {others}"


def _users(option: str) -> str:
    return ", ".join(USERS_OF[option])


RepresentationOption: TypeAlias = Annotated[
    str, typer.Option("--representation", help=f"How the scene is stored: {', '.join(FITTED)}.")
]
StepsOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--steps", min=1, help="Steps of gradient descent.", show_default=_defaults("steps")
    ),
]
ResolutionOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--resolution",
        min=8,
        help="Voxels along the longest edge.",
        show_default=_defaults("resolution"),
    ),
]
RaysOption: TypeAlias = Annotated[
    int, typer.Option("--rays", min=1, help="Rays a step; Gaussians take whole views.")
]
LearningRateOption: TypeAlias = Annotated[
    float, typer.Option("--learning-rate", help="Factor on the built-in rates.")
]
TotalVariationOption: TypeAlias = Annotated[
    float,
    typer.Option("--total-variation", min=0.0, help="Weight of the smoothness prior of grids."),
]
DegreeOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--degree",
        min=0,
        max=MOST_DEGREE,
        show_default=_defaults("degree"),
        help=f"Degree of the harmonics of {_users('degree')}.",
    ),
]
PruneOption: TypeAlias = Annotated[
    float,
    typer.Option(
        "--prune",
        min=0.0,
        help=f"Drop voxels of {_users('prune')} that weigh less in every pixel; 0: none.",
    ),
]
GaussiansOption: TypeAlias = Annotated[
    int, typer.Option("--gaussians", min=1, help="Most Gaussians that there may be.")
]
DensityControlOption: TypeAlias = Annotated[
    str, typer.Option("--density-control", help=f"Of Gaussians: {', '.join(DENSITY_CONTROLS)}.")
]
StartFromOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--start-from",
        help="Model on whose surfaces Gaussians begin, or from whose voxels an octree is cut.",
        metavar="MODEL",
    ),
]
BackgroundOption: TypeAlias = Annotated[
    str, typer.Option("--background", help=f"auto, {', '.join(BACKGROUNDS)}.")
]
CheckpointOption: TypeAlias = Annotated[
    float, typer.Option("--checkpoint-seconds", min=0.0, help="Time between checkpoints.")
]
AllowBlindOption: TypeAlias = Annotated[
    bool, typer.Option("--allow-blind", help="Fit even if some cameras do not see the scene.")
]
ResumeOption: TypeAlias = Annotated[
    bool, typer.Option("--resume", help="Continue the fit in --out; its options are kept.")
]


# `photograd fit`: recover a scene from a capture.


PLY_NAME = "gaussians.ply"
DEFAULTS = FitOptions()
COLUMNS = (
    Column("loss", "{:.2e}".format),
    Column("psnr", "{:.2f} dB".format, label="PSNR"),
    Column("grid", "{:.0f}".format),
    Column("rate", "{:.2e}".format, label="rays/s"),
)
SPLAT_COLUMNS = tuple(
    Column("grid", "{:.0f}".format, label="Gaussians") if column.name == "grid" else column
    for column in COLUMNS
)


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
    rays: RaysOption = DEFAULTS.rays,
    learning_rate: LearningRateOption = DEFAULTS.learning_rate,
    total_variation: TotalVariationOption = DEFAULTS.total_variation,
    degree: DegreeOption = None,
    prune: PruneOption = DEFAULTS.prune,
    gaussians: GaussiansOption = DEFAULTS.gaussians,
    density_control: DensityControlOption = DEFAULTS.density_control,
    start_from: StartFromOption = None,
    background: BackgroundOption = DEFAULTS.background,
    downscale: DownscaleOption = 1,
    allow_outside: AllowOutsideOption = False,
    checkpoint_seconds: CheckpointOption = 30.0,
    allow_blind: AllowBlindOption = False,
    resume: ResumeOption = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Recover a scene from photographs with known cameras.

    Writes OUT/model.npz: every 30 seconds, on Ctrl-C or SIGTERM, and at the end. --resume continues
    and ends with the same bits as a fit that was never interrupted. A fit of Gaussians also leaves
    OUT/gaussians.ply for other programs: with -y up, as they expect, and a learned background in a
    comment.

    Example: photograd fit photos --out model --steps 1500 --resolution 128
    """
    use_threads(threads)
    context.with_resource(one_run_in("fit", out))
    if not resume:
        require_startable(representation)
        refuse_to_overwrite(out)
    loaded = load_and_describe(capture, downscale, allow_outside=allow_outside)
    if resume:
        job = Fit.resume(loaded, out)
        refuse_other_options(context, job.options)
        note(f"resumed at step {job.step_number} of {job.options.steps}")
    else:
        refuse_without_effect(context, representation)
        chosen: dict[str, Any] = {"steps": steps, "resolution": resolution}
        chosen |= {"rays": rays, "seed": seed}
        chosen |= {"learning_rate": learning_rate, "total_variation": total_variation}
        chosen |= {"background": background, "degree": degree, "prune": prune}
        chosen |= {"gaussians": gaussians, "density_control": density_control}
        options = options_for(representation, **chosen)
        first = load_model(start_from) if start_from else None
        job = Fit.start(loaded, options, allow_blind=allow_blind, start_from=first)
        note(job.start_rule)
    with stop_on_signals() as stopping:
        result = run_with_bar(job, out, stopping, checkpoint_seconds)
    emit(summary(result) | exported(job, out), as_json=as_json, title="fit")
    if not result.finished:
        note(f"stopped at step {result.step}; continue with --resume")
        raise typer.Exit(stopping.exit_code or 1)


def exported(job: Fit, out: Path) -> dict[str, str]:
    """Write finished Gaussians for other programs, and say how; {"gaussians": path} if there are
    any. Half a turn about x takes the world, +y up, to the frame of such files.
    """
    scene = job.model
    if job.step_number < job.options.steps or not isinstance(scene, GaussianScene):
        return {}
    behind = None if job.background is None else learned_background(job.background)
    presentation = Presentation.of_fit(USUAL_UP, behind, antialiased=scene.policy.antialiased)
    write_gaussians(out / PLY_NAME, half_turn(scene.gaussians), presentation=presentation)
    kept = "" if behind is None else "; the learned background is in its header"
    note(f"{PLY_NAME}: {USUAL_UP} is up, as other programs expect, {WORLD_UP} in the model{kept}")
    return {"gaussians": str(out / PLY_NAME)}


def refuse_to_overwrite(out: Path) -> None:
    """Raise RangeError if `out` holds a model already."""
    if (out / FILE_NAME).exists():
        raise RangeError(
            message(
                "fit",
                "--out",
                "a folder without a model",
                f"{out}, which holds one",
                "add --resume to continue it, or choose another folder",
            )
        )


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


def refuse_without_effect(context: typer.Context, representation: str) -> None:
    """Raise RangeError for an option that is given and means nothing to the representation."""
    for name, users in USERS_OF.items():
        source = context.get_parameter_source(name)
        if source is not None and source.name == "COMMANDLINE" and representation not in users:
            raise RangeError(
                message(
                    "fit",
                    f"--{name}",
                    f"a fit of {' or '.join(users)}",
                    repr(representation),
                    "leave it out, it has no effect here",
                )
            )


def refuse_other_options(context: typer.Context, stored: FitOptions) -> None:
    """A resumed fit keeps its options: raise RangeError for one that says something else."""
    for field in fields(FitOptions):
        source = context.get_parameter_source(field.name)
        if source is None or source.name != "COMMANDLINE":
            continue
        given, kept = context.params[field.name], getattr(stored, field.name)
        if given != kept:
            option = "--" + field.name.replace("_", "-")
            expected = f"{kept}, which the checkpoint was started with"
            raise RangeError(
                message("fit", option, expected, f"{given}", "leave it out with --resume")
            )


def run_with_bar(
    job: Fit, out: Path, stopping: Callable[[], bool], checkpoint_seconds: float = 30.0
) -> FitResult:
    """Run a fit under a live progress bar on stderr."""
    columns = SPLAT_COLUMNS if isinstance(job.model, GaussianScene) else COLUMNS
    with Bar("fit", job.options.steps, columns) as bar:

        def on_step(now: Progress) -> None:
            bar.update(
                now.step,
                loss=now.loss,
                psnr=now.psnr,
                grid=now.resolution,
                rate=now.rays_per_second,
            )

        return job.run(
            out, on_step=on_step, should_stop=stopping, checkpoint_seconds=checkpoint_seconds
        )

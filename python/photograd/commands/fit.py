"""`photograd fit`: recover a scene from a capture."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Annotated

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

from photograd.checkpoint import FILE_NAME
from photograd.commands.shared import (
    CaptureArgument,
    DownscaleOption,
    StopRequest,
    stop_on_signals,
    use_threads,
)
from photograd.data.capture import Capture
from photograd.data.load import load_capture
from photograd.errors import RangeError, message
from photograd.fit import Fit
from photograd.fit_options import FitOptions
from photograd.fit_result import FitResult, Progress, summary

DEFAULTS = FitOptions()
COLUMNS = (
    Column("loss", "{:.2e}".format),
    Column("psnr", "{:.2f} dB".format, label="PSNR"),
    Column("grid", "{:.0f}".format),
    Column("rate", "{:.2e}".format, label="rays/s"),
)


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("fit")(fit)


def fit(
    context: typer.Context,
    capture: CaptureArgument,
    out: Annotated[Path, typer.Option("--out", help="Folder for the model and its checkpoints.")],
    representation: Annotated[
        str, typer.Option("--representation", help="How the scene is stored.")
    ] = DEFAULTS.representation,
    steps: Annotated[
        int, typer.Option("--steps", min=1, help="Steps of gradient descent.")
    ] = DEFAULTS.steps,
    resolution: Annotated[
        int, typer.Option("--resolution", min=8, help="Voxels along the longest edge.")
    ] = DEFAULTS.resolution,
    rays: Annotated[int, typer.Option("--rays", min=1, help="Rays a step.")] = DEFAULTS.rays,
    learning_rate: Annotated[
        float, typer.Option("--learning-rate", help="Factor on the built-in rates.")
    ] = DEFAULTS.learning_rate,
    total_variation: Annotated[
        float, typer.Option("--total-variation", min=0.0, help="Weight of the smoothness prior.")
    ] = DEFAULTS.total_variation,
    background: Annotated[
        str, typer.Option("--background", help="auto, random, white, black or learned.")
    ] = DEFAULTS.background,
    downscale: DownscaleOption = 1,
    checkpoint_seconds: Annotated[
        float, typer.Option("--checkpoint-seconds", min=0.0, help="Time between checkpoints.")
    ] = 30.0,
    allow_blind: Annotated[
        bool, typer.Option("--allow-blind", help="Fit even if some cameras do not see the scene.")
    ] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Continue the fit in --out; its options are kept.")
    ] = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Recover a scene from photographs with known cameras.

    Writes OUT/model.npz: every 30 seconds, on Ctrl-C or SIGTERM, and at the end. --resume continues
    and ends with the same bits as a fit that was never interrupted.

    Example: photograd fit photos --out model --steps 1500 --resolution 128
    """
    use_threads(threads)
    if not resume:
        refuse_to_overwrite(out)
    loaded = load_and_describe(capture, downscale)
    if resume:
        job = Fit.resume(loaded, out)
        refuse_other_options(context, job.options)
        note(f"resumed at step {job.step_number} of {job.options.steps}")
    else:
        options = FitOptions(
            representation=representation, steps=steps, resolution=resolution, rays=rays, seed=seed,
            learning_rate=learning_rate, total_variation=total_variation, background=background,
        )  # fmt: skip
        job = Fit.start(loaded, options, allow_blind=allow_blind)
        note(job.start_rule)
    with stop_on_signals() as stopping:
        result = run_with_bar(job, out, stopping, checkpoint_seconds)
    emit(summary(result), as_json=as_json, title="fit")
    if not result.finished:
        note(f"stopped at step {result.step}; continue with --resume")
        raise typer.Exit(stopping.exit_code or 1)


def refuse_to_overwrite(out: Path) -> None:
    """Raise RangeError if `out` holds a model already."""
    if (out / FILE_NAME).exists():
        raise RangeError(
            message("fit", "--out", "a folder without a model", f"{out}, which holds one",
                    "add --resume to continue it, or choose another folder")
        )  # fmt: skip


def load_and_describe(folder: Path, downscale: int) -> Capture:
    """Load a capture and say on stderr what was converted and assumed."""
    loaded = load_capture(folder, downscale=downscale)
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
    job: Fit, out: Path, stopping: StopRequest, checkpoint_seconds: float = 30.0
) -> FitResult:
    """Run a fit under a live progress bar on stderr."""
    with Bar("fit", job.options.steps, COLUMNS) as bar:

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

"""`photograd recover`: materials, textures and lights of a path traced scene, from pictures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from photograd_course.atomic_io import atomic_write
from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit, note

from photograd._checks import typed
from photograd._descend import progress_bar, run_folder
from photograd._signals import StopRequest, stop_on_signals
from photograd.caustics.options import RATES
from photograd.caustics.state import FILE_NAME as LENS_FILE_NAME
from photograd.commands.recover_caustic import lens_name, options_of, recover_lens
from photograd.commands.shared import DepthOption, StepsOption, out_option, use_threads
from photograd.commands.trace import SceneArgument, load_scene
from photograd.errors import IoError, RangeError, message
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.read import read_radiance
from photograd.images.write import write_exr
from photograd.transport.inverse import (
    InverseRendering,
    Parameter,
    RecoveryOptions,
    RecoveryResult,
    Target,
)
from photograd.transport.inverse.job import FILE_NAME
from photograd.transport.inverse.options import LOSSES, Loss
from photograd.transport.path_options import PathOptions
from photograd.transport.scene_file import read_scene
from photograd.transport.tracer import PathTracer

DEFAULTS = RecoveryOptions()
LOOK_SPP = 64  # samples a pixel of the picture that is shown beside the target
TargetOption = Annotated[
    list[Path],
    typer.Option(
        "--target", help="A picture to match, linear: .exr, .hdr or .pfm; may be repeated."
    ),
]
CameraOption = Annotated[
    list[Path] | None,
    typer.Option("--camera-from", help="A scene file whose camera took a target; one for each."),
]
ParameterOption = Annotated[
    list[str],
    typer.Option(
        "--parameter",
        help="A parameter to find: materials.NAME.PARAMETER, textures.NAME, emission.SHAPE, "
        "lights.INDEX.PARAMETER; NAME=0.5 begins at a value. May be repeated. Refused where the "
        "derivative is incomplete: eta of smooth glass, a mask's alpha. Or, alone, "
        "shapes.NAME.heights of a box of glass: the target is then the light on --receiver.",
    ),
]
OutOption = Annotated[Path, out_option("Folder for the result and checkpoints.")]
SppOption = Annotated[
    int, typer.Option("--spp", min=1, help="Samples a pixel of each of a step's two halves.")
]
RateOption = Annotated[
    float | None,
    typer.Option(
        "--learning-rate",
        help="Of Adam, at the first step.",
        show_default=f"{DEFAULTS.learning_rate}; of heights 0.01 from transport, 0.3 from plane",
    ),
]
ReceiverOption = Annotated[
    str | None,
    typer.Option("--receiver", help="With shapes.NAME.heights: the rectangle that is lit."),
]
StartOption = Annotated[str, typer.Option("--start", help=f"Of heights: {', '.join(RATES)}.")]
LossOption = Annotated[
    str, typer.Option("--loss", help=f"What is made small: {', '.join(LOSSES)}.")
]
ViewsOption = Annotated[
    int, typer.Option("--views", min=0, help="Targets a step looks at; 0 looks at all.")
]
SizeOption = Annotated[
    int | None,
    typer.Option(
        "--size",
        min=1,
        help="Pixels along an edge of a built-in scene.",
        show_default="the target's",
    ),
]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Go on with the recovery in --out.")]


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("recover")(recover)


def recover(
    context: typer.Context,
    scene: SceneArgument,
    target: TargetOption,
    parameter: ParameterOption,
    out: OutOption,
    camera: CameraOption = None,
    steps: StepsOption = DEFAULTS.steps,
    spp: SppOption = DEFAULTS.spp,
    learning_rate: RateOption = None,
    loss: LossOption = DEFAULTS.loss,
    max_depth: DepthOption = DEFAULTS.path.max_depth,
    views: ViewsOption = DEFAULTS.views,
    size: SizeOption = None,
    receiver: ReceiverOption = None,
    start: StartOption = "transport",
    resume: ResumeOption = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Recover parameters of a path traced scene from pictures of it.

    SCENE says all that is known, and first guesses of what is not. Writes OUT/recovery.npz every 30
    seconds and on Ctrl-C, from which --resume goes on to the same bits; at the end OUT/found.json,
    pictures of textures and maps, curves.png and comparison.png. Of heights: OUT/lens.stl in
    millimeters, heights.exr in meters, comparison.png and found.json.

    Example: photograd recover cornell-box --target cornell.exr --parameter materials.red.albedo=0.5
    --out found
    """
    use_threads(threads)
    lens = lens_name(parameter)
    state = FILE_NAME if lens is None else LENS_FILE_NAME
    context.with_resource(run_folder("recover", out, state, resume=resume, argument="--out"))
    images = [read_target(path) for path in target]
    described, _ = load_scene(scene, size or max(images[0].shape[:2]))
    if lens is not None:
        design = options_of(start=start, steps=steps, learning_rate=learning_rate, seed=seed)
        with stop_on_signals() as stopping:
            said = recover_lens(
                described, lens, receiver, images, design, out, resume=resume, stopping=stopping
            )
        finish(said, said["step"], steps, stopping, as_json=as_json)
        return
    targets = with_cameras(images, camera)
    options = RecoveryOptions(
        steps=steps,
        spp=spp,
        learning_rate=DEFAULTS.learning_rate if learning_rate is None else learning_rate,
        loss=typed("recover", "--loss", Loss, loss),
        views=views,
        seed=seed,
        path=PathOptions(max_depth=max_depth),
    )
    job = InverseRendering(described, targets, [parsed(text) for text in parameter], options)
    if resume:
        job.load(out)
        note(f"resumed at step {job.step_number} of {steps}")
    with stop_on_signals() as stopping:
        result = run_with_bar(job, out, stopping)
    finish(write_result(job, result, out), result.step, steps, stopping, as_json=as_json)


def finish(
    said: dict[str, Any], step: int, steps: int, stopping: StopRequest, *, as_json: bool
) -> None:
    """Print the last line; a run that was stopped ends with the status of its signal."""
    emit(said, as_json=as_json, title="recover")
    if step < steps:
        note(f"stopped at step {step} of {steps}; continue with --resume")
        raise typer.Exit(stopping.exit_code or 1)


def with_cameras(images: list[Any], paths: list[Path] | None) -> list[Target]:
    """Targets, each with the camera of a scene file, if there are any.

    Raises:
        RangeError: another number of files than of pictures.
    """
    if paths and len(paths) != len(images):
        expected = f"one for each of {len(images)} targets"
        raise RangeError(message("recover", "--camera", expected, len(paths)))
    cameras = [read_scene(path).camera for path in paths] if paths else [None] * len(images)
    return [Target(image, taken) for image, taken in zip(images, cameras, strict=True)]


def read_target(path: Path) -> Any:
    """(H, W, 3) linear, of an .exr, .hdr or .pfm.

    Raises:
        IoError: another suffix, or a damaged file.
    """
    if path.suffix.lower() not in LINEAR_SUFFIXES:
        remedy = "photographs of 8 bits are clipped at white; 'photograd trace' writes .exr"
        expected = f"a linear {' or '.join(LINEAR_SUFFIXES)}"
        raise IoError(message("recover", "--target", expected, path, remedy))
    return read_radiance(path).astype(np.float64)


def parsed(text: str) -> Parameter:
    """NAME, NAME=NUMBER or NAME=NUMBER,NUMBER,NUMBER.

    Raises:
        RangeError: something else.
    """
    name, given, value = text.partition("=")
    if not given:
        return Parameter(name)
    try:
        numbers = [float(part) for part in value.split(",")]
    except ValueError as failure:
        expected = "NAME, NAME=NUMBER or NAME=NUMBER,NUMBER,NUMBER"
        raise RangeError(message("recover", "--parameter", expected, text)) from failure
    return Parameter(name, start=numbers if len(numbers) > 1 else numbers[0])


def run_with_bar(job: InverseRendering, out: Path, stopping: StopRequest) -> RecoveryResult:
    """Run under a live progress bar on stderr."""
    with progress_bar("recover", job) as on_step:
        return job.run(out, on_step=on_step, should_stop=stopping)


def write_result(job: InverseRendering, result: RecoveryResult, out: Path) -> dict[str, Any]:
    """Values, pictures and curves in `out`; what the last line says."""
    from photograd_course.viz import save_figure

    from photograd.transport.inverse.pictures import comparison_figure, curves_figure

    found: dict[str, Any] = {}
    for name, value in result.params.items():
        if value.ndim == 3 and value.shape[2] == 3:
            write_exr(out / f"{name}.exr", value.astype(np.float32))
            found[name] = f"{name}.exr"
        else:
            found[name] = np.round(value, 6).tolist()
    text = json.dumps({"step": result.step, "found": found}, indent=1)
    atomic_write(out / "found.json", text.encode())
    first = job.targets[0]
    tracer = PathTracer(result.scene)
    picture = tracer.render(
        spp=LOOK_SPP, seed=job.options.seed, options=job.options.path, camera=first.camera
    ).mean
    save_figure(comparison_figure(first.image, picture), out / "comparison.png")
    if result.step:
        save_figure(curves_figure(result), out / "curves.png")
    difference = float(np.sqrt(np.square(picture - first.image).mean()))
    return {
        "out": out,
        "step": result.step,
        "seconds": round(result.seconds, 3),
        "rms_of_first_picture": difference,
        **{name: value for name, value in found.items() if np.size(value) <= 3},
    }

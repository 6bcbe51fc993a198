"""`photograd trace`: a picture of a described scene, by path tracing."""

from __future__ import annotations

import math
import time
import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

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
from photograd_course.color import srgb_encode

from photograd._checks import typed
from photograd._signals import StopRequest, stop_on_signals
from photograd.commands.drawable import check_traced
from photograd.commands.shared import (
    PICTURES,
    SIGNED_PICTURES,
    DepthOption,
    RadiusOption,
    SppOption,
    hold_output,
    out_option,
    use_threads,
)
from photograd.commands.trace_estimates import (
    INTEGRATORS,
    DerivativeOption,
    Estimate,
    PhotonsOption,
    write_derivative,
)
from photograd.commands.trace_settings import SetOption, traced
from photograd.errors import SceneError, message
from photograd.images.kind import LINEAR_SUFFIXES, MAX_SIDE
from photograd.images.write import write_png, write_radiance
from photograd.transport.accumulation import Accumulation, load_accumulation
from photograd.transport.builtin import BUILTIN, builtin_scene
from photograd.transport.mesh_files import STUDIO, SUFFIXES, default_scene, read_model
from photograd.transport.path_options import (
    HEURISTICS,
    STRATEGIES,
    Heuristic,
    PathOptions,
    Strategy,
)
from photograd.transport.scene import Scene
from photograd.transport.scene_digest import scene_digest
from photograd.transport.scene_file import read_scene

CameraOption = Annotated[
    str | None,
    typer.Option(
        "--camera",
        help=f"Of a mesh file: its camera of this name, by default its first, or '{STUDIO}'.",
    ),
]


def check_has_cameras(scene: str, camera: str | None) -> None:
    """Only mesh files have cameras of several names.

    Raises:
        SceneError: a camera of another scene.
    """
    if camera is not None and not scene.lower().endswith(SUFFIXES):
        expected = f"a mesh file ({', '.join(SUFFIXES)}) with --camera"
        raise SceneError(message("trace", "SCENE", expected, scene, "leave the option out"))


# `photograd trace`: a picture of a described scene, by path tracing.


PASS_SPP = 8
"""Samples between two looks at the clock; a resumed picture is cut at the same places."""
SAVE_SECONDS = 10.0
DARK = "all is black: does something shine there, and is the camera inside of a closed shape?"

SceneArgument = Annotated[
    str,
    typer.Argument(
        help=f"A scene file (.toml), a mesh file ({', '.join(SUFFIXES)}), or a built-in scene: "
        f"{', '.join(BUILTIN)}.",
        metavar="SCENE",
    ),
]
OutOption = Annotated[Path, out_option("The picture: .exr, .hdr or .pfm, or .png alone.")]
SizeOption = Annotated[
    int,
    typer.Option(
        "--size",
        min=1,
        max=MAX_SIDE,
        help="Pixels along an edge of a built-in scene, along the longer one for a mesh file.",
    ),
]
IntegratorOption = Annotated[
    str, typer.Option("--integrator", help=f"What is estimated: {', '.join(INTEGRATORS)}.")
]
StrategyOption = Annotated[
    str, typer.Option("--strategy", help=f"How lights are found: {', '.join(STRATEGIES)}.")
]
HeuristicOption = Annotated[
    str, typer.Option("--heuristic", help=f"How mis weighs: {', '.join(HEURISTICS)}.")
]
ResumeOption = Annotated[
    bool, typer.Option("--resume", help="Add samples to those of an earlier run.")
]


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("trace")(trace)


def trace(
    context: typer.Context,
    scene: SceneArgument,
    out: OutOption = Path("image.exr"),
    spp: SppOption = 64,
    size: SizeOption = 256,
    camera: CameraOption = None,
    settings: SetOption = None,
    integrator: IntegratorOption = "path",
    strategy: StrategyOption = "mis",
    heuristic: HeuristicOption = "power",
    max_depth: DepthOption = 64,
    radius: RadiusOption = math.inf,
    photons: PhotonsOption = 200_000,
    derivative: DerivativeOption = "",
    resume: ResumeOption = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Path trace a scene.

    A mesh file is seen by its own camera and lit by its own lights; without them, or with --camera
    studio, from in front and above, under a pale sky and one light. What it has and cannot be drawn
    is named.

    Writes the linear picture and a PNG preview beside it every ten seconds, and OUT.sums.npz,
    from which --resume goes on: after Ctrl-C, or for more samples.

    With --derivative, what is written is how every pixel changes with one parameter instead: signed
    in the picture, red where it grows and blue where it falls in the PNG.

    Example: photograd trace cornell-box --spp 256 --out cornell.exr
    """
    use_threads(threads)
    sums_path = out.with_suffix(".sums.npz")
    kinds = SIGNED_PICTURES if derivative else PICTURES
    hold_output(context, "trace", out, kinds, beside=[out.with_suffix(".png"), sums_path])
    options = PathOptions(
        typed("trace", "--strategy", Strategy, strategy),
        typed("trace", "--heuristic", Heuristic, heuristic),
        2 if integrator == "direct" else max_depth,
    )
    estimate = Estimate(integrator, options, seed, radius, photons, derivative)
    described, fingerprint = load_scene(scene, size, camera)
    key = {
        "scene": " ".join([fingerprint, *(settings or [])]),
        "seed": seed,
        "integrator": integrator,
        "radius": repr(radius),
        **asdict(options),
        **estimate.key,
    }
    if resume:
        sums = load_accumulation(sums_path, key)
        note(f"resumed at {sums.count} of {spp} samples")
    else:
        sums = Accumulation.empty(described.camera.height, described.camera.width)
    add = estimate.adder(traced(described, settings or []), sums)

    def save() -> None:
        sums.save(sums_path, key)
        (write_derivative if derivative else write_pictures)(sums, out)

    with stop_on_signals() as stopping:
        seconds = _run(add, save, sums, spp, stopping)
    _report(sums, out, spp, seconds, as_json=as_json)
    if sums.count and not derivative and not sums.radiance.any():
        note(DARK)
    if sums.count < spp:
        raise typer.Exit(stopping.exit_code or 1)


def _report(sums: Accumulation, out: Path, spp: int, seconds: float, *, as_json: bool) -> None:
    """What was made, how noisy it is, and how to go on."""
    result: dict[str, Any] = {"out": out, "spp": sums.count, "seconds": round(seconds, 3)}
    if sums.count > 1:
        result["noise"] = f"{100 * sums.noise:.2f} %"
    emit(result, as_json=as_json, title="trace")
    if sums.count < spp:
        note(f"stopped at {sums.count} of {spp} samples; continue with --resume")


def write_pictures(sums: Accumulation, out: Path) -> None:
    """The mean, linear, unless `out` is a .png; and display-encoded as PNG beside it."""
    mean = sums.mean
    if out.suffix.lower() in LINEAR_SUFFIXES:
        write_radiance(out, mean.astype(np.float32))
    write_png(out.with_suffix(".png"), srgb_encode(np.clip(mean, 0.0, 1.0)).astype(np.float32))


def _percent(noise: float) -> str:
    """One sample says nothing of the noise."""
    return "unknown" if math.isnan(noise) else f"{100 * noise:.1f} %"


def _run(add: Any, save: Any, sums: Accumulation, spp: int, stopping: StopRequest) -> float:
    """Adds passes until there are `spp` samples or a signal arrives; seconds that took."""
    began = saved = time.monotonic()
    columns = [Column("noise", _percent)]
    start = min(sums.count, spp)
    with Progress("trace", spp, columns, start=start) as bar:
        while sums.count < spp and not stopping():
            add(min(PASS_SPP - sums.count % PASS_SPP, spp - sums.count))
            bar.update(sums.count, noise=sums.noise if sums.count > 1 else float("nan"))
            if time.monotonic() - saved > SAVE_SECONDS:
                save()
                saved = time.monotonic()
    seconds = time.monotonic() - began
    if sums.count:
        save()
    return seconds


def load_scene(name: str, size: int, camera: str | None = None) -> tuple[Scene, str]:
    """The scene of an argument SCENE, and a text that changes with it; warnings become notes.

    Raises:
        SceneError, IoError, RangeError: no such scene or camera, or what 'photograd render' draws.
    """
    check_has_cameras(name, camera)
    check_traced(name)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        if name in BUILTIN:
            loaded = builtin_scene(name, size), f"{name} {size}"
        elif not name.lower().endswith((".toml", *SUFFIXES)) and not Path(name).exists():
            loaded = builtin_scene(name, size), ""  # says what the names are
        else:
            path = Path(name)
            meshes = path.suffix.lower() in SUFFIXES
            scene = (
                default_scene(read_model(path), path.stem, size, camera=camera)
                if meshes
                else read_scene(path)
            )
            loaded = scene, scene_digest(scene)
    for warning in caught:
        note(f"{warning.message}")
    return loaded

"""`photograd vectorize`: a picture as curves."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit, note

from photograd._checkpoint import holds_steps
from photograd._signals import stop_on_signals
from photograd.commands.fit_image import opaque
from photograd.commands.shared import StepsOption, hold_output, out_option, use_threads
from photograd.errors import RangeError, message
from photograd.fitting.loss import decibels
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.read import downscale_image, read_image
from photograd.types import FloatArray

CHECKPOINT_SECONDS = 2.0
"""Of curves they are small."""


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("vectorize")(vectorize)


def vectorize(
    context: typer.Context,
    picture: Annotated[Path, typer.Argument(help="A photograph: .png or .jpg.", metavar="PICTURE")],
    out: Annotated[Path, out_option("SVG file for the curves.")] = Path("out/curves.svg"),
    curves: Annotated[int, typer.Option("--curves", min=1, help="Curves.")] = 200,
    kind: Annotated[
        str, typer.Option("--kind", help="stroke: lines with a width; fill: closed shapes.")
    ] = "stroke",
    steps: StepsOption = 300,
    size: Annotated[
        int, typer.Option("--size", min=8, help="Longest edge in pixels that is fitted.")
    ] = 256,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the curves that an earlier run left.")
    ] = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Draw a picture with curves: fit their control points, widths and colors, and write SVG.

    Larger pictures are reduced first, by a whole number. Colors are fitted as viewers of SVG
    composite them. Ctrl-C writes what has been found so far. OUT.fit holds a checkpoint until the
    end, from which --resume goes on to the same curves, also after a power cut.

    Example: photograd vectorize photo.png --curves 200 --out out/photo.svg
    """
    from photograd.vector.fit import CURVE_KINDS, DRAWING_FILE, VectorFitOptions, fit_curves
    from photograd.vector.svg_write import write_svg

    chosen = next((each for each in CURVE_KINDS if each == kind), None)
    if chosen is None:
        expected = " or ".join(CURVE_KINDS)
        raise RangeError(message("vectorize", "--kind", expected, repr(kind)))
    hold_output(context, "vectorize", out, (".svg",), parents=True)
    checkpoint = out.with_suffix(".fit") / DRAWING_FILE
    _check_resume(checkpoint, resume=resume)
    use_threads(threads)
    target = _target(picture, size)
    height, width = target.shape[:2]
    note(f"{curves} curves, {width} x {height} pixels")
    behind = target.mean(axis=(0, 1))
    with stop_on_signals() as stopping:
        found = fit_curves(
            target,
            curves,
            VectorFitOptions(steps=steps, seed=seed),
            kind=chosen,
            background=behind,
            folder=checkpoint.parent,
            resume=resume,
            bar=True,
            should_stop=stopping,
            checkpoint_seconds=CHECKPOINT_SECONDS,
        )
    write_svg(out, found.drawing, (height, width), linear=False, background=behind)
    psnr, seconds = round(decibels(found.loss), 3), round(found.seconds, 2)
    report = {"svg": out, "bytes": out.stat().st_size, "step": len(found.losses), "psnr": psnr}
    emit(report | {"seconds": seconds}, as_json=as_json, title="vectorize")
    if not found.finished:
        note(f"stopped at step {len(found.losses)} of {steps}; continue with --resume")
        raise typer.Exit(stopping.exit_code or 1)
    checkpoint.unlink()
    with suppress(OSError):  # somebody else's files are in it
        checkpoint.parent.rmdir()


def _target(picture: Path, size: int) -> FloatArray:
    """(H, W, 3) display values over white, reduced to at most `size` pixels along an edge."""
    if picture.suffix.lower() in LINEAR_SUFFIXES:
        expected, remedy = "display values", "convert it to .png first"
        raise RangeError(message("vectorize", "PICTURE", expected, f"{picture}", remedy))
    pixels = read_image(picture)
    times = math.ceil(max(pixels.shape[:2]) / size)
    reduced = downscale_image(pixels, times)[0] if times > 1 else pixels
    return opaque(reduced).astype(np.float64)


def _check_resume(checkpoint: Path, *, resume: bool) -> None:
    """Raise RangeError for a checkpoint that nobody asked for, or that is not there."""
    if resume and not checkpoint.exists():
        expected, remedy = "a run that was stopped", "leave it out to begin"
        raise RangeError(message("vectorize", "--resume", expected, f"no {checkpoint}", remedy))
    if not resume and holds_steps(checkpoint):
        remedy = "add --resume to continue it, remove that file, or choose another name"
        expected, got = "a name without a checkpoint", f"{checkpoint}"
        raise RangeError(message("vectorize", "--out", expected, got, remedy))

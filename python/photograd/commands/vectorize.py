"""`photograd vectorize`: a picture as curves."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit, note

from photograd.commands.fit_image import opaque
from photograd.commands.shared import (
    StepsOption,
    check_output_name,
    out_option,
    stop_on_signals,
    use_threads,
)
from photograd.errors import RangeError, message
from photograd.fitting.loss import decibels
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.read import downscale_image, read_image


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("vectorize")(vectorize)


def vectorize(
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
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Draw a picture with curves: fit their control points, widths and colors, and write SVG.

    Larger pictures are reduced first, by a whole number. Colors are fitted as viewers of SVG
    composite them. Ctrl-C writes what has been found so far.

    Example: photograd vectorize photo.png --curves 200 --out out/photo.svg
    """
    from photograd.vector.fit import CURVE_KINDS, VectorFitOptions, fit_curves
    from photograd.vector.svg_write import write_svg

    if kind not in CURVE_KINDS:
        expected = " or ".join(CURVE_KINDS)
        raise RangeError(message("vectorize", "--kind", expected, repr(kind)))
    out.parent.mkdir(parents=True, exist_ok=True)
    check_output_name("vectorize", out, (".svg",))
    if picture.suffix.lower() in LINEAR_SUFFIXES:
        expected, remedy = "display values", "convert it to .png first"
        raise RangeError(message("vectorize", "PICTURE", expected, f"{picture}", remedy))
    use_threads(threads)
    pixels = read_image(picture)
    times = math.ceil(max(pixels.shape[:2]) / size)
    target = opaque(downscale_image(pixels, times)[0] if times > 1 else pixels).astype(np.float64)
    height, width = target.shape[:2]
    note(f"{curves} curves, {width} x {height} pixels")
    behind = target.mean(axis=(0, 1))
    with stop_on_signals() as stopping:
        found = fit_curves(
            target,
            curves,
            VectorFitOptions(steps=steps, seed=seed),
            kind="fill" if kind == "fill" else "stroke",
            background=behind,
            bar=True,
            should_stop=stopping,
        )
    write_svg(out, found.drawing, (height, width), linear=False, background=behind)
    emit(
        {
            "svg": out,
            "bytes": out.stat().st_size,
            "step": len(found.losses),
            "psnr": round(decibels(found.loss), 3),
            "seconds": round(found.seconds, 2),
        },
        as_json=as_json,
        title="vectorize",
    )
    if not found.finished:
        raise typer.Exit(stopping.exit_code or 1)

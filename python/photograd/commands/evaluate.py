"""`photograd evaluate`: compare a model with held-out photographs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer
from photograd_course.cli import (
    Column,
    DebugOption,
    JsonOption,
    Progress,
    ThreadsOption,
    emit,
    note,
)

from photograd.capture.load import load_capture
from photograd.commands.shared import (
    AllowOutsideOption,
    CaptureArgument,
    DownscaleOption,
    ModelArgument,
    hold_output,
    out_option,
    use_threads,
)
from photograd.errors import RangeError, message
from photograd.fitting.evaluate import Evaluation, ViewScore, as_entry, as_result, step_change
from photograd.fitting.evaluate import evaluate as score
from photograd.fitting.model import load_model


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("evaluate")(evaluate)


def evaluate(
    context: typer.Context,
    model: ModelArgument,
    capture: CaptureArgument,
    out: Annotated[
        Path | None, out_option("Also draw truth, render and error to this PNG.")
    ] = None,
    downscale: DownscaleOption = 1,
    allow_outside: AllowOutsideOption = False,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001
) -> None:
    """PSNR and SSIM on the test split, with the protocol they hold under.

    Only pixels that a photograph has are scored: not the border that undistortion leaves, nor what
    a mask excludes. Of grids, half_step says how much halving the step of the march changes colors.

    Example: photograd evaluate model photos --out comparison.png
    """
    use_threads(threads)
    if out is not None:
        hold_output(context, "evaluate", out, (".png",))
    loaded = load_model(model)
    photographs = load_capture(capture, downscale=downscale, allow_outside=allow_outside)
    views = photographs.test
    if not views:
        raise RangeError(message("evaluate", "CAPTURE", "held-out views", f"none in {capture}"))
    if photographs.split_hash() != loaded.meta.get("split"):
        note("warning: the model was fitted on another split; it may have seen these views")
    with Progress("evaluate", len(views), [Column("view", "{:.0f}".format)]) as bar:
        result = score(loaded, views, on_view=lambda n: bar.update(n, view=n))
    if out is not None:
        draw_picked(result, out)
    entries = as_result(result) | as_entry(step_change(loaded, views))
    emit(entries, as_json=as_json, title="evaluate")


def picked_views(psnr: Sequence[float]) -> list[int]:
    """Numbers of the worst, the middle and the best view, in this order; all if they are fewer."""
    ranked = sorted(range(len(psnr)), key=lambda i: psnr[i])
    shown = min(3, len(ranked))
    return [ranked[i * (len(ranked) - 1) // max(shown - 1, 1)] for i in range(shown)]


def draw_picked(result: Evaluation, path: Path) -> None:
    """Truth, rendering and error of a few views, the worst among them."""
    picked = [result.views[i] for i in picked_views([view.psnr for view in result.views])]
    which = "Worst, middle and best of " if len(result.views) > len(picked) else ""
    title = f"Held-out views: mean PSNR {result.psnr:.2f} dB"
    names = [view.name for view in picked]
    draw_strips(picked, names, path, title=title, caption=f"{which}{result.protocol}.")


def draw_strips(
    views: Sequence[ViewScore], names: Sequence[str], path: Path, *, title: str, caption: str
) -> None:
    """Truth, rendering and error of views of one size under headings `names`."""
    from photograd_course.viz import comparison_strips, save_figure

    if not all(view.valid.all() for view in views):
        caption += " Gray: not valid, not scored."
    figure = comparison_strips(
        [view.truth for view in views],
        [view.render for view in views],
        valid=[view.valid for view in views],
        names=names,
        psnr=[view.psnr for view in views],
        title=title,
        caption=caption,
    )
    save_figure(figure, path)

"""A fit from beginning to end, in one call."""

from __future__ import annotations

from collections.abc import Collection
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from photograd._run_lock import one_run_in
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.errors import RangeError, message
from photograd.fitting.checkpoint import FILE_NAME
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import USERS_OF, Progress, options_for


def fit(
    capture: Capture | str | Path,
    representation: str = "dense_grid",
    *,
    folder: str | Path | None = None,
    resume: bool = False,
    start_from: Model | None = None,
    bar: bool = False,
    **options: Any,
) -> Model:
    """Recover a scene from photographs: from nearly empty space to a model, step by step.

    `Fit` is the same, a step at a time.

    Args:
        capture: posed photographs, or where `load_capture` finds them.
        representation: "dense_grid", "dense_sh", "sparse_sh", "gaussians" or "octree_sh".
        folder: for the checkpoint, DIR/model.npz, written every 30 s and at the end, and for
            snapshots of some steps; None keeps nothing on disk.
        resume: go on from the checkpoint in `folder`, with its representation and options, to the
            same bits as without interruption.
        start_from: a model of the same capture: Gaussians begin on its surfaces, the leaves of an
            octree are cut from it.
        bar: show progress on stderr.
        options: others of `FitOptions` than the representation's defaults, such as `resolution`,
            `steps` and `seed`.

    Returns:
        The model, as `load_model` returns it.

    Raises:
        RangeError: an unknown representation, options without meaning or that take more memory than
            there is, a folder that holds a model already without `resume`, a checkpoint of another
            capture, or options together with `resume`.
        TypeError: an option that does not exist.
        SceneError: training cameras that do not see the scene.
        IoError: a checkpoint that cannot be written, or is not there to resume from, or a folder
            that another run holds.
        Error: a loss or a gradient that is not finite.
    """
    photographs = capture if isinstance(capture, Capture) else load_capture(capture)
    with ExitStack() as stack:
        if folder is None:
            if resume:
                raise RangeError(message("fit", "resume", "a folder to resume from", "none"))
            place = Path(stack.enter_context(TemporaryDirectory(prefix="photograd")))
        else:
            place = Path(folder)
            stack.enter_context(one_run_in("fit", place))
        if resume:
            if options or start_from is not None:
                expected, got = "options of the checkpoint alone", "others as well"
                raise RangeError(message("fit", "options", expected, got, "leave them out"))
            job = Fit.resume(photographs, place)
        else:
            if (place / FILE_NAME).exists():
                expected, got = "a folder without a model", f"{place}, which holds one"
                remedy = "resume it, or choose another folder"
                raise RangeError(message("fit", "folder", expected, got, remedy))
            chosen = options_for(representation, **options)
            _refuse_without_effect(representation, options)
            job = Fit.start(photographs, chosen, start_from=start_from)
        _run(job, place, bar=bar)
        return load_model(place)


def _refuse_without_effect(representation: str, options: Collection[str]) -> None:
    for name in options:
        users = USERS_OF.get(name, (representation,))
        if representation not in users:
            expected, remedy = (
                f"a fit of {' or '.join(users)}",
                "leave it out, it has no effect here",
            )
            raise RangeError(message("fit", name, expected, repr(representation), remedy))


def _run(job: Fit, folder: Path, *, bar: bool) -> None:
    if not bar:
        job.run(folder)
        return
    from photograd_course.cli import Column
    from photograd_course.cli import Progress as Bar

    columns = [Column("loss", "{:.2e}".format)]
    with Bar("fit", job.options.steps, columns, start=job.step_number) as shown:

        def on_step(now: Progress) -> None:
            shown.update(now.step, loss=now.loss)

        job.run(folder, on_step=on_step)

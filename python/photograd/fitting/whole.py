"""A fit from beginning to end, in one call."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from photograd._checkpoint import FILE_NAME
from photograd._descend import progress_bar, run_folder
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.errors import RangeError, message
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import options_for, refuse_without_effect


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
        representation: "dense_grid", "dense_sh", "sparse_sh", "gaussians", "octree_sh" or
            "textured_mesh".
        folder: for the checkpoint, DIR/model.npz, written every 30 s and at the end, and for
            snapshots of some steps; None keeps nothing on disk.
        resume: go on from the checkpoint in `folder`, with its representation and options, to the
            same bits as without interruption.
        start_from: a model of the same capture: Gaussians begin on its surfaces, the leaves of an
            octree are cut from it, a textured mesh is that of it.
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
    path = None if folder is None else Path(folder)
    with run_folder("fit", path, FILE_NAME, resume=resume):
        if resume and path is not None:
            if options or start_from is not None:
                expected, got = "options of the checkpoint alone", "others as well"
                raise RangeError(message("fit", "options", expected, got, "leave them out"))
            job = Fit.resume(photographs, path)
        else:
            chosen = options_for(representation, **options)
            refuse_without_effect(representation, options)
            job = Fit.start(photographs, chosen, start_from=start_from)
        with ExitStack() as stack:
            if path is None:
                path = Path(stack.enter_context(TemporaryDirectory(prefix="photograd")))
            on_step = stack.enter_context(progress_bar("fit", job, shown=bar))
            job.run(path, on_step=on_step)
            return load_model(path)

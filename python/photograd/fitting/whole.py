"""A fit from beginning to end, in one call."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from contextlib import ExitStack, suppress
from dataclasses import fields
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeVar

from photograd._checkpoint import FILE_NAME
from photograd._checks import require_instance
from photograd._descend import attach, progress_bar, run_folder
from photograd._fit_options import FitOptions
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.errors import DtypeError, Error, RangeError, message
from photograd.fitting.checks import require_startable
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import options_for, refuse_without_effect

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _list_options(function: _Function) -> _Function:
    """Decorator: describe the fields of `FitOptions` in the docstring of a function.

    Its entry `options`, the last of its arguments, is followed by one for each field.
    """
    own: Any = function
    described, docstring = inspect.getdoc(FitOptions), inspect.getdoc(function)
    if described and docstring:  # both are None under python -OO
        text = described.partition("Attributes:")[2] + "\n"
        for field in fields(FitOptions):
            kind = f"{field.type}, default {field.default!r}"
            text = text.replace(f"\n    {field.name}:", f"\n    {field.name} ({kind}):")
        text = text[text.index("\n    resolution") :].rstrip()
        args, _, rest = docstring.partition("\n\nReturns:")
        own.__doc__ = f"{args}{text}\n\nReturns:{rest}"
    return function


@_list_options
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
        representation: "dense_grid", "sparse_sh", "gaussians", or another of
            `photograd.fields.fittable()`.
        folder: for the checkpoint, DIR/model.npz, written every 30 s and at the end, and for
            snapshots of some steps; None keeps nothing on disk.
        resume: go on from the checkpoint in `folder`, with its representation and options, to the
            same bits as without interruption.
        start_from: a model of the same capture: Gaussians begin on its surfaces, the leaves of an
            octree are cut from it, codes take its voxels, a textured mesh is that of it.
        bar: show progress on stderr.
        options: fields of `FitOptions`, here with its defaults; a representation may have others,
            which `options_for` returns.

    Returns:
        The model, as `load_model` returns it.

    Raises:
        RangeError: an unknown representation, options without meaning or that take more memory than
            there is, a folder that holds a model already without `resume`, a checkpoint of another
            capture, or options together with `resume`.
        DtypeError: an option that does not exist; names the nearest. Or no capture, or no `Model`.
        SceneError: training cameras that do not see the scene.
        IoError: a checkpoint that cannot be written, or is not there to resume from, or a folder
            that another run holds.
        Error: a loss or a gradient that is not finite.
        KeyboardInterrupt: Ctrl-C or a notebook's interrupt, after a checkpoint in `folder`; its
            `partial_result` is the model so far, with or without a folder.

    Example:
        >>> model = photograd.fit("photos", "dense_grid", resolution=16, steps=20, rays=256)
        >>> step, loss, psnr = model.history.T  # of every step
        >>> bool(loss[-5:].mean() < loss[:5].mean())
        True
    """
    chosen = None if resume else _checked_options(representation, options)
    if start_from is not None:
        require_instance("fit", "start_from", start_from, Model, "load_model reads one")
    if not isinstance(capture, Capture | str | Path):
        expected, got = "a Capture or its path", type(capture).__name__
        raise DtypeError(message("fit", "capture", expected, got))
    photographs = capture if isinstance(capture, Capture) else load_capture(capture)
    path = None if folder is None else Path(folder)
    with run_folder("fit", path, FILE_NAME, resume=resume):
        if chosen is None:
            if options or start_from is not None:
                expected, got = "options of the checkpoint alone", "others as well"
                raise RangeError(message("fit", "options", expected, got, "leave them out"))
            assert path is not None  # `run_folder` refuses to resume without one
            job = Fit.resume(photographs, path)
        else:
            job = Fit.start(photographs, chosen, start_from=start_from)
        with ExitStack() as stack:
            if path is None:
                path = Path(stack.enter_context(TemporaryDirectory(prefix="photograd")))
            on_step = stack.enter_context(progress_bar("fit", job, shown=bar))
            try:
                job.run(path, on_step=on_step)
            except BaseException as failure:
                if hasattr(failure, "partial_result"):
                    with suppress(Error):  # no checkpoint could be written
                        attach(failure, load_model(path))
                raise
            return load_model(path)


def _checked_options(representation: str, options: Mapping[str, Any]) -> FitOptions:
    """The options of a new fit, refused before photographs are read."""
    require_startable(representation)
    chosen = options_for(representation, **options)
    refuse_without_effect(representation, options)
    return chosen

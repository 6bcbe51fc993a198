"""Learn, freeze the structure, refine: one driver for every representation with a discrete one.

Which voxels, leaves or cells there are is a discrete question: a gradient answers only for those
that exist. So a fit learns first which ones matter, holds them from then on, and refines the
numbers in them. `Fittable.frozen_at` says when; a representation that is cut from another model is
frozen from the start. Both moments are scored alike.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Self

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd._checkpoint import make_folder
from photograd._checks import from_plain
from photograd._json_node import read_json
from photograd.errors import Error, IoError, RangeError, message
from photograd.fields import fittable
from photograd.fitting.compare import frame_seconds, stored_bytes
from photograd.fitting.data import learned_background
from photograd.fitting.evaluate import evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model
from photograd.fitting.options import FitResult

FROZEN = "frozen.json"
"""What a folder keeps of the moment of freezing, so that a stopped fit can go on."""

RunUntil = Callable[[Fit, Path, Callable[[], bool]], FitResult]
"""Runs a fit in a folder until its end, or until there is enough of it."""


@dataclass(frozen=True)
class Moment:
    """What a model is worth at one moment of its fit.

    Attributes:
        step: of the fit.
        psnr: in dB, mean over the held-out views.
        bytes: of the parameters and of the arrays that say where they belong.
        frame_ms: median time of a frame, at the size of the first held-out view.
        seconds: of the fit since the moment before.
    """

    step: int
    psnr: float
    bytes: int
    frame_ms: float
    seconds: float

    @classmethod
    def of_fit(cls, fit: Fit, seconds: float) -> Self:
        """Score a fit as it is now.

        Args:
            fit: with held-out views in its capture.
            seconds: of the fit since the moment before.
        """
        behind = None if fit.background is None else learned_background(fit.background)
        model = Model(fit.model, behind, fit.options, {}, np.zeros((0, 3)))
        psnr = evaluate(model, fit.capture.test).psnr
        frame = 1000 * frame_seconds(model, fit.capture)
        return cls(fit.step_number, psnr, stored_bytes(model), frame, seconds)


@dataclass(frozen=True)
class Refinement:
    """The moment when the structure was frozen, and the end of the fit."""

    frozen: Moment
    refined: Moment


def learn_freeze_refine(
    fit: Fit, folder: str | Path, *, run: RunUntil | None = None
) -> Refinement | None:
    """Run a fit to its end in a folder, its structure held from `frozen_at` on, and score both.

    Args:
        fit: at its start, or resumed in a folder of this function.
        folder: of its checkpoint.
        run: runs it, usually under a progress bar; None runs it silently.

    Returns:
        Both moments, or None if `run` ended before the fit did: the same call continues it.

    Raises:
        RangeError: a representation without a discrete structure, a capture without held-out views,
            or a fit that passed the moment outside of this function.
        IoError: a damaged frozen.json in the folder of a fit that passed the moment; names it.

    Example:
        >>> job = Fit.start(capture, options_for("sparse_sh", resolution=32, steps=40))
        >>> both = learn_freeze_refine(job, "model")
        >>> both.refined.psnr > both.frozen.psnr
        True
    """
    folder = Path(folder)
    make_folder(folder)
    at = fit.model.frozen_at(fit.options)
    if at is None:
        able = [
            name for name, kind in fittable().items() if kind.frozen_at(fit.options) is not None
        ]
        expected = f"a fit of {' or '.join(able)}, whose structure is discrete"
        raise RangeError(message("learn_freeze_refine", "fit", expected, repr(fit.model.name)))
    run = run or (lambda job, where, enough: job.run(where, should_stop=enough))
    path = folder / FROZEN
    if fit.step_number < at or (fit.step_number == at and not path.exists()):
        seconds = 0.0
        if fit.step_number < at:
            seconds = run(fit, folder, lambda: fit.step_number >= at).seconds
        if fit.step_number < at:
            return None
        atomic_write(path, json.dumps(asdict(Moment.of_fit(fit, seconds))).encode())
    elif not path.exists():
        expected, got = f"a fit before step {at}", f"one at step {fit.step_number}"
        remedy = "begin it again in another folder"
        raise RangeError(message("learn_freeze_refine", "fit", expected, got, remedy))
    frozen = _read_moment(path)
    fit.model.freeze()
    result = run(fit, folder, lambda: False)
    if fit.step_number < fit.steps:
        return None
    return Refinement(frozen, Moment.of_fit(fit, result.seconds))


def _read_moment(path: Path) -> Moment:
    """The moment that was written to `path`. Raises IoError if the file is damaged."""
    name = "learn_freeze_refine"
    try:
        return from_plain(name, Moment, read_json(name, path).value)
    except Error as failure:
        remedy = "go on without --freeze, or begin the fit again in another folder"
        expected = f"what --freeze wrote: {', '.join(field.name for field in fields(Moment))}"
        raise IoError(message(name, str(path), expected, f"{failure}", remedy)) from failure

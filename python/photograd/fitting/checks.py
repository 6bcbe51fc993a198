"""What a fit refuses: before it starts, before it goes on, and before it saves."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from photograd_course.suggest import nearest

from photograd.capture.capture import Capture
from photograd.errors import Error, IoError, RangeError, message
from photograd.fields.octree_sh import OctreeSh
from photograd.fitting.checkpoint import Checkpoint
from photograd.fitting.options import FitOptions
from photograd.fitting.start import FITTED
from photograd.representation import representation, representations
from photograd.splats.model import GaussianScene
from photograd.types import Array

_SAME = "resume with the capture, and the --downscale, that the fit was started on"


def require_startable(name: str) -> None:
    """Raise RangeError unless a capture can start the representation called `name`."""
    if name in FITTED:
        return
    if name not in representations():
        near = nearest(name, FITTED)
        remedy = f"did you mean {near!r}?" if near else None
    elif representation(name).capabilities & {"rays", "image"}:
        remedy = "start it from Python, with parameters of your own"
    else:
        remedy = "it lives on a 2D canvas"
    expected = f"one that a capture can start: {_known()}"
    raise RangeError(message("Fit", "representation", expected, repr(name), remedy))


def _known() -> str:
    return " or ".join(map(repr, FITTED))


def require_background_of(capture: Capture, options: FitOptions) -> None:
    """Raise RangeError for a learned background of whole pictures with alpha, which show it."""
    image = "image" in representation(options.representation).capabilities
    if image and options.background == "learned" and capture.has_alpha:
        raise RangeError(
            message("Fit", "background", "random, white or black for photographs with alpha",
                    "'learned'")
        )  # fmt: skip


def require_first_model(name: str, *, given: bool) -> None:
    """Raise RangeError for a model to start from where none is wanted, or none where one is."""
    if given and name not in (GaussianScene.name, OctreeSh.name):
        expected = f"none, or {GaussianScene.name!r} or {OctreeSh.name!r} to fit"
        raise RangeError(
            message("Fit.start", "start_from", expected, repr(name), "grids start empty")
        )
    if name == OctreeSh.name and not given:
        raise RangeError(
            message("Fit.start", "start_from", f"the model that {name!r} is cut from", "none",
                    "fit a dense_grid or a sparse_sh first, and start from that (--start-from)")
        )  # fmt: skip


def require_split_of(saved: Checkpoint, capture: Capture) -> None:
    """Raise IoError unless `saved` is the checkpoint of a fit, RangeError if of another split."""
    missing = sorted({"step", "split", "pixels"} - set(saved.meta))
    if missing:
        got = f"one without {missing}"
        raise IoError(
            message("Fit.resume", "checkpoint", "that of a fit", got, "is it another version's?")
        )
    if saved.meta["split"] != capture.split_hash():
        expected = f"the checkpoint's split {saved.meta['split']}"
        raise RangeError(message("Fit.resume", "capture", expected, capture.split_hash(), _SAME))


def require_pixels_of(saved: Checkpoint, digest: str) -> None:
    """Raise RangeError if the training images or cameras are not those of the checkpoint."""
    if saved.meta["pixels"] != digest:
        expected = f"the images and cameras {saved.meta['pixels']} of the checkpoint"
        raise RangeError(message("Fit.resume", "capture", expected, digest, _SAME))


def require_finite_loss(loss: float, step: int) -> None:
    """Raise Error for a loss that is NaN or infinite."""
    if not math.isfinite(loss):
        raise Error(
            message("Fit.step", "loss", "a finite number", f"{loss} at step {step}",
                    "what was saved is as it was; lower the learning rate")
        )  # fmt: skip


def require_finite(params: Mapping[str, Array], step: int) -> None:
    """Raise Error if a parameter is not finite: a good checkpoint is not replaced by a bad one."""
    for name, array in params.items():
        count = array.size - int(np.isfinite(array).sum())
        if count:
            got = f"{count} that are not after {step} steps"
            remedy = "what was saved is as it was; lower the learning rate"
            raise Error(message("Fit.step", name, "finite values", got, remedy))

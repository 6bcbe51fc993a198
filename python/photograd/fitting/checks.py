"""What a fit refuses, and what it takes of the memory, asked before it is taken.

Each estimate of memory is a lower bound: what it refuses cannot be done, what it allows may still
be too much.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from photograd_course.suggest import nearest

from photograd._checkpoint import Checkpoint
from photograd._fit_options import FitOptions
from photograd._memory import available_memory, require_room
from photograd.capture.capture import Capture
from photograd.errors import Error, IoError, RangeError, message
from photograd.fields import fittable, representation, representations
from photograd.representation import Memory
from photograd.types import Array

_SAME = "resume with the capture, and the --downscale, that the fit was started on"


def require_startable(name: str) -> None:
    """Raise RangeError unless a capture can start the representation called `name`."""
    known = fittable()
    if name in known:
        return
    if name in representations():
        remedy = representation(name).teaching_example or "derive its class from Fittable"
    else:
        near = nearest(str(name), known)
        remedy = f"did you mean {near!r}?" if near else ""
    expected = f"one that a capture can start: {' or '.join(map(repr, known))}"
    raise RangeError(message("Fit", "representation", expected, repr(name), remedy or None))


def require_background_of(capture: Capture, options: FitOptions) -> None:
    """Raise RangeError for a learned background of whole pictures with alpha, which show it.

    Args:
        capture: of the fit.
        options: of the fit.
    """
    image = "image" in representation(options.representation).capabilities
    if image and options.background == "learned" and capture.has_alpha:
        raise RangeError(
            message(
                "Fit",
                "background",
                "random, white or black for photographs with alpha",
                "'learned'",
            )
        )


def require_first_model(name: str, *, given: bool) -> None:
    """Raise RangeError for a model to start from where none is wanted, or none where one is.

    Args:
        name: of the representation to be fitted.
        given: whether there is a model to start from.
    """
    kind = fittable()[name]
    if given and kind.first_model == "refused":
        others = [n for n, other in fittable().items() if other.first_model != "refused"]
        expected = f"none, or {' or '.join(map(repr, others))} to fit"
        raise RangeError(
            message("Fit.start", "start_from", expected, repr(name), kind.first_model_help)
        )
    if kind.first_model == "required" and not given:
        expected = f"the model that {name!r} starts from"
        raise RangeError(
            message("Fit.start", "start_from", expected, "none", kind.first_model_help)
        )


def require_split_of(saved: Checkpoint, capture: Capture) -> None:
    """Raise IoError unless `saved` is the checkpoint of a fit, RangeError if of another split.

    Args:
        saved: a checkpoint.
        capture: with which the fit shall go on.
    """
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
    """Raise RangeError if the training images or cameras are not those of the checkpoint.

    Args:
        saved: a checkpoint.
        digest: of the training images and cameras of the capture.
    """
    if saved.meta["pixels"] != digest:
        expected = f"the images and cameras {saved.meta['pixels']} of the checkpoint"
        raise RangeError(message("Fit.resume", "capture", expected, digest, _SAME))


def require_finite_loss(loss: float, step: int) -> None:
    """Raise Error for a loss that is NaN or infinite.

    Args:
        loss: of a step.
        step: its number.
    """
    if not math.isfinite(loss):
        raise Error(
            message(
                "Fit.step",
                "loss",
                "a finite number",
                f"{loss} at step {step}",
                "what was saved is as it was; lower the learning rate",
            )
        )


def require_finite(params: Mapping[str, Array], step: int) -> None:
    """Raise Error if a parameter is not finite: a good checkpoint is not replaced by a bad one.

    Args:
        params: parameters by group.
        step: after which they were found.
    """
    for name, array in params.items():
        count = array.size - int(np.isfinite(array).sum())
        if count:
            got = f"{count} that are not after {step} steps"
            remedy = "what was saved is as it was; lower the learning rate"
            raise Error(message("Fit.step", name, "finite values", got, remedy))


# What a fit takes of the memory, asked before it is taken.


BYTES_A_RAY = 480
"""Measured: 478 to 696, of dense_grid and sparse_sh, 200,000 and 800,000 rays."""
BYTES_A_PIXEL = 48
"""Color and alpha, view and place in it, and as much again while views are joined."""


def require_room_to_start(capture: Capture, box: Array, options: FitOptions) -> None:
    """Refuse a fit whose photographs, rays or parameters exceed the memory there is.

    Args:
        capture: its training views, of which the sizes count.
        box: (2, 3) of the scene, in meters.
        options: of the fit.

    Raises:
        RangeError: names the option, what it takes and what would do.
    """
    room = available_memory()
    for part in sorted(_parts(capture, box, options, room), key=lambda part: -part.size):
        require_room(
            "Fit.start", part.what, part.size, room, argument=part.option, remedy=part.remedy
        )
        room -= part.size


def _parts(capture: Capture, box: Array, options: FitOptions, room: int) -> list[Memory]:
    kind = fittable()[options.representation]
    pixels = sum(view.camera.width * view.camera.height for view in capture.train)
    what = f"{pixels:,} pixels to learn from"
    smaller = "take smaller photographs with --downscale"
    parts = [Memory("capture", what, BYTES_A_PIXEL * pixels, smaller)]
    if "rays" in kind.capabilities:
        what, size = f"{options.rays:,} rays a step", BYTES_A_RAY * options.rays
        parts.append(Memory("rays", what, size, "take fewer with --rays"))
    return [*parts, *kind.memory(box, options, room)]

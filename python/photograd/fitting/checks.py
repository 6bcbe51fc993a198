"""What a fit refuses, and what it takes of the memory, asked before it is taken.

Each estimate of memory is a lower bound: what it refuses cannot be done, what it allows may still
be too much.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from photograd_course.suggest import nearest

from photograd._memory import available_memory, require_room
from photograd.capture.capture import Capture
from photograd.errors import Error, IoError, RangeError, message
from photograd.fields import representation, representations
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.sparse_sh import SparseSh
from photograd.fitting.checkpoint import Checkpoint
from photograd.fitting.options import FitOptions
from photograd.fitting.start import FITTED, HARMONIC_GRIDS
from photograd.sh import count as sh_count
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
            message(
                "Fit",
                "background",
                "random, white or black for photographs with alpha",
                "'learned'",
            )
        )


def require_first_model(name: str, *, given: bool) -> None:
    """Raise RangeError for a model to start from where none is wanted, or none where one is."""
    if given and name not in (GaussianScene.name, OctreeSh.name):
        expected = f"none, or {GaussianScene.name!r} or {OctreeSh.name!r} to fit"
        raise RangeError(
            message("Fit.start", "start_from", expected, repr(name), "grids start empty")
        )
    if name == OctreeSh.name and not given:
        raise RangeError(
            message(
                "Fit.start",
                "start_from",
                f"the model that {name!r} is cut from",
                "none",
                "fit a dense_grid or a sparse_sh first, and start from that (--start-from)",
            )
        )


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
            message(
                "Fit.step",
                "loss",
                "a finite number",
                f"{loss} at step {step}",
                "what was saved is as it was; lower the learning rate",
            )
        )


def require_finite(params: Mapping[str, Array], step: int) -> None:
    """Raise Error if a parameter is not finite: a good checkpoint is not replaced by a bad one."""
    for name, array in params.items():
        count = array.size - int(np.isfinite(array).sum())
        if count:
            got = f"{count} that are not after {step} steps"
            remedy = "what was saved is as it was; lower the learning rate"
            raise Error(message("Fit.step", name, "finite values", got, remedy))


# What a fit takes of the memory, asked before it is taken.


COPIES = 4
"""A parameter, its gradient and two moments; also the 1.1 GB measured for 256³ voxels."""
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
    parts = sorted(_parts(capture, box, options, room), key=lambda part: -part[2])
    for argument, what, size, remedy in parts:
        require_room("Fit.start", what, size, room, argument=argument, remedy=remedy)
        room -= size


def require_room_to_refine(grid: Any, resolution: int) -> None:
    """Raise RangeError if a grid, refined, takes more memory than there is.

    It is interpolated from the coarse grid while that still exists. A sparse grid that pruned
    little, of a capture without alpha, can grow eightfold.
    """
    now = sum(values.nbytes for values in grid.params.values())
    needed = COPIES * int(now * (1 + (resolution / grid.resolution) ** 3))
    remedy = f"fit with --resolution {grid.resolution}, or crop the capture's bounds"
    what = f"a grid of {resolution} voxels along an edge"
    require_room("Fit.step", what, needed, argument="resolution", remedy=remedy)


def _parts(
    capture: Capture, box: Array, options: FitOptions, room: int
) -> list[tuple[str, str, int, str]]:
    """Option, what it is, bytes, remedy."""
    pixels = sum(view.camera.width * view.camera.height for view in capture.train)
    parts = [
        (
            "capture",
            f"{pixels:,} pixels to learn from",
            BYTES_A_PIXEL * pixels,
            "take smaller photographs with --downscale",
        )
    ]
    name = options.representation
    if name == GaussianScene.name:
        # Position, scales, rotation and opacity; harmonics of three colors.
        each = COPIES * 4 * (3 + 3 + 4 + 1 + 3 * sh_count(options.degree))
        what = f"{options.gaussians:,} Gaussians"
        remedy = f"--gaussians {max(1, room // (2 * each)):,} takes half of it".replace(",", "")
        return [*parts, ("gaussians", what, each * options.gaussians, remedy)]
    remedy = "take fewer with --rays"
    parts.append(("rays", f"{options.rays:,} rays a step", BYTES_A_RAY * options.rays, remedy))
    if name == DenseGrid.name or name in HARMONIC_GRIDS:
        size = _grid_bytes(box, options)
        fits = int(options.resolution * min(1.0, room / (2 * size)) ** (1 / 3))
        what = f"a grid of {options.resolution} voxels along an edge"
        remedy = f"--resolution {fits} takes half of it; or crop the capture's bounds"
        parts.append(("resolution", what, size, remedy))
    return parts


def _grid_bytes(box: Array, options: FitOptions) -> int:
    """At the end of a fit; of a sparse grid, of which nobody knows what will be pruned, its mask
    at the end, and all of its voxels at the beginning.
    """
    name = options.representation
    channels = 4 if name == DenseGrid.name else 1 + 3 * sh_count(options.degree)
    if name != SparseSh.name:
        return COPIES * 4 * channels * _voxels(box, options.resolution)
    first = COPIES * 4 * channels * _voxels(box, options.levels()[0])
    mask_and_bricks = 2 * _voxels(box, options.resolution)
    return max(first, mask_and_bricks)


def _voxels(box: Array, resolution: int) -> int:
    extent = np.asarray(box[1] - box[0], np.float64)
    x, y, z = (int(n) for n in np.ceil(extent * (resolution / extent.max()) - 1e-6))
    return max(x, 2) * max(y, 2) * max(z, 2)

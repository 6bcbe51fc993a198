"""`photograd fit` of a picture: a network behind an encoding learns its colors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, get_args

import numpy as np
import typer
from photograd_course.cli import emit, note
from photograd_course.suggest import choose_from

from photograd._signals import stop_on_signals
from photograd.commands.shared import is_given
from photograd.errors import RangeError, message
from photograd.fields.neural_image import Encoding, ImagePolicy
from photograd.fitting.image_fit import FittedImage, ImageFitOptions, fit_image
from photograd.images.read import IMAGE_SUFFIXES, read_image
from photograd.images.write import write_png
from photograd.types import Array

ENCODINGS: dict[str, Encoding] = {"nerf": "frequencies"}
ENCODINGS |= {name: name for name in get_args(Encoding)}
"""Encoding of each name that --representation may have for a picture."""
TAKEN = {"capture", "out", "representation", "steps", "resolution", "rays", "learning_rate"}
TAKEN |= {"resume", "seed", "threads", "as_json", "debug"}


def is_picture(path: Path) -> bool:
    """Whether a path is a picture's, which `fit` takes in the place of a capture."""
    return path.suffix.lower() in IMAGE_SUFFIXES and not path.is_dir()


def fit_picture(context: typer.Context, path: Path, out: Path) -> None:
    """What `photograd fit` does with a picture.

    Args:
        context: of the command, for its options.
        path: of the picture.
        out: folder for the network, its checkpoints and pictures.
    """
    given = {name: value for name, value in context.params.items() if is_given(context, name)}
    for name in sorted(set(given) - TAKEN):
        option, remedy = "--" + name.replace("_", "-"), "leave it out, it has no effect here"
        raise RangeError(message("fit", option, "a fit of a capture", f"{path}", remedy))
    picture = opaque(read_image(path))
    policy = policy_of(picture, given)
    options = ImageFitOptions(
        **{name: given[name] for name in ("steps", "learning_rate", "seed") if name in given},
        **({"points": given["rays"]} if "rays" in given else {}),
    )
    with stop_on_signals() as stopping:
        found = run(picture, policy, options, out, stopping, resume=context.params["resume"])
    write_png(out / "picture.png", found.image)
    emit(summary(found, out), as_json=context.params["as_json"], title="fit")
    if not found.finished:
        note(f"stopped at step {len(found.losses)}; continue with --resume")
        raise typer.Exit(stopping.exit_code or 1)


def policy_of(picture: Array, given: Mapping[str, Any]) -> ImagePolicy:
    """Encoding and sizes; the finest level of a hash grid has a cell for two pixels.

    Args:
        picture: (H, W, 3).
        given: options of the command line.

    Raises:
        RangeError: no encoding of that name, or a resolution where there are no levels.
    """
    name = given.get("representation", "hash_grid")
    if name not in ENCODINGS:
        expected, remedy = "a fit of a capture", choose_from(name, sorted(ENCODINGS))
        raise RangeError(message("fit", "--representation", expected, repr(name), remedy))
    if ENCODINGS[name] != "hash_grid":
        if "resolution" in given:
            raise RangeError(message("fit", "--resolution", "a fit of 'hash_grid'", repr(name)))
        return ImagePolicy(encoding=ENCODINGS[name])
    finest = given.get("resolution", max(picture.shape[:2]) // 2)
    return ImagePolicy(finest=max(finest, 1), coarsest=min(16, max(finest, 1)))


def opaque(pixels: Array) -> Array:
    """(H, W, 3) of an image (H, W, 4) with straight alpha, over white."""
    alpha = pixels[..., 3:]
    colors: Array = np.clip(pixels[..., :3] * alpha + (1 - alpha), 0, 1)
    return colors


def run(
    picture: Array,
    policy: ImagePolicy,
    options: ImageFitOptions,
    out: Path,
    stopping: Callable[[], bool],
    *,
    resume: bool,
) -> FittedImage:
    """Fit under a progress bar, with checkpoints in `out`."""
    note(f"{policy.encoding}, {picture.shape[1]} x {picture.shape[0]} pixels")
    return fit_image(
        picture, policy, options, folder=out, resume=resume, bar=True, should_stop=stopping
    )


def summary(found: FittedImage, out: Path) -> dict[str, Any]:
    """What the command reports."""
    return {
        "picture": str(out / "picture.png"),
        "step": len(found.losses),
        "psnr": round(found.psnr, 3),
        "bytes": found.size,
        "seconds": round(found.seconds, 2),
    }

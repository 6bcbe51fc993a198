"""A recovered scene, ready to be rendered: the field, its background, the fit's record."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from photograd._plain_values import from_plain
from photograd.errors import Error, IoError, message
from photograd.fitting.backgrounds import learned_background
from photograd.fitting.checkpoint import Checkpoint, load_checkpoint
from photograd.fitting.checkpoint_schema import check_checkpoint
from photograd.fitting.options import FitOptions
from photograd.fitting.start import FittedField, saved_field
from photograd.types import Array


@dataclass(frozen=True)
class Model:
    """A field with the linear background (3,) that was learned with it, or None."""

    field: FittedField
    background: Array | None
    options: FitOptions
    meta: dict[str, Any]
    history: Array  # (n, 3): step, loss, PSNR of the batch


def load_model(path: str | Path) -> Model:
    """Load the model that a fit left in `path` (its folder, or the file). Raises IoError."""
    return model_of(load_checkpoint(path), Path(path))


def model_of(saved: Checkpoint, path: Path) -> Model:
    """The model in a checkpoint.

    Raises IoError if its contents, the optimizer's state included, do not fit together.
    """
    try:
        options = from_plain("checkpoint", FitOptions, saved.meta.get("options"))
        check_checkpoint(saved, options)
        field = saved_field(saved.params, saved.state, saved.meta.get("policy"), options)
    except Error as failure:
        remedy = "the file is from another version or damaged"
        expected = "a checkpoint of a fit"
        raise IoError(message("load_model", f"{path}", expected, failure, remedy)) from failure
    raw = saved.params.get("background")
    background = None if raw is None else learned_background(raw.astype(np.float64))
    return Model(field, background, options, saved.meta, saved.history)

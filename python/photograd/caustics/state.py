"""A caustic design on disk: what it needs to go on, and what shows that it is the same one."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.optim import Adam

from photograd._checkpoint import (
    Checkpoint,
    check_arrays,
    check_history,
    check_optimizer,
    checked_step,
    load_checkpoint,
    save_checkpoint,
)
from photograd.errors import Error, IoError, RangeError, message
from photograd.types import Array, FloatArray

FILE_NAME = "caustic.npz"


History = list[tuple[float, float, float]]


def save_design(
    folder: Path, identity: dict[str, Any], x: dict[str, FloatArray], adam: Adam, history: History
) -> Path:
    """Write DIR/caustic.npz atomically; IoError if that fails.

    Args:
        folder: DIR, which exists.
        identity: of the design, as `load_design` compares it.
        x: what is descended.
        adam: that descends.
        history: of each step so far.
    """
    meta = {"step": len(history), **identity}
    rows = np.array(history, np.float64).reshape(-1, 3)
    return save_checkpoint(folder / FILE_NAME, Checkpoint(meta, dict(x), adam.state(), {}, rows))


def load_design(
    folder: Path, identity: dict[str, Any], x: dict[str, FloatArray], adam: Adam
) -> History:
    """What `save_design` wrote: `x` and `adam` are filled, the history is returned.

    Args:
        folder: of the checkpoint.
        identity: what the checkpoint has to be of.
        x, adam: of a design that was just begun.

    Raises:
        IoError: a missing or damaged checkpoint.
        RangeError: one of another design.
    """
    path = folder / FILE_NAME
    if not path.is_file():
        expected = f"a design ({FILE_NAME})"
        raise IoError(message("recover", "folder", expected, f"none in {folder}"))
    saved = load_checkpoint(path)
    for name, value in identity.items():
        if saved.meta.get(name) != value:
            remedy = "resume with what it was started with, or choose another folder"
            expected = f"the {name} of the checkpoint"
            raise RangeError(message("recover", name, expected, f"other {name}", remedy))
    try:
        step = checked_step(saved)
        rows = {name: (("float64",), value.shape) for name, value in x.items()}
        check_arrays("params", saved.params, rows, {})
        check_optimizer(saved.optimizer, saved.params)
        check_history(saved.history, step)
    except Error as failure:
        expected = "a checkpoint of a design"
        raise IoError(message("recover", f"{path}", expected, failure)) from failure
    x.update({name: saved.params[name] for name in x})
    adam.load_state(saved.optimizer)
    return [(float(a), float(b), float(c)) for a, b, c in saved.history]


def digest(arrays: Iterable[Array]) -> str:
    """A short text that changes with any of the arrays."""
    data = b"".join(np.ascontiguousarray(array).tobytes() for array in arrays)
    return hashlib.sha256(data).hexdigest()[:16]

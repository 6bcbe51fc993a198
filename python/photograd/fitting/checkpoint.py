"""Checkpoints: everything that a fit needs to go on, in one file that is replaced atomically.

A checkpoint is a NumPy archive: `params.NAME`, `optimiser.NAME`, `state.NAME`, `history`, and
`meta`, a JSON text with the format's version, the step, the options, the policy of the march and
where the capture lies. A crash or a full disk while saving leaves the previous checkpoint as it
was.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd._npz import read_npz
from photograd.errors import IoError, message
from photograd.types import Array

VERSION = 1
FILE_NAME = "model.npz"
_EXPECTED, _REMEDY = "a photograd checkpoint", "the file is damaged: restore it or fit again"


@dataclass(frozen=True)
class Checkpoint:
    """The contents of a checkpoint file."""

    meta: dict[str, Any]
    params: dict[str, Array]
    optimiser: dict[str, Array]
    state: dict[str, Array]
    history: Array  # (n, 3): step, loss, PSNR of the batch


def save_checkpoint(path: Path, checkpoint: Checkpoint) -> None:
    """Write the file atomically. Raises IoError if that fails; the old file then survives."""
    arrays: dict[str, Any] = {"history": checkpoint.history}
    arrays["meta"] = np.array(json.dumps({"version": VERSION, **checkpoint.meta}))
    for prefix in ("params", "optimiser", "state"):
        for name, array in getattr(checkpoint, prefix).items():
            arrays[f"{prefix}.{name}"] = array
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    atomic_write(path, buffer.getvalue())


def load_checkpoint(path: str | Path) -> Checkpoint:
    """Read a checkpoint; `path` may be the file or the folder of a fit.

    Raises IoError if the file is missing, damaged, or of an unknown version.
    """
    path = Path(path)
    file = path / FILE_NAME if path.is_dir() else path
    if not file.is_file():
        raise IoError(
            message("load_checkpoint", "path", "a model (DIR/model.npz)", f"{path}, which is none",
                    "run 'photograd fit' first")
        )  # fmt: skip
    arrays = read_npz("load_checkpoint", file, expected=_EXPECTED, remedy=_REMEDY)
    try:
        meta = json.loads(str(arrays.pop("meta")))
        history = arrays.pop("history")
    except (KeyError, ValueError, RecursionError) as failure:
        raise _damaged(file, f"{failure}") from failure
    if not isinstance(meta, dict):
        raise _damaged(file, f"meta that is no JSON object but {type(meta).__name__}")
    if meta.get("version") != VERSION:
        raise IoError(
            message("load_checkpoint", f"{file}", f"version {VERSION}", f"{meta.get('version')}",
                    "it was written by another version of photograd")
        )  # fmt: skip
    for name, array in {"history": history, **arrays}.items():
        if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiub":
            raise _damaged(file, f"{name} that is no array of numbers")
    if history.ndim != 2 or history.shape[1] != 3:
        raise _damaged(file, f"a history of shape {history.shape} instead of (N, 3)")
    return Checkpoint(
        meta, _part(arrays, "params"), _part(arrays, "optimiser"), _part(arrays, "state"), history
    )


def make_folder(folder: Path) -> None:
    """Make a folder for results, and those above it. Raises IoError if that cannot be done."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as failure:
        got = failure.strerror or f"{failure}"
        expected = f"a folder that can be made at {folder}"
        raise IoError(message("make_folder", "folder", expected, got)) from failure


def _damaged(file: Path, got: str) -> IoError:
    return IoError(message("load_checkpoint", f"{file}", _EXPECTED, got, _REMEDY))


def _part(arrays: Mapping[str, Array], prefix: str) -> dict[str, Array]:
    start = prefix + "."
    return {name[len(start) :]: a for name, a in arrays.items() if name.startswith(start)}

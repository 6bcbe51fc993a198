"""Checkpoints: everything that a descent needs to go on, written atomically, checked when read.

A checkpoint is a NumPy archive: `params.NAME`, `optimizer.NAME`, `state.NAME`, `history`, and
`meta`, a JSON text with the format's version, the step, the options and what they were used on. A
crash or a full disk while saving leaves the previous checkpoint as it was.

A `Row` describes an array: its types, and its shape, where a letter is the same number throughout
the file. Values are checked for what arithmetic needs (finite, not negative); what they mean is
checked by the representation that is made of them.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd._checks import typed
from photograd._files import read_npz
from photograd.errors import DtypeError, Error, IoError, RangeError, ShapeError, message
from photograd.types import Array

VERSION = 2
FILE_NAME = "model.npz"
_EXPECTED, _REMEDY = "a photograd checkpoint", "the file is damaged: restore it or fit again"


@dataclass(frozen=True)
class Checkpoint:
    """The contents of a checkpoint file."""

    meta: dict[str, Any]
    params: dict[str, Array]
    optimizer: dict[str, Array]
    state: dict[str, Array]
    history: Array  # (n, 3): step, loss, PSNR of the batch


def save_checkpoint(path: Path, checkpoint: Checkpoint) -> Path:
    """Write the file atomically. Raises IoError if that fails; the old file then survives."""
    arrays: dict[str, Any] = {"history": checkpoint.history}
    arrays["meta"] = np.array(json.dumps({"version": VERSION, **checkpoint.meta}))
    for prefix in ("params", "optimizer", "state"):
        for name, array in getattr(checkpoint, prefix).items():
            arrays[f"{prefix}.{name}"] = array
    write_npz(path, arrays)
    return path


def write_npz(path: Path, arrays: Mapping[str, Any]) -> None:
    """Write a NumPy archive atomically. Raises IoError if that fails; an old file then survives."""
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
            message(
                "load_checkpoint",
                "path",
                "a model (DIR/model.npz)",
                f"{path}, which is none",
                "run 'photograd fit' first",
            )
        )
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
            message(
                "load_checkpoint",
                f"{file}",
                f"version {VERSION}",
                f"{meta.get('version')}",
                "it was written by another version of photograd",
            )
        )
    for name, array in {"history": history, **arrays}.items():
        if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiub":
            raise _damaged(file, f"{name} that is no array of numbers")
    if history.ndim != 2 or history.shape[1] != 3:
        raise _damaged(file, f"a history of shape {history.shape} instead of (N, 3)")
    return Checkpoint(
        meta, _part(arrays, "params"), _part(arrays, "optimizer"), _part(arrays, "state"), history
    )


def holds_steps(file: Path) -> bool:
    """Whether a file has something to lose: all but a checkpoint from before the first step."""
    if not file.exists():
        return False
    try:
        meta = json.loads(str(read_npz("load_checkpoint", file, ["meta"])["meta"]))
        return bool(meta["step"] != 0)
    except (Error, KeyError, TypeError, ValueError, RecursionError):
        return True


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


# What checkpoints must hold: names, types and shapes, checked before any is used.


Row: TypeAlias = tuple[tuple[str, ...], tuple[int | str, ...]]
"""Types, of which the array has one, and shape."""
_NAME = "checkpoint"
FLOAT = ("float32", "float64")
MAX_STEPS = 1 << 40


def checked_step(saved: Checkpoint) -> int:
    """The number of steps that were done; raises DtypeError or RangeError for what is none."""
    step = int(typed(_NAME, "meta.step", int, saved.meta.get("step")))
    if not 0 <= step <= MAX_STEPS:
        raise RangeError(message(_NAME, "meta.step", f"0 to {MAX_STEPS}", step))
    return step


def check_arrays(
    part: str, arrays: Mapping[str, Array], rows: Mapping[str, Row], sizes: dict[str, int]
) -> None:
    """Raise DtypeError, ShapeError or RangeError unless names, types and shapes of the arrays of a
    part are those of its rows, and their values finite; `sizes` gains what the letters stand for.
    """
    odd = sorted(set(arrays) ^ set(rows))
    if odd:
        got = f"missing or unknown {', '.join(odd[:5])}"
        raise RangeError(message(_NAME, part, f"{sorted(rows) or 'nothing'}", got))
    for name, (kinds, shape) in rows.items():
        array = arrays[name]
        if not any(array.dtype == np.dtype(kind) for kind in kinds):
            raise DtypeError(message(_NAME, f"{part}.{name}", " or ".join(kinds), array.dtype))
        fits = array.ndim == len(shape) and all(
            found == (sizes.setdefault(size, found) if isinstance(size, str) else size)
            for size, found in zip(shape, array.shape, strict=True)
        )
        if not fits:
            told = f"({', '.join(_size_text(size, sizes) for size in shape)})"
            raise ShapeError(message(_NAME, f"{part}.{name}", f"shape {told}", array.shape))
        _require_finite(f"{part}.{name}", array)


def _size_text(size: int | str, sizes: Mapping[str, int]) -> str:
    known = isinstance(size, str) and size in sizes
    return f"{size} = {sizes[str(size)]}" if known else f"{size}"


def _require_finite(name: str, array: Array) -> None:
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        count = array.size - int(np.isfinite(array).sum())
        raise RangeError(message(_NAME, name, "finite values", f"{count} that are not"))


def check_optimizer(state: Mapping[str, Array], params: Mapping[str, Array]) -> None:
    """Raise as `check_arrays` unless Adam's moments are those of the parameters, or of some."""
    groups = {key.partition("/")[2] for key in state}
    expected: dict[str, Any] = {}
    for group in sorted(groups & set(params)):
        array = params[group]
        expected[f"step/{group}"] = (("int64",), ())
        for slot in ("mean", "mean_square"):
            expected[f"{slot}/{group}"] = ((array.dtype.name,), array.shape)
    check_arrays("optimizer", state, expected, {})
    for key, array in state.items():
        least = -np.inf if key.startswith("mean/") else 0
        if array.size and array.min() < least:
            raise RangeError(message(_NAME, f"optimizer.{key}", "0 or more", array.min()))
        if key.startswith("step/") and array > MAX_STEPS:
            raise RangeError(message(_NAME, f"optimizer.{key}", f"0 to {MAX_STEPS}", array))


def check_history(history: Array, step: int) -> None:
    """Raise as `check_arrays` unless these are rows of step, loss and another number, in order."""
    if history.dtype != np.float64:
        raise DtypeError(message(_NAME, "history", "float64", history.dtype))
    _require_finite("history", history)
    steps = history[:, 0]
    in_order = bool((np.diff(steps) > 0).all()) and bool(((steps >= 0) & (steps < step)).all())
    if not in_order:
        expected = f"rising steps below {step}"
        raise RangeError(message(_NAME, "history", expected, "others"))

"""Checkpoints: everything that a fit needs to go on, written atomically and checked when read.

A checkpoint is a NumPy archive: `params.NAME`, `optimiser.NAME`, `state.NAME`, `history`, and
`meta`, a JSON text with the format's version, the step, the options, the policy of the march and
where the capture lies. A crash or a full disk while saving leaves the previous checkpoint as it
was.

Each array has a row here: its types, and its shape, where a letter is the same number throughout
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

from photograd import sh
from photograd._checks import typed
from photograd._files import read_npz
from photograd.errors import DtypeError, IoError, RangeError, ShapeError, message
from photograd.fitting.options import FitOptions
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


# What checkpoints must hold: names, types and shapes, checked before any is used.


Row: TypeAlias = tuple[tuple[str, ...], tuple[int | str, ...]]
"""Types, of which the array has one, and shape."""
_NAME = "checkpoint"
_FLOAT = ("float32", "float64")
_HARMONICS: dict[str, Row] = {"density": (_FLOAT, ("N",)), "sh": (_FLOAT, ("N", "K", 3))}
_ACTIVE: dict[str, Row] = {
    "shape": (("int64",), (3,)),
    "mask": (("uint8",), ("bytes of the mask",)),
    "background_density": (_FLOAT, ()),
}
PARAMS: dict[str, dict[str, Row]] = {
    "dense_grid": {"values": (_FLOAT, ("X", "Y", "Z", 4))},
    "sparse_sh": _HARMONICS,
    "dense_sh": _HARMONICS,
    "octree_sh": _HARMONICS,
    "gaussians": {
        "means": (_FLOAT, ("N", 3)),
        "log_scales": (_FLOAT, ("N", 3)),
        "quats": (_FLOAT, ("N", 4)),
        "opacity_logits": (_FLOAT, ("N",)),
        "sh_constant": (_FLOAT, ("N", 1, 3)),
        "sh_rest": (_FLOAT, ("N", "K - 1", 3)),
    },
}
STATE: dict[str, dict[str, Row]] = {
    "dense_grid": {},
    "sparse_sh": _ACTIVE,
    "dense_sh": _ACTIVE,
    "octree_sh": {
        "lower": (("int32",), ("L", 3)),
        "side": (("int32",), ("L",)),
        "row": (("int32",), ("L",)),
    },
    "gaussians": {
        "active_degree": (("int64",), ()),
        "extent": (("float64",), ()),
        "pressure_sum": (("float64",), ("N",)),
        "pressure_count": (("int64",), ("N",)),
    },
}
BACKGROUND: Row = (("float32",), (3,))
META = ("capture", "split", "pixels", "color_space")
"""Texts that may be missing: snapshots belong to a fit, and know of no capture."""
MOST_STEPS = 1 << 40


def check_checkpoint(saved: Checkpoint, options: FitOptions) -> None:
    """Raise DtypeError, ShapeError or RangeError that names what a fit could not go on with.

    The state of the optimizer may be empty, as in snapshots; a group of it is complete or absent.
    """
    step = checked_step(saved)
    for name in sorted(saved.meta.keys() & set(META)):
        typed(_NAME, f"meta.{name}", str, saved.meta[name])
    if options.representation not in PARAMS:
        expected = f"one of {list(PARAMS)}"
        got = repr(options.representation)
        raise RangeError(message(_NAME, "options.representation", expected, got))
    count = sh.count(options.degree)
    sizes: dict[str, int] = {"K": count, "K - 1": count - 1}
    params = dict(PARAMS[options.representation])
    if "background" in saved.params:
        params["background"] = BACKGROUND
    check_arrays("params", saved.params, params, sizes)
    kinds = {array.dtype for name, array in saved.params.items() if name != "background"}
    if len(kinds) > 1:
        got = ", ".join(sorted(map(str, kinds)))
        raise DtypeError(message(_NAME, "params", "one type of all groups", got))
    check_arrays("state", saved.state, STATE[options.representation], sizes)
    _check_values(options.representation, saved.state)
    check_optimizer(saved.optimiser, saved.params)
    check_history(saved.history, step)


def checked_step(saved: Checkpoint) -> int:
    """The number of steps that were done; raises DtypeError or RangeError for what is none."""
    step = int(typed(_NAME, "meta.step", int, saved.meta.get("step")))
    if not 0 <= step <= MOST_STEPS:
        raise RangeError(message(_NAME, "meta.step", f"0 to {MOST_STEPS}", step))
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


def _check_values(representation: str, state: Mapping[str, Array]) -> None:
    """Numbers of the state that sizes and sums are made of."""
    if "mask" in state:
        x, y, z = state["shape"].tolist()
        if min(x, y, z) < 1 or -(-x * y * z // 8) != len(state["mask"]):
            expected = f"voxels of which {len(state['mask'])} bytes are the mask, a bit each"
            raise RangeError(message(_NAME, "state.shape", expected, (x, y, z)))
    if representation == "gaussians":
        for name in ("pressure_sum", "pressure_count"):
            if state[name].size and state[name].min() < 0:
                got = state[name].min()
                raise RangeError(message(_NAME, f"state.{name}", "0 or more", got))


def check_optimizer(state: Mapping[str, Array], params: Mapping[str, Array]) -> None:
    """Raise as `check_arrays` unless Adam's moments are those of the parameters, or of some."""
    groups = {key.partition("/")[2] for key in state}
    expected: dict[str, Any] = {}
    for group in sorted(groups & set(params)):
        array = params[group]
        expected[f"step/{group}"] = (("int64",), ())
        for slot in ("mean", "mean_square"):
            expected[f"{slot}/{group}"] = ((array.dtype.name,), array.shape)
    check_arrays("optimiser", state, expected, {})
    for key, array in state.items():
        least = -np.inf if key.startswith("mean/") else 0
        if array.size and array.min() < least:
            raise RangeError(message(_NAME, f"optimiser.{key}", "0 or more", array.min()))
        if key.startswith("step/") and array > MOST_STEPS:
            raise RangeError(message(_NAME, f"optimiser.{key}", f"0 to {MOST_STEPS}", array))


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

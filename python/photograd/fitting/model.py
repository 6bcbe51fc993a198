"""A recovered scene, ready to be rendered: the field, its background, the fit's record."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from photograd._checkpoint import (
    Checkpoint,
    Row,
    check_arrays,
    check_history,
    check_optimizer,
    checked_step,
    load_checkpoint,
    make_folder,
    save_checkpoint,
)
from photograd._checks import from_plain, require_path, typed
from photograd._fit_options import FitOptions
from photograd.errors import DtypeError, Error, IoError, RangeError, message
from photograd.fields import fittable
from photograd.fitting.data import learned_background
from photograd.fitting.drawing import field_html
from photograd.representation import Fittable
from photograd.types import Array

BACKGROUND: Row = (("float32",), (3,))
TEXTS = ("capture", "split", "pixels", "color_space")
"""Of the meta data; they may be missing: snapshots belong to a fit, and know of no capture."""


@dataclass(frozen=True)
class Model:
    """A fitted field, ready to be rendered and saved.

    Attributes:
        field: the representation.
        background: linear color (3,) that was learned with it, or None.
        options: of the fit.
        meta: capture, split, color space and versions, as `photograd info` shows them.
        history: (steps, 3): step, loss, PSNR of the batch in dB;
            `photograd_course.viz.fit_curves(FitCurves(*model.history.T))` draws it.
    """

    field: Fittable
    background: Array | None
    options: FitOptions
    meta: dict[str, Any]
    history: Array

    @classmethod
    def of(cls, field: Fittable) -> Model:
        """A field that no fit has made, to be drawn or for a fit to start from.

        Raises:
            DtypeError: no `Fittable`.
        """
        if not isinstance(field, Fittable):
            got = type(field).__name__
            raise DtypeError(message("Model.of", "field", "a Fittable representation", got))
        return cls(field, None, FitOptions(field.name), {}, np.zeros((0, 3)))

    def _repr_html_(self) -> str:
        """Its size, how far it was fitted, and a picture."""
        facts: dict[str, object] = {}
        if len(self.history):
            step, loss, _ = self.history[-1].tolist()
            facts = {"step": f"{step:.0f} of {self.options.steps}", "loss": f"{loss:.3g}"}
        return field_html("Model", self.field, self.background, facts)


def load_model(path: str | Path) -> Model:
    """Load the model that a fit left in a folder.

    Args:
        path: the folder, or the file model.npz in it, or one of its snapshots.

    Raises:
        DtypeError: neither a text nor a `Path`.
        IoError: no file, or one that is damaged or holds something else.

    Example:
        >>> model = photograd.fit("photos", resolution=8, steps=2, rays=16, folder="model")
        >>> photograd.load_model("model").field.name
        'dense_grid'
    """
    path = require_path("load_model", "path", path)
    return model_of(load_checkpoint(path), path)


def model_of(saved: Checkpoint, path: Path) -> Model:
    """The model in a checkpoint.

    Raises IoError if its contents, the optimizer's state included, do not fit together.

    Args:
        saved: a checkpoint.
        path: where it was read, for errors.
    """
    try:
        options = from_plain("checkpoint", FitOptions, saved.meta.get("options"))
        check_checkpoint(saved, options)
        kind = fittable()[options.representation]
        field = kind.restored(saved.params, saved.state, saved.meta.get("policy"), options)
    except Error as failure:
        remedy = "the file is from another version or damaged"
        expected = "a checkpoint of a fit"
        raise IoError(message("load_model", f"{path}", expected, failure, remedy)) from failure
    raw = saved.params.get("background")
    background = None if raw is None else learned_background(raw.astype(np.float64))
    return Model(field, background, options, saved.meta, saved.history)


def check_checkpoint(saved: Checkpoint, options: FitOptions) -> None:
    """Raise DtypeError, ShapeError or RangeError that names what a fit could not go on with.

    The state of the optimizer may be empty, as in snapshots; a group of it is complete or absent.

    Args:
        saved: a checkpoint.
        options: of its fit.
    """
    step = checked_step(saved)
    for name in sorted(saved.meta.keys() & set(TEXTS)):
        typed("checkpoint", f"meta.{name}", str, saved.meta[name])
    kind = fittable().get(options.representation)
    if kind is None:
        expected, got = f"one of {list(fittable())}", repr(options.representation)
        raise RangeError(message("checkpoint", "options.representation", expected, got))
    params, state = kind.checkpoint_rows(options)
    if "background" in saved.params:
        params = {**params, "background": BACKGROUND}
    sizes: dict[str, int] = {}
    check_arrays("params", saved.params, params, sizes)
    kinds = {array.dtype for name, array in saved.params.items() if name != "background"}
    if len(kinds) > 1:
        got = ", ".join(sorted(map(str, kinds)))
        raise DtypeError(message("checkpoint", "params", "one type of all groups", got))
    check_arrays("state", saved.state, state, sizes)
    check_optimizer(saved.optimizer, saved.params)
    check_history(saved.history, step)


# The model at a few chosen steps of a fit, for pictures of how it came about.


FRACTIONS = (0.0, 0.03, 0.1, 0.3, 1.0)


def snapshot_steps(options: FitOptions) -> set[int]:
    """The steps after which a fit keeps a snapshot; step 0 is the start.

    Args:
        options: of the fit.
    """
    return {int(fraction * options.steps) for fraction in FRACTIONS}


def snapshot_file(folder: Path, step: int) -> Path:
    """Where the snapshot of a step lies.

    Args:
        folder: of the fit.
        step: after which it was written.
    """
    return folder / "snapshots" / f"step_{step:06d}.npz"


def save_snapshot(folder: Path, field: Fittable, options: FitOptions, step: int) -> None:
    """Write the field as it is now.

    Args:
        folder: of the fit.
        field: as it is now.
        options: of the fit.
        step: after which it is written.
    """
    meta = {"policy": asdict(field.policy), "options": asdict(options), "step": step}
    make_folder(folder / "snapshots")
    save_checkpoint(
        snapshot_file(folder, step),
        Checkpoint(meta, dict(field.params), {}, field.state(), np.zeros((0, 3))),
    )


def load_snapshots(folder: Path) -> dict[int, Fittable]:
    """{step: field} of all snapshots of a fit, in order; empty if it kept none.

    Args:
        folder: of the fit, or a file in it.
    """
    beside = folder if folder.is_dir() else folder.parent
    found = {}
    for file in sorted((beside / "snapshots").glob("step_*.npz")):
        saved = load_checkpoint(file)
        found[int(saved.meta["step"])] = model_of(saved, file).field
    return found

"""The model at a few chosen steps of a fit, for pictures of how it came about."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np

from photograd.fitting.checkpoint import Checkpoint, load_checkpoint, make_folder, save_checkpoint
from photograd.fitting.model import model_of
from photograd.fitting.options import FitOptions
from photograd.fitting.start import FittedField

FRACTIONS = (0.0, 0.03, 0.1, 0.3, 1.0)


def snapshot_steps(options: FitOptions) -> set[int]:
    """The steps after which a fit keeps a snapshot; step 0 is the start."""
    return {int(fraction * options.steps) for fraction in FRACTIONS}


def snapshot_file(folder: Path, step: int) -> Path:
    """Where the snapshot of a step lies."""
    return folder / "snapshots" / f"step_{step:06d}.npz"


def save_snapshot(folder: Path, field: FittedField, options: FitOptions, step: int) -> None:
    """Write the field as it is now."""
    meta = {"policy": asdict(field.policy), "options": asdict(options), "step": step}
    make_folder(folder / "snapshots")
    save_checkpoint(
        snapshot_file(folder, step),
        Checkpoint(meta, dict(field.params), {}, field.state(), np.zeros((0, 3))),
    )


def load_snapshots(folder: Path) -> dict[int, FittedField]:
    """{step: field} of all snapshots of a fit, in order; empty if it kept none."""
    place = folder if folder.is_dir() else folder.parent
    found = {}
    for file in sorted((place / "snapshots").glob("step_*.npz")):
        saved = load_checkpoint(file)
        found[int(saved.meta["step"])] = model_of(saved, file).field
    return found

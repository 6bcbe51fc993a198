"""A recovery on disk: what it needs to go on, and what shows that it is the same one."""

from __future__ import annotations

import hashlib
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from photograd.errors import Error, IoError, RangeError, message
from photograd.fitting.checkpoint import (
    Checkpoint,
    check_arrays,
    check_history,
    check_optimizer,
    checked_step,
    load_checkpoint,
    save_checkpoint,
)
from photograd.transport.scene_digest import scene_digest
from photograd.types import Array

if TYPE_CHECKING:
    from photograd.transport.inverse.job import Recovery

FILE_NAME = "recovery.npz"


def save_state(folder: Path, job: Recovery, sampled: dict[str, Array]) -> None:
    """Write DIR/recovery.npz; `sampled` are the values that the tracer was built with."""
    state = {f"sampled.{name}": value for name, value in sampled.items()}
    state |= {f"curves.{name}": np.array(rows) for name, rows in job.curves.items()}
    meta = {"step": job.step_number, **fingerprint(job)}
    history = np.array(job.history, np.float64).reshape(-1, 3)
    save_checkpoint(
        folder / FILE_NAME, Checkpoint(meta, dict(job.x), job.optimiser.state(), state, history)
    )


def load_state(folder: Path, job: Recovery) -> dict[str, Array]:
    """Bring a job to where its checkpoint ends; the values that its tracer was built with.

    Raises:
        IoError: a missing or damaged checkpoint.
        RangeError: one of another recovery.
    """
    path = folder / FILE_NAME
    if not path.is_file():
        expected = f"a recovery ({FILE_NAME})"
        raise IoError(message("recover", "folder", expected, f"none in {folder}"))
    saved = load_checkpoint(path)
    _require_same(fingerprint(job), saved.meta)
    try:
        job.step_number = _checked_step(saved, job)
    except Error as failure:
        expected = "a checkpoint of a recovery"
        raise IoError(message("recover", f"{path}", expected, failure)) from failure
    job.x = {name: saved.params[name] for name in job.x}
    sampled = {name: saved.state[f"sampled.{name}"] for name in job.x}
    job.curves = {name: list(saved.state[f"curves.{name}"]) for name in job.x}
    job.optimiser.load_state(saved.optimiser)
    job.history = [(float(a), float(b), float(c)) for a, b, c in saved.history]
    return sampled


def _checked_step(saved: Checkpoint, job: Recovery) -> int:
    """Steps done. Raises Error unless the arrays are those of a recovery of the same unknowns."""
    step = checked_step(saved)
    kinds, state = ("float64",), {}
    for name, x in job.x.items():
        state[f"sampled.{name}"] = (kinds, x.shape)
        state[f"curves.{name}"] = (kinds, (step + 1, *job.curves[name][0].shape))
    check_arrays("params", saved.params, {name: (kinds, x.shape) for name, x in job.x.items()}, {})
    check_arrays("state", saved.state, state, {})
    check_optimizer(saved.optimiser, saved.params)
    check_history(saved.history, step)
    return step


def _require_same(own: dict[str, Any], saved: dict[str, Any]) -> None:
    """Raise RangeError that says in what a checkpoint is of another recovery."""
    remedy = "resume with what it was started with, or choose another folder"
    for name, value in own.items():
        other = saved.get(name)
        if other == value:
            continue
        got = f"other {name}"
        if isinstance(other, dict) and isinstance(value, dict):
            differing = [key for key in value if other.get(key) != value[key]]
            got = f"another {', '.join(differing)}"
        expected = f"the {name} of the checkpoint"
        raise RangeError(message("recover", name, expected, got, remedy))


def fingerprint(job: Recovery) -> dict[str, Any]:
    """The options, and short texts that change with the scene, the pictures and the unknowns."""
    pictures = hashlib.sha256()
    for target in job.targets:
        camera = target.camera
        assert camera is not None
        pictures.update(target.image.tobytes())
        pictures.update(b"" if target.weight is None else target.weight.tobytes())
        pictures.update(repr((camera.fx, camera.fy, camera.cx, camera.cy)).encode())
        pictures.update(camera.world_from_camera.tobytes())
    unknowns = hashlib.sha256()
    for each in job.unknowns.values():
        start = "" if each.start is None else np.asarray(each.start, np.float64).tobytes().hex()
        told = (each.name, start, each.bounds, each.activation, each.rate)
        unknowns.update(repr(told).encode())
    texts = {
        "scene": scene_digest(job.scene, without=("name", "camera")),  # targets have their own
        "targets": pictures.hexdigest(),
        "unknowns": unknowns.hexdigest(),
    }
    return {**{name: text[:16] for name, text in texts.items()}, "options": asdict(job.options)}

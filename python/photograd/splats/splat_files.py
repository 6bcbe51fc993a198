"""Gaussians in .splat files, as the viewer antimatter15/splat has them: 32 bytes each, no header.

    f32 position[3], f32 scale[3] (standard deviations), u8 red, green, blue, opacity (of 255),
    u8 quaternion[4], w x y z, each 128 + 128 q

One colour from all directions. The frame is that of the .ply file that it was made from.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write
from photograd_course.input_files import read_file

from photograd.errors import IoError, message
from photograd.sh import Y_0
from photograd.splats.coding import (
    Coding,
    Codings,
    logit_of,
    opacity_of,
    require_room,
    turn_of_error,
    unit_quats,
)
from photograd.splats.splatting import Gaussians
from photograd.types import Array

_NAME = "read_gaussian_splat"
RECORD = np.dtype([("mean", "<f4", 3), ("scale", "<f4", 3), ("rgba", "u1", 4), ("quat", "u1", 4)])
LOG_SCALES = (-87.0, 88.0)
"""Exponentials that float32 holds in full precision."""


def read_gaussian_splat(path: Path, *, memory_limit: int | None = None) -> Gaussians:
    """Read Gaussians in float32, degree 0. Opacities of 0 and 255 have infinite logits.

    Raises:
        IoError: no file, an empty one, one of another length than whole records, more than memory
            holds, or positions and scales that are none.
    """
    content = read_file(_NAME, path)
    if not content or len(content) % RECORD.itemsize:
        expected = f"whole records of {RECORD.itemsize} bytes, at least one"
        raise IoError(message(_NAME, f"{path}", expected, f"{len(content)} bytes"))
    rows = np.frombuffer(content, RECORD)
    require_room(_NAME, path, len(rows), 1, memory_limit)
    bad = ~np.isfinite(rows["mean"]).all(axis=1)
    bad |= ~(np.isfinite(rows["scale"]) & (rows["scale"] >= 0)).all(axis=1)
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        got = f"{rows['mean'][row].tolist()} and {rows['scale'][row].tolist()} in row {row}"
        raise IoError(message(_NAME, f"{path}", "finite positions and scales from 0", got))
    with np.errstate(divide="ignore"):
        log_scales = np.log(rows["scale"].astype(np.float64))
    rgba = rows["rgba"] / 255.0
    return Gaussians(
        means=rows["mean"].astype(np.float32),
        log_scales=log_scales.astype(np.float32),
        quats=unit_quats(rows["quat"] - 128.0).astype(np.float32),
        opacity_logits=logit_of(rgba[:, 3]).astype(np.float32),
        sh=((rgba[:, None, :3] - 0.5) / Y_0).astype(np.float32),
    )


def write_gaussian_splat(path: Path, gaussians: Gaussians) -> None:
    """Write Gaussians in their order, whole or not at all; harmonics above degree 0 are dropped.

    Raises:
        IoError: none to write, since an empty file would be no .splat, or it cannot be written.
    """
    if not len(gaussians):
        raise IoError(message("write_gaussian_splat", "gaussians", "at least one", 0))
    rows = np.zeros(len(gaussians), RECORD)
    rows["mean"] = gaussians.means
    rows["scale"] = np.exp(gaussians.log_scales.astype(np.float64).clip(*LOG_SCALES))
    color = 0.5 + Y_0 * gaussians.sh[:, 0].astype(np.float64)
    rgba = np.concatenate([color, opacity_of(gaussians.opacity_logits)[:, None]], axis=1)
    rows["rgba"] = np.rint(255.0 * rgba.clip(0.0, 1.0))
    rows["quat"] = np.rint(128.0 + 128.0 * unit_quats(gaussians.quats)).clip(0.0, 255.0)
    atomic_write(path, rows.tobytes())


def splat_codings(gaussians: Gaussians) -> Codings:
    """Errors of half a step, and of float32.

    A quaternion's components are off by 1/256 each, one near 1 by 1/128 since 256 is no byte: an
    error of length sqrt(3 + 4)/256.
    """
    largest = float(np.abs(gaussians.log_scales).max(initial=0.0, where=_finite(gaussians)))
    return {
        "means": Coding(0.0),
        "log_scales": Coding(6e-8 * (2.0 + min(largest, 88.0)), *LOG_SCALES),
        "rotation": Coding(turn_of_error(np.sqrt(7.0) / 256.0)),
        "opacity": Coding(0.5 / 255.0 + 1e-7),
        "color": Coding(0.5 / 255.0 + 1e-6, -1e-6, 1.0 + 1e-6),
    }


def _finite(gaussians: Gaussians) -> Array:
    return np.isfinite(gaussians.log_scales)

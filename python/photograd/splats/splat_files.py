"""Gaussians in .splat files of 32 bytes each, and colored points with cameras in .npz files.

The viewer antimatter15/splat has them without a header:

    f32 position[3], f32 scale[3] (standard deviations), u8 red, green, blue, opacity (of 255),
    u8 quaternion[4], w x y z, each 128 + 128 q

One color from all directions. The frame is that of the .ply file that it was made from.

An .npz file, as of gsplat's sample scene, holds means3d (N, 3), colors (N, 3) in 8 bits, and
cameras viewmats, Ks, width and height, which are left aside. Points have no size: each becomes a
round Gaussian as wide as the distance to its neighbors, nine tenths opaque. The frame is that of
the file.
"""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from photograd_course.atomic_io import atomic_write
from photograd_course.input_files import read_file, require_file

from photograd._files import read_npz
from photograd.capture.frames import MAX_COORDINATE
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

_SPLAT_READER = "read_gaussian_splat"
RECORD = np.dtype([("mean", "<f4", 3), ("scale", "<f4", 3), ("rgba", "u1", 4), ("quat", "u1", 4)])
LOG_SCALES = (-87.0, 88.0)
"""Exponentials that float32 holds in full precision."""


def read_gaussian_splat(path: Path, *, memory_limit: int | None = None) -> Gaussians:
    """Read Gaussians in float32, degree 0. Opacities of 0 and 255 have infinite logits.

    Args:
        path: of the file.
        memory_limit: bytes that may be taken; None takes what there is.

    Raises:
        IoError: no file, an empty one, one of another length than whole records, more than memory
            holds, or positions and scales that are none.
    """
    content = read_file(_SPLAT_READER, path)
    if not content or len(content) % RECORD.itemsize:
        expected = f"whole records of {RECORD.itemsize} bytes, at least one"
        raise IoError(message(_SPLAT_READER, f"{path}", expected, f"{len(content)} bytes"))
    rows = np.frombuffer(content, RECORD)
    require_room(_SPLAT_READER, path, len(rows), 1, memory_limit)
    bad = ~np.isfinite(rows["mean"]).all(axis=1)
    bad |= ~(np.isfinite(rows["scale"]) & (rows["scale"] >= 0)).all(axis=1)
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        got = f"{rows['mean'][row].tolist()} and {rows['scale'][row].tolist()} in row {row}"
        raise IoError(message(_SPLAT_READER, f"{path}", "finite positions and scales from 0", got))
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

    Args:
        path: of the file.
        gaussians: to be written.

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

    Args:
        gaussians: to be written.
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


# Colored points with cameras in .npz files, as gsplat's sample scene has them, as Gaussians.


_NPZ_READER = "read_point_npz"
NEEDED = ("means3d", "colors")
OPACITY = 0.9
WINDOW = 8
MAX_SPACING = 4.0
"""In medians; strays far from all others would cover the scene."""
_LEVELS = 1 << 10


def read_point_npz(path: Path, *, memory_limit: int | None = None) -> tuple[Gaussians, list[str]]:
    """Read points as Gaussians in float32, degree 0, and sentences for the log.

    Args:
        path: of the file.
        memory_limit: bytes that may be taken; None takes what there is.

    Raises:
        IoError: no file, a damaged one, other arrays, more than memory holds, or positions that are
            no numbers.
    """
    arrays = read_npz(_NPZ_READER, path, NEEDED, memory_limit=memory_limit)
    means, colors = arrays["means3d"], arrays["colors"]
    n = len(means) if means.ndim else 0
    if means.shape != (n, 3) or means.dtype.kind != "f" or not n:
        got = f"{means.dtype} of shape {means.shape}"
        raise _refusal(path, "means3d: floats of shape (N, 3), at least one", got)
    if colors.shape != (n, 3) or colors.dtype != np.uint8:
        got = f"{colors.dtype} of shape {colors.shape}"
        raise _refusal(path, f"colors: uint8 of shape ({n}, 3)", got)
    require_room(_NPZ_READER, path, n, 1, memory_limit)
    bad = ~(np.abs(means) <= MAX_COORDINATE).all(axis=1)
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        raise _refusal(path, "finite means3d up to 1e9", f"{means[row].tolist()} in row {row}")
    size = neighbor_spacing(means.astype(np.float64))
    gaussians = Gaussians(
        means=means.astype(np.float32),
        log_scales=np.repeat(np.log(size)[:, None], 3, axis=1).astype(np.float32),
        quats=np.tile(np.array([1, 0, 0, 0], np.float32), (n, 1)),
        opacity_logits=np.full(n, logit_of(np.array(OPACITY)), np.float32),
        sh=((colors[:, None] / 255.0 - 0.5) / Y_0).astype(np.float32),
    )
    line = (
        "points without sizes: round Gaussians as wide as half the distance to neighbors, "
        f"opacity {OPACITY}; the file's cameras are left aside"
    )
    return gaussians, [line]


def is_point_npz(path: Path) -> bool:
    """Whether a file is a .npz archive with the arrays of this format.

    Args:
        path: of a file.
    """
    try:
        require_file(_NPZ_READER, path)
        with zipfile.ZipFile(path) as archive:
            return {f"{name}.npy" for name in NEEDED} <= set(archive.namelist())
    except (OSError, ValueError, zipfile.BadZipFile, NotImplementedError):
        return False


def neighbor_spacing(points: Array) -> Array:
    """(N,) half of the mean distance to the nearest three of 16 neighbors along a Morton curve.

    The curve visits the cells of a 1024^3 grid so that what is near on it is near in space. What is
    near in space may lie far apart on it, so that some of the sizes are too large; none is taken
    for larger than four medians. They serve for looking, not for measuring.

    Args:
        points: (N, 3).
    """
    n = len(points)
    extent = float(np.ptp(points, axis=0).max(initial=0.0))
    if n < 2 or not extent > 0.0:
        return np.full(n, 1e-3)
    order = morton_order(points)
    along = points[order]
    distances = np.full((n, 2 * WINDOW), np.inf)
    for step in range(1, min(WINDOW, n - 1) + 1):
        gap = np.linalg.norm(along[step:] - along[:-step], axis=1)
        distances[step:, 2 * step - 2] = gap
        distances[:-step, 2 * step - 1] = gap
    nearest = np.sort(distances, axis=1)[:, : min(3, n - 1)]
    mean = np.where(np.isfinite(nearest), nearest, nearest[:, :1]).mean(axis=1)
    size = np.empty(n)
    size[order] = 0.5 * mean.clip(1e-6 * extent, MAX_SPACING * max(np.median(mean), 1e-6 * extent))
    return size


def morton_order(points: Array) -> NDArray[np.int64]:
    """(N,) the order of points along a Morton curve through the cells of a 1024^3 grid.

    Args:
        points: (N, 3), finite; those in one cell keep their order.
    """
    extent = float(np.ptp(points, axis=0).max(initial=0.0))
    scale = (_LEVELS - 1) / extent if extent > 0.0 else 0.0
    cells = ((points - points.min(axis=0)) * scale).astype(np.uint64)
    code = np.zeros(len(points), np.uint64)
    for bit in range(10):
        for axis in range(3):
            level = cells[:, axis] >> np.uint64(bit) & np.uint64(1)
            code |= level << np.uint64(3 * bit + axis)
    return np.argsort(code, kind="stable")


def _refusal(path: Path, expected: str, got: str) -> IoError:
    return IoError(message(_NPZ_READER, f"{path}", expected, got))

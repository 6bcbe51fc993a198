"""Coloured points with cameras in .npz files, as gsplat's sample scene has them, as Gaussians.

The file holds means3d (N, 3), colors (N, 3) in 8 bits, and cameras viewmats, Ks, width and height,
which are left aside. Points have no size: each becomes a round Gaussian as wide as the distance to
its neighbours, nine tenths opaque. The frame is that of the file.
"""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
from photograd_course.input_files import require_file

from photograd._npz import read_npz
from photograd.capture.frames import LARGEST_COORDINATE
from photograd.errors import IoError, message
from photograd.sh import Y_0
from photograd.splats.coding import logit_of, require_room
from photograd.splats.splatting import Gaussians
from photograd.types import Array

_NAME = "read_point_npz"
NEEDED = ("means3d", "colors")
OPACITY = 0.9
WINDOW = 8
LARGEST_SPACING = 4.0
"""In medians; strays far from all others would cover the scene."""
_LEVELS = 1 << 10


def read_point_npz(path: Path, *, memory_limit: int | None = None) -> tuple[Gaussians, list[str]]:
    """Read points as Gaussians in float32, degree 0, and sentences for the log.

    Raises:
        IoError: no file, a damaged one, other arrays, more than memory holds, or positions that are
            no numbers.
    """
    arrays = read_npz(_NAME, path, NEEDED, memory_limit=memory_limit)
    means, colors = arrays["means3d"], arrays["colors"]
    n = len(means) if means.ndim else 0
    if means.shape != (n, 3) or means.dtype.kind != "f" or not n:
        got = f"{means.dtype} of shape {means.shape}"
        raise _refusal(path, "means3d: floats of shape (N, 3), at least one", got)
    if colors.shape != (n, 3) or colors.dtype != np.uint8:
        got = f"{colors.dtype} of shape {colors.shape}"
        raise _refusal(path, f"colors: uint8 of shape ({n}, 3)", got)
    require_room(_NAME, path, n, 1, memory_limit)
    bad = ~(np.abs(means) <= LARGEST_COORDINATE).all(axis=1)
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        raise _refusal(path, "finite means3d up to 1e9", f"{means[row].tolist()} in row {row}")
    size = neighbour_spacing(means.astype(np.float64))
    gaussians = Gaussians(
        means=means.astype(np.float32),
        log_scales=np.repeat(np.log(size)[:, None], 3, axis=1).astype(np.float32),
        quats=np.tile(np.array([1, 0, 0, 0], np.float32), (n, 1)),
        opacity_logits=np.full(n, logit_of(np.array(OPACITY)), np.float32),
        sh=((colors[:, None] / 255.0 - 0.5) / Y_0).astype(np.float32),
    )
    line = (
        "points without sizes: round Gaussians as wide as half the distance to neighbours, "
        f"opacity {OPACITY}; the file's cameras are left aside"
    )
    return gaussians, [line]


def is_point_npz(path: Path) -> bool:
    """Whether a file is a .npz archive with the arrays of this format."""
    try:
        require_file(_NAME, path)
        with zipfile.ZipFile(path) as archive:
            return {f"{name}.npy" for name in NEEDED} <= set(archive.namelist())
    except (OSError, ValueError, zipfile.BadZipFile, NotImplementedError):
        return False


def neighbour_spacing(points: Array) -> Array:
    """(N,) half of the mean distance to the nearest three of 16 neighbours along a Morton curve.

    The curve visits the cells of a 1024^3 grid so that what is near on it is near in space. What is
    near in space may lie far apart on it, so that some of the sizes are too large; none is taken
    for larger than four medians. They serve for looking, not for measuring.
    """
    n = len(points)
    extent = float(np.ptp(points, axis=0).max(initial=0.0))
    if n < 2 or not extent > 0.0:
        return np.full(n, 1e-3)
    cells = ((points - points.min(axis=0)) * ((_LEVELS - 1) / extent)).astype(np.uint64)
    code = np.zeros(n, np.uint64)
    for bit in range(10):
        for axis in range(3):
            level = cells[:, axis] >> np.uint64(bit) & np.uint64(1)
            code |= level << np.uint64(3 * bit + axis)
    order = np.argsort(code, kind="stable")
    along = points[order]
    distances = np.full((n, 2 * WINDOW), np.inf)
    for step in range(1, min(WINDOW, n - 1) + 1):
        gap = np.linalg.norm(along[step:] - along[:-step], axis=1)
        distances[step:, 2 * step - 2] = gap
        distances[:-step, 2 * step - 1] = gap
    nearest = np.sort(distances, axis=1)[:, : min(3, n - 1)]
    mean = np.where(np.isfinite(nearest), nearest, nearest[:, :1]).mean(axis=1)
    size = np.empty(n)
    size[order] = 0.5 * mean.clip(
        1e-6 * extent, LARGEST_SPACING * max(np.median(mean), 1e-6 * extent)
    )
    return size


def _refusal(path: Path, expected: str, got: str) -> IoError:
    return IoError(message(_NAME, f"{path}", expected, got))

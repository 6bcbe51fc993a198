"""Gaussians in .ply files, as the original 3D Gaussian splatting code writes them [Kerbl2023].

One vertex a Gaussian, float32 properties, before any activation: x y z, scale_0..2 (logarithms),
rot_0..3 (w x y z), opacity (logit), f_dc_0..2 and f_rest_0.. (spherical harmonics; f_rest runs
through all coefficients of red, then of green, then of blue). Positions and quaternions stay in the
frame of the file, which is usually that of a structure-from-motion program, y down; comments in
files that `photograd fit` writes say so (`gaussian_header`).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write
from plyfile import PlyData, PlyElement

from photograd._ply import read_ply
from photograd.errors import IoError, message
from photograd.splats.header import UNSTATED, Presentation
from photograd.splats.splatting import Gaussians
from photograd.types import Array

REQUIRED = {
    "means": ("x", "y", "z"),
    "log_scales": ("scale_0", "scale_1", "scale_2"),
    "quats": ("rot_0", "rot_1", "rot_2", "rot_3"),
    "opacity_logits": ("opacity",),
    "f_dc": ("f_dc_0", "f_dc_1", "f_dc_2"),
}
REST_COUNTS = {0: 1, 9: 4, 24: 9, 45: 16}  # number of f_rest properties: coefficients a channel


def read_gaussian_ply(path: Path) -> Gaussians:
    """Read Gaussians, raw, in float32; other properties (normals) are left out.

    Raises:
        IoError: no file, a damaged one, one of points or of another layout, or a value that is no
            number (infinite opacities are, and mean opaque or absent).
    """
    vertex = _vertices(Path(path))
    names = set(vertex.dtype.names or ())
    missing = [name for group in REQUIRED.values() for name in group if name not in names]
    if missing:
        remedy = "a file of points or a mesh holds none; 'photograd trace' draws meshes"
        found = f"no {', '.join(missing[:3])}" + (" ..." if len(missing) > 3 else "")
        raise _refusal(path, "the properties of 3D Gaussians", found, remedy)
    rest = sum(name.startswith("f_rest_") for name in names)
    if rest not in REST_COUNTS or not {f"f_rest_{i}" for i in range(rest)} <= names:
        raise _refusal(path, "f_rest_0 .. of 0, 9, 24 or 45 properties", f"{rest}")
    columns = {group: _columns(path, vertex, properties) for group, properties in REQUIRED.items()}
    dc, n, k = columns.pop("f_dc"), len(vertex), REST_COUNTS[rest]
    coefficients = np.empty((n, k, 3), np.float32)
    coefficients[:, 0] = dc
    if k > 1:
        higher = _columns(path, vertex, tuple(f"f_rest_{i}" for i in range(rest)))
        coefficients[:, 1:] = higher.reshape(n, 3, k - 1).transpose(0, 2, 1)
    columns["opacity_logits"] = columns["opacity_logits"][:, 0]
    return Gaussians(**columns, sh=coefficients)


def write_gaussian_ply(
    path: Path, gaussians: Gaussians, presentation: Presentation = UNSTATED
) -> None:
    """Write Gaussians in binary little-endian float32, whole or not at all.

    Reading the file gives the same float32 numbers. Normals, which some writers add, are left out.
    `presentation` goes into comments of the header.

    Raises:
        IoError: the file cannot be written.
    """
    n, k = gaussians.sh.shape[:2]
    rest = gaussians.sh[:, 1:].transpose(0, 2, 1).reshape(n, 3 * (k - 1))
    columns: list[tuple[str, Array]] = []
    for group, names in REQUIRED.items():
        raw = gaussians.sh[:, 0] if group == "f_dc" else getattr(gaussians, group)
        array = raw.reshape(n, len(names))
        columns += [(name, array[:, i]) for i, name in enumerate(names)]
    columns += [(f"f_rest_{i}", rest[:, i]) for i in range(rest.shape[1])]
    vertex = np.empty(n, [(name, "<f4") for name, _ in columns])
    for name, column in columns:
        vertex[name] = column
    vertices = PlyElement.describe(vertex, "vertex")
    data = PlyData([vertices], byte_order="<", comments=presentation.comments())
    atomic_write(Path(path), data.write)


def _vertices(path: Path) -> Array:
    elements = read_ply("read_gaussian_ply", path)
    if "vertex" not in elements:
        raise _refusal(path, "an element 'vertex'", "none")
    return elements["vertex"]


def _columns(path: Path, vertex: Array, names: tuple[str, ...]) -> Array:
    """(N, len(names)) float32; NaN, and infinity where it means nothing, refused by row."""
    out = np.empty((len(vertex), len(names)), np.float32)
    for i, name in enumerate(names):
        if vertex.dtype[name].kind not in "fiu":
            raise _refusal(path, f"numbers in {name}", "lists")
        with np.errstate(over="ignore", invalid="ignore"):
            out[:, i] = vertex[name]
        bad = np.isnan(out[:, i])
        if name != "opacity":
            bad |= np.isinf(out[:, i])
        if bad.any():
            row = int(np.flatnonzero(bad)[0])
            raise _refusal(path, f"finite numbers in {name}", f"{out[row, i]} in row {row}")
    return out


def _refusal(path: Path, expected: str, got: str, remedy: str | None = None) -> IoError:
    return IoError(message("read_gaussian_ply", f"{path}", expected, got, remedy))

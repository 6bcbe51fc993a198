"""Gaussians in .ply files: of the original 3D Gaussian splatting code, and compressed ones.

One vertex a Gaussian, float32 properties, before any activation: x y z, scale_0..2 (logarithms),
rot_0..3 (w x y z), opacity (logit), f_dc_0..2 and f_rest_0.. (spherical harmonics; f_rest runs
through all coefficients of red, then of green, then of blue). Positions and quaternions stay in the
frame of the file, which is usually that of a structure-from-motion program, y down; comments in
files that `photograd fit` writes say so (`frames`).

Compressed files are those of PlayCanvas, four 32-bit words a Gaussian. Chunks of 256 hold the
limits between which their positions, scales (logarithms) and, in newer files, colors lie.

    packed_position, packed_scale   11, 10 and 11 bits from the limits' lower to upper
    packed_color                    8 bits each of red, green, blue, opacity; without limits 0 to 1
    packed_rotation                 2 bits: which of w, x, y, z is largest; 10 bits each of the
                                    others, from -sqrt(1/2) to sqrt(1/2)
    element sh, f_rest_0 ..         8 bits each, in the order of other .ply files, from -4 to 4 in
                                    steps of 1/32: the middle of a step, but for 0 and 255

The frame is that of the .ply file that it was made from.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd._ply import Table, ply_bytes, read_ply
from photograd.errors import IoError, message
from photograd.sh import Y_0
from photograd.splats.coding import logit_of, require_room, unit_quats
from photograd.splats.frames import UNSTATED, Presentation
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

    Args:
        path: of the file.

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

    Args:
        path: of the file.
        gaussians: to be written.
        presentation: how they are shown.

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
    atomic_write(Path(path), ply_bytes("vertex", vertex, presentation.comments()))


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


# Gaussians in compressed .ply files, as PlayCanvas writes them: four 32-bit words each.


_COMPRESSED_READER = "read_compressed_ply"
CHUNK = 256
_LIMITS = [f"{end}_{axis}" for end in ("min", "max") for axis in "xyz"]
_SCALES = [f"{end}_scale_{axis}" for end in ("min", "max") for axis in "xyz"]
_COLORS = [f"{end}_{channel}" for end in ("min", "max") for channel in "rgb"]
_WORDS = ["packed_position", "packed_rotation", "packed_scale", "packed_color"]
_OTHERS = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])


def is_compressed(head: bytes) -> bool:
    """Whether a .ply file that begins so has the properties of this format.

    Args:
        head: the first bytes of the file.
    """
    return _WORDS[0].encode() in head.partition(b"end_header")[0]


def read_compressed_ply(path: Path, *, memory_limit: int | None = None) -> Gaussians:
    """Read Gaussians in float32. Opacities of 0 and 255 have infinite logits.

    Args:
        path: of the file.
        memory_limit: bytes that may be taken; None takes what there is.

    Raises:
        IoError: no file, a damaged one, another layout, more than memory holds, or limits that are
            no numbers.
    """
    elements = read_ply(_COMPRESSED_READER, path)
    if "chunk" not in elements or not _has(elements.get("vertex"), _WORDS):
        found = {name: list(table.dtype.names or ())[:3] for name, table in elements.items()}
        expected = "elements 'chunk' and 'vertex' with packed_position ..."
        raise _compressed_refusal(path, expected, f"{found}")
    chunk, vertex = elements["chunk"], elements["vertex"]
    n = len(vertex)
    rest = _harmonics(path, elements.get("sh"), n)
    require_room(_COMPRESSED_READER, path, n, rest.shape[1] + 1, memory_limit)
    if any(vertex.dtype[name] != np.uint32 for name in _WORDS):
        raise _compressed_refusal(path, "words of 32 bits (uint)", f"{vertex.dtype}")
    if len(chunk) != -(-n // CHUNK):
        raise _compressed_refusal(path, f"{-(-n // CHUNK)} chunks for {n} Gaussians", len(chunk))
    rows = np.arange(n) // CHUNK
    means = _between(_limits(path, chunk, _LIMITS), rows, _11_10_11(vertex["packed_position"]))
    scales = _between(_limits(path, chunk, _SCALES), rows, _11_10_11(vertex["packed_scale"]))
    rgba = (vertex["packed_color"][:, None] >> np.array([24, 16, 8, 0], np.uint32) & 255) / 255.0
    rgb = rgba[:, :3]
    if _has(chunk, _COLORS):
        rgb = _between(_limits(path, chunk, _COLORS), rows, rgb)
    harmonics = np.concatenate([((rgb - 0.5) / Y_0)[:, None], rest], axis=1)
    return Gaussians(
        means=means.astype(np.float32),
        log_scales=scales.astype(np.float32),
        quats=_quats(vertex["packed_rotation"]).astype(np.float32),
        opacity_logits=logit_of(rgba[:, 3]).astype(np.float32),
        sh=harmonics.astype(np.float32),
    )


def _has(table: Table | None, names: list[str]) -> bool:
    return table is not None and set(names) <= set(table.dtype.names or ())


def _limits(path: Path, chunk: Table, names: list[str]) -> Array:
    """(chunks, 2, 3) lower and upper."""
    if not _has(chunk, names) or any(chunk.dtype[name].kind != "f" for name in names):
        raise _compressed_refusal(
            path, f"numbers {names[0]} to {names[-1]} in each chunk", f"{chunk.dtype}"
        )
    limits = np.stack([chunk[name].astype(np.float64) for name in names], axis=1).reshape(-1, 2, 3)
    bad = ~(np.abs(limits) < 1e18).all(axis=(1, 2))
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        raise _compressed_refusal(path, "finite limits", f"{limits[row].tolist()} in chunk {row}")
    return limits


def _between(limits: Array, rows: Array, shares: Array) -> Array:
    low, high = limits[rows, 0], limits[rows, 1]
    return np.asarray(low * (1.0 - shares) + high * shares)


def _11_10_11(word: Array) -> Array:
    """(N, 3) shares of 1."""
    fields = [(word >> 21) / 2047.0, (word >> 11 & 1023) / 1023.0, (word & 2047) / 2047.0]
    return np.stack(fields, axis=1)


def _quats(word: Array) -> Array:
    """(N, 4) unit quaternions w x y z."""
    fields = word[:, None] >> np.array([20, 10, 0], np.uint32) & 1023
    small = (fields / 1023.0 - 0.5) * np.sqrt(2.0)
    largest, rows = (word >> 30).astype(np.intp), np.arange(len(word))
    quats = np.empty((len(word), 4))
    quats[rows[:, None], _OTHERS[largest]] = small
    quats[rows, largest] = np.sqrt((1.0 - np.square(small).sum(axis=1)).clip(min=0.0))
    return unit_quats(quats)


def _harmonics(path: Path, table: Table | None, n: int) -> Array:
    """(N, K - 1, 3) coefficients above degree 0; none without the element."""
    if table is None:
        return np.empty((n, 0, 3))
    names = [f"f_rest_{i}" for i in range(len(table.dtype.names or ()))]
    k = REST_COUNTS.get(len(names), 0)
    if k < 2 or not _has(table, names) or any(table.dtype[name] != np.uint8 for name in names):
        raise _compressed_refusal(path, "f_rest_0 .. of 9, 24 or 45 bytes", f"{table.dtype}")
    if len(table) != n:
        raise _compressed_refusal(path, f"harmonics of {n} Gaussians", f"{len(table)}")
    levels = np.stack([table[name] for name in names], axis=1).astype(np.float64)
    shares = np.where(levels == 255, 1.0, np.where(levels == 0, 0.0, (levels + 0.5) / 256.0))
    return np.asarray((8.0 * shares - 4.0).reshape(n, 3, k - 1).transpose(0, 2, 1))


def _compressed_refusal(path: Path, expected: str, got: object) -> IoError:
    return IoError(message(_COMPRESSED_READER, f"{path}", expected, f"{got}"))

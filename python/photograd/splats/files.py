"""One door to files of Gaussians: which format a file has, and its reader and writer.

A format is known by how a file begins, and where it has no mark, by the end of its name.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from photograd_course.input_files import read_file

from photograd._ply import MAX_HEADER_BYTES
from photograd._typed import typed_call
from photograd.errors import IoError, RangeError, message
from photograd.splats.coding import Coding, Codings
from photograd.splats.frames import UNSTATED, Presentation, read_presentation
from photograd.splats.gltf_files import GLTF, gltf_codings, stored_gaussians, write_gaussian_gltf
from photograd.splats.ply_files import (
    is_compressed,
    read_compressed_ply,
    read_gaussian_ply,
    write_gaussian_ply,
)
from photograd.splats.sog_files import (
    decode_sog,
    encode_sog,
    sog_codings,
    sorted_gaussians,
    write_gaussian_sog,
)
from photograd.splats.splat_files import (
    is_point_npz,
    read_gaussian_splat,
    read_point_npz,
    splat_codings,
    write_gaussian_splat,
)
from photograd.splats.splatting import Gaussians
from photograd.splats.spz_files import read_gaussian_spz, spz_codings, write_gaussian_spz
from photograd.splats.spz_streams import GZIP, MAGIC

SUFFIXES = (".ply", ".splat", ".spz", ".npz")
WRITABLE = (".ply", ".splat", ".spz", ".sog", *GLTF)
_READ, _WRITE = "read_gaussians", "write_gaussians"
_EXACT = ("means", "log_scales", "rotation", "opacity", "color", "harmonics")


@typed_call
@dataclass(frozen=True, eq=False)
class GaussianFile:
    """What a file held.

    Attributes:
        gaussians: float32, in the frame of .ply files, whichever the format's is: -y is up unless
            `presentation` names another axis.
        format: name of the format.
        conversions: what was converted or left aside, one sentence each, for the log.
        presentation: what the file says of up, background and antialiasing.
    """

    gaussians: Gaussians
    format: str
    conversions: tuple[str, ...] = ()
    presentation: Presentation = UNSTATED


@typed_call
def read_gaussians(path: Path, *, memory_limit: int | None = None) -> GaussianFile:
    """Read Gaussians of any format.

    Args:
        path: .ply (of 3D Gaussian splatting, or compressed by PlayCanvas), .splat, .spz (versions 2
            to 4), or .npz (colored points of gsplat).
        memory_limit: bytes that reading may take; what is available by default. It is compared with
            what the file states before its values are read.

    Raises:
        IoError: no file, one of no such format, a damaged one, one that needs more memory, values
            that are no numbers.
    """
    head = read_file(_READ, path, MAX_HEADER_BYTES)
    start = head[:4]
    if start[:3] == b"ply":
        return _read_ply(path, head, memory_limit)
    if start[:3] == GZIP or start == MAGIC:
        gaussians, lines, presentation = read_gaussian_spz(path, memory_limit=memory_limit)
        return GaussianFile(gaussians, "spz", (*lines, *_misnamed(path, ".spz")), presentation)
    if start == b"PK\x03\x04":
        gaussians, lines = read_point_npz(path, memory_limit=memory_limit)
        return GaussianFile(gaussians, "points", (*lines, *_misnamed(path, ".npz")))
    if path.suffix.lower() == ".splat":
        found = read_gaussian_splat(path, memory_limit=memory_limit)
        return GaussianFile(found, "splat", ("scales and opacities stored after activation",))
    expected = f"a file of Gaussians: {', '.join(SUFFIXES)}"
    got = f"one that begins with {start!r}" if start else "an empty one"
    raise IoError(message(_READ, f"{path}", expected, got))


@typed_call
def write_gaussians(
    path: Path, gaussians: Gaussians, *, spz_version: int = 3, presentation: Presentation = UNSTATED
) -> None:
    """Write Gaussians in the format that the name's end says, whole or not at all.

    Args:
        path: .ply, .splat, .spz, .sog, .glb or .gltf.
        gaussians: with -y up, but for a .ply file whose `presentation` says otherwise.
        spz_version: of an .spz file.
        presentation: kept as far as the format has a place: all of it in a .ply file, antialiasing
            in an .spz or .sog file.

    Raises:
        IoError: another end of the name, or the file cannot be written.
        RangeError: values that are no numbers, or another version than 2, 3 or 4.
    """
    suffix = path.suffix.lower()
    if suffix not in WRITABLE:
        expected = f"a name that ends in one of {', '.join(WRITABLE)}"
        raise IoError(message(_WRITE, f"{path}", expected, repr(path.name)))
    for name, array in gaussians.arrays().items():
        # Infinite logits mean opaque and absent, a logarithm of -inf no extent.
        bad = np.isnan(array) if name == "opacity_logits" else ~np.isfinite(array)
        if name == "log_scales":
            bad = np.isnan(array) | (array == np.inf)
        if bad.any():
            row = int(np.argwhere(bad)[0, 0])
            raise RangeError(message(_WRITE, name, "numbers", f"none in row {row}"))
    writers: dict[str, Callable[[], None]] = {
        ".ply": lambda: write_gaussian_ply(path, gaussians, presentation),
        ".splat": lambda: write_gaussian_splat(path, gaussians),
        ".spz": lambda: write_gaussian_spz(
            path, gaussians, version=spz_version, antialiased=presentation.antialiased is True
        ),
        ".sog": lambda: write_gaussian_sog(
            path, gaussians, antialiased=presentation.antialiased is True
        ),
    }
    writers |= dict.fromkeys(GLTF, lambda: write_gaussian_gltf(path, gaussians))
    writers[suffix]()


def codings_of(path: Path, gaussians: Gaussians, *, spz_version: int = 3) -> Codings:
    """What the format that `write_gaussians` would choose keeps of these Gaussians.

    Args:
        path: its suffix names the format.
        gaussians: to be written.
        spz_version: of .spz files.
    """
    if path.suffix.lower() == ".splat":
        return splat_codings(gaussians)
    if path.suffix.lower() == ".spz":
        return spz_codings(gaussians, spz_version)
    if path.suffix.lower() == ".sog":
        return sog_codings(gaussians)
    if path.suffix.lower() in GLTF:
        return gltf_codings(gaussians)
    return {name: Coding(0.0) for name in _EXACT}


def reread(path: Path, gaussians: Gaussians) -> tuple[Gaussians, GaussianFile]:
    """What a file that was just written holds, beside what was written, row by row.

    Args:
        path: of the file.
        gaussians: that `write_gaussians` has been given.

    Returns:
        The Gaussians in the order of the file, and what it holds: read again or, of formats that
        are only written here, decoded from what went into the file.

    Raises:
        IoError: as for `read_gaussians`.
    """
    suffix = path.suffix.lower()
    if suffix == ".sog":
        ordered = sorted_gaussians(gaussians)
        line = "sorted along a Morton curve; not read back: photograd has no reader of .sog files"
        return ordered, GaussianFile(decode_sog(*encode_sog(ordered)), "sog", (line,))
    if suffix in GLTF:
        line = "+y up, as glTF has it; not read back: photograd draws no Gaussians of glTF files"
        return gaussians, GaussianFile(stored_gaussians(gaussians), "gltf", (line,))
    return gaussians, read_gaussians(path)


def holds_gaussians(path: Path) -> bool:
    """Whether a name is one of a file of Gaussians; an archive of a fit is none.

    Args:
        path: of a file; its name decides, and the content of a .npz archive.
    """
    suffix = path.suffix.lower()
    return is_point_npz(path) if suffix == ".npz" else suffix in SUFFIXES


def is_gaussian_ply(path: Path) -> bool:
    """Whether a .ply file holds Gaussians, as its header says; a mesh may have the same suffix.

    Args:
        path: of a file.

    Raises:
        IoError: no file.
    """
    head = read_file(_READ, path, MAX_HEADER_BYTES).partition(b"end_header")[0]
    return is_compressed(head) or b" f_dc_0" in head


def _read_ply(path: Path, head: bytes, memory_limit: int | None) -> GaussianFile:
    presentation = read_presentation(_READ, path, head)
    said = tuple(f"the file says: {line}" for line in presentation.sentences())
    if is_compressed(head):
        found = read_compressed_ply(path, memory_limit=memory_limit)
        lines = ("four words each, between limits of 256", *said)
        return GaussianFile(found, "compressed ply", lines, presentation)
    return GaussianFile(read_gaussian_ply(path), "ply", said, presentation)


def _misnamed(path: Path, suffix: str) -> tuple[str, ...]:
    if path.suffix.lower() == suffix:
        return ()
    return (f"read as {suffix}, as its content says, in spite of its name",)

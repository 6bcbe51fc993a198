"""Files that others wrote, read with suspicion: paths stay in their folder, arrays are bounded.

A file from elsewhere may name any path, for example ../../etc/passwd; what lies outside of its
folder is not its to read. Symbolic links are followed: the text of a file cannot make one.

An archive may be compressed a thousandfold, so each array's header is compared with the length that
the archive states, and the sum of all with the limits; only then is an array read. Pickled objects
are never read.
"""

from __future__ import annotations

import math
import zipfile
from collections.abc import Collection
from pathlib import Path

import numpy as np
from photograd_course.input_files import require_file
from photograd_course.limits import EXPANSION

from photograd._memory import available_memory, bytes_text
from photograd.errors import DtypeError, IoError, message
from photograd.types import Array, FloatArray

TRUST = "if you trust the capture: --allow-outside, in Python allow_outside=True"


def leads_outside(name: str) -> bool:
    """Whether a name leads out of the folder that it is relative to: by a root, a drive or ".."."""
    path = Path(name)
    return bool(path.anchor) or ".." in path.parts


def inside(
    function: str,
    where: str,
    folder: Path,
    name: str,
    *,
    allow_outside: bool = False,
    portable: bool = False,
    remedy: str | None = None,
) -> Path:
    """The path of what `name` says, relative to `folder`.

    Args:
        function, where: on whose behalf the error speaks, and where the name stands.
        folder: where the file that says so lies.
        name: as it stands in that file.
        allow_outside: also a name that leads out of the folder.
        portable: refuse a colon, too: in names that are the same on all systems it ends a drive
            or the scheme of a URI.
        remedy: what the error advises.

    Raises:
        IoError: the name leads out of the folder, or is empty.
    """
    refused = not name or leads_outside(name) or (portable and ":" in name)
    if refused and not allow_outside:
        shown = name if len(name) <= 80 else f"{name[:77]}..."
        raise IoError(message(function, where, f"a file in {folder}", repr(shown), remedy))
    return folder / name


# NumPy files read with suspicion: never pickled objects, never more than the file holds.


def read_npy(function: str, path: Path) -> FloatArray:
    """A real array of any shape as float64.

    Raises:
        IoError: missing, not an .npy file, damaged, or shorter than its header promises.
        DtypeError: neither floats nor integers.
    """
    size = require_file(function, path)
    try:
        with path.open("rb") as stream:
            version = np.lib.format.read_magic(stream)
            read = {
                (1, 0): np.lib.format.read_array_header_1_0,
                (2, 0): np.lib.format.read_array_header_2_0,
            }.get(version)
            if read is None:
                raise ValueError(f"format version {version}")
            shape, _, dtype = read(stream)
            wanted = stream.tell() + math.prod(shape) * dtype.itemsize
        if dtype.kind not in "fiu":
            raise DtypeError(message(function, path.name, "floats or integers", dtype))
        if wanted != size:
            expected = f"{wanted} bytes, as its header says"
            raise IoError(message(function, path.name, expected, size))
        return np.asarray(np.load(path, allow_pickle=False), dtype=np.float64)
    except (IoError, DtypeError):
        raise
    except Exception as error:  # the header is a Python literal: any of a dozen exceptions
        text = " ".join(str(error).split())[:120]
        raise IoError(message(function, str(path), "a readable .npy file", text)) from error


# Archives of NumPy arrays, read with suspicion: sizes are known before memory is asked for.


_SUFFIX = ".npy"


def read_npz(
    function: str,
    path: Path,
    names: Collection[str] | None = None,
    *,
    memory_limit: int | None = None,
    expected: str = "a readable .npz file",
    remedy: str | None = None,
) -> dict[str, Array]:
    """The arrays of an .npz file by name.

    Args:
        function: reader on whose behalf errors speak.
        path: the file.
        names: of the arrays to read, all of which must be there; None for all.
        memory_limit: bytes that the arrays may take; what is available by default.
        expected, remedy: of the error for a file that is no whole archive.

    Raises:
        IoError: no regular file, no archive, a damaged one, pickled objects, no array of a name, or
            more bytes than `memory_limit` or `PHOTOGRAD_MAX_EXPANSION` allow.
    """
    size = require_file(function, path)
    try:
        with zipfile.ZipFile(path) as archive:
            found = {
                entry.filename.removesuffix(_SUFFIX): entry
                for entry in archive.infolist()
                if entry.filename.endswith(_SUFFIX)
            }
            missing = [] if names is None else sorted(set(names) - set(found))
            if missing:
                raise ValueError(f"no {', '.join(missing)}")
            wanted = {name: found[name] for name in (found if names is None else names)}
            for entry in wanted.values():
                _check_header(archive, entry)
            stated = sum(entry.file_size for entry in wanted.values())
            _check_size(function, path, stated, size, memory_limit)
            return {name: _read(archive, entry) for name, entry in wanted.items()}
    except IoError:
        raise
    except Exception as failure:  # damaged archives and headers raise a dozen kinds
        text = " ".join(str(failure).split())[:120] or type(failure).__name__
        raise IoError(message(function, f"{path}", expected, text, remedy)) from failure


def _check_header(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> None:
    """Raise ValueError unless an array is as long as its own header says, and holds no objects."""
    with archive.open(entry) as stream:
        version = np.lib.format.read_magic(stream)
        if version != (1, 0):  # later ones are for headers of more than 64 kB
            raise ValueError(f"{entry.filename[:40]}: format version {version}")
        shape, _, dtype = np.lib.format.read_array_header_1_0(stream)
        start = stream.tell()
    if dtype.hasobject or start + math.prod(shape) * dtype.itemsize != entry.file_size:
        got = f"{dtype} of shape {shape} in {entry.file_size} bytes"
        raise ValueError(f"{entry.filename[:40]}: {got}")


def _check_size(function: str, path: Path, stated: int, size: int, limit: int | None) -> None:
    """Raise IoError for arrays that do not fit, or for too small a file that unpacks to them."""
    room = available_memory() if limit is None else limit
    if stated > room:
        expected = f"arrays that fit into {bytes_text(room)}"
        raise IoError(message(function, f"{path}", expected, bytes_text(stated)))
    if stated - size > EXPANSION.value():
        got = f"{stated - size:,}"
        raise IoError(message(function, f"{path}", EXPANSION.expected(), got, EXPANSION.remedy()))


def _read(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> Array:
    with archive.open(entry) as stream:
        array: Array = np.lib.format.read_array(stream, allow_pickle=False)
        return array

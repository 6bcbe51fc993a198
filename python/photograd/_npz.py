"""Archives of NumPy arrays, read with suspicion: sizes are known before memory is asked for.

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
from photograd.errors import IoError, message
from photograd.types import Array

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

"""NumPy files read with suspicion: never pickled objects, never more than the file holds."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from photograd_course.input_files import require_file

from photograd.errors import DtypeError, IoError, message
from photograd.types import FloatArray


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

"""The one door to .ply files: elements by name, as arrays with named columns.

Counts are believed only as far as the file is long, so that a damaged header cannot ask for memory.
"""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.input_files import read_file
from plyfile import PlyData

from photograd.errors import IoError, message

Table = NDArray[Any]
MAX_HEADER_BYTES = 1 << 16
_COUNT = re.compile(rb"^\s*element\s+(\S+)\s+(\d+)\s*$", re.MULTILINE)


def read_ply(function: str, path: Path) -> dict[str, Table]:
    """{element: structured array (rows,)} of a .ply file, text or binary, read whole.

    Args:
        function: reader on whose behalf errors speak.
        path: the file.

    Raises:
        IoError: no file, a damaged one, or a header that promises more than the file holds.
    """
    header = read_file(function, path, MAX_HEADER_BYTES).partition(b"end_header")[0]
    size = path.stat().st_size
    for name, digits in _COUNT.findall(header):
        # The shortest row there is takes a byte.
        if len(digits) > 18 or int(digits) > size:
            expected = "a readable .ply file"
            got = f"{digits[:24].decode()} rows of {name[:24]!r} promised in {size} bytes"
            raise IoError(message(function, f"{path}", expected, got))
    try:
        if b"binary_" not in header:
            # Text: from memory, since the parser leaves a second handle of a file open.
            return _arrays(PlyData.read(io.BytesIO(read_file(function, path)), mmap=False))
        with path.open("rb") as stream:
            # Mapped, or the parser would go row by row; copied, so that the map is closed.
            return _arrays(PlyData.read(stream, mmap="c"))
    except Exception as failure:  # the parser raises a dozen kinds for damaged headers
        text = " ".join(str(failure).split())[:120] or type(failure).__name__
        raise IoError(message(function, f"{path}", "a readable .ply file", text)) from failure


def _arrays(data: PlyData) -> dict[str, Table]:
    return {element.name: np.array(element.data) for element in data.elements}

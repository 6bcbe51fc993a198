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
from plyfile import PlyData

from photograd.errors import IoError, message

Table = NDArray[Any]
LONGEST_HEADER = 1 << 20
_COUNT = re.compile(rb"^\s*element\s+(\S+)\s+(\d+)\s*$", re.MULTILINE)


def read_ply(function: str, path: Path) -> dict[str, Table]:
    """{element: structured array (rows,)} of a .ply file, text or binary, read whole.

    Args:
        function: reader on whose behalf errors speak.
        path: the file.

    Raises:
        IoError: no file, a damaged one, or a header that promises more than the file holds.
    """
    try:
        found = path.is_file()
        content = path.read_bytes() if found else b""
    except (OSError, ValueError) as failure:
        raise IoError(message(function, f"{path}", "a readable file", failure)) from failure
    if not found:
        raise IoError(message(function, f"{path}", "a file", "none"))
    header = content[:LONGEST_HEADER].partition(b"end_header")[0]
    for name, digits in _COUNT.findall(header):
        # The shortest row there is takes a byte.
        if len(digits) > 18 or int(digits) > len(content):
            expected = "a readable .ply file"
            got = f"{digits[:24].decode()} rows of {name[:24]!r} promised in {len(content)} bytes"
            raise IoError(message(function, f"{path}", expected, got))
    try:
        # From memory: of a file, the parser leaves a second handle open.
        data = PlyData.read(io.BytesIO(content), mmap=False)
        return {element.name: np.asarray(element.data) for element in data.elements}
    except Exception as failure:  # the parser raises a dozen kinds for damaged headers
        text = " ".join(str(failure).split())[:120] or type(failure).__name__
        raise IoError(message(function, f"{path}", "a readable .ply file", text)) from failure

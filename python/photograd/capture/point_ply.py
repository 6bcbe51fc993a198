"""Coloured points in .ply files: what structure from motion hands to whoever starts from it.

One vertex a point: x y z, and red green blue as 8-bit numbers if the file has colours. Everything
else in the file is left out.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from photograd._ply import read_ply
from photograd.capture.frames import LARGEST_COORDINATE
from photograd.errors import IoError, message
from photograd.types import FloatArray

_NAME = "read_point_ply"
_POSITION, _COLOR = ("x", "y", "z"), ("red", "green", "blue")


def read_point_ply(path: Path) -> tuple[FloatArray, npt.NDArray[np.uint8] | None]:
    """Positions (N, 3) in the frame of the file and 8-bit display colours (N, 3), or None.

    Raises:
        IoError: no file, a damaged one, or positions or colours that are none.
    """
    elements = read_ply(_NAME, path)
    if "vertex" not in elements:
        raise IoError(message(_NAME, f"{path}", "an element 'vertex'", sorted(elements)))
    vertex = elements["vertex"]
    names = set(vertex.dtype.names or ())
    wanted = _POSITION + (_COLOR if names.issuperset(_COLOR) else ())
    bad = [name for name in wanted if name not in names or vertex.dtype[name].kind not in "fiu"]
    if bad:
        got = f"none in {', '.join(bad)}"
        raise IoError(message(_NAME, f"{path}", "numbers x, y and z for each point", got))
    positions = np.stack([vertex[name].astype(np.float64) for name in _POSITION], axis=1)
    outside = ~(np.abs(positions) <= LARGEST_COORDINATE).all(axis=1)
    if outside.any():
        row = int(np.flatnonzero(outside)[0])
        got = f"{positions[row].tolist()} in row {row}"
        raise IoError(message(_NAME, f"{path}", "finite positions up to 1e9", got))
    if wanted == _POSITION:
        return positions, None
    if any(vertex.dtype[name] != np.uint8 for name in _COLOR):
        got = ", ".join(str(vertex.dtype[name]) for name in _COLOR)
        raise IoError(message(_NAME, f"{path}", "colours as 8-bit numbers (uchar)", got))
    return positions, np.stack([vertex[name] for name in _COLOR], axis=1)

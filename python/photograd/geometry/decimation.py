"""Fewer triangles: edges are collapsed in the order of the errors that they make [Garland1997]."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._extras import import_extra
from photograd.errors import RangeError, message
from photograd.types import Array, FloatArray


def decimate(
    vertices: Array, faces: Array, triangles: int
) -> tuple[FloatArray, npt.NDArray[np.uint32]]:
    """A mesh of about the same shape; fast_simplification does the work.

    Args:
        vertices: (V, 3), meters.
        faces: (F, 3) vertex numbers.
        triangles: how many may be left, from 4 to F - 1. Fewer are where no edge can be collapsed
            otherwise.

    Returns:
        Vertices (v, 3) float64, meters, and faces (f, 3) with f at most `triangles`.

    Raises:
        DtypeError, ShapeError, RangeError: arrays or numbers that are no such thing; nothing left
            of the mesh, or more than was asked for.
        IoError: the library is not installed; the extra is `simplify`.
    """
    call = Arguments("decimate", np.float64)
    vertices = call.array("vertices", vertices, ("V", 3), min_length=1)
    high = len(vertices) - 1
    faces = call.array("faces", faces, ("F", 3), dtype=np.uint32, low=0, high=high, min_length=5)
    call.integer("triangles", triangles, low=4, high=len(faces) - 1)
    library = import_extra("decimate", "fast_simplification", "simplify")
    points, corners = library.simplify(vertices, faces.astype(np.int32), target_count=triangles)
    if not 0 < len(corners) <= triangles:
        expected, got = f"1 to {triangles} triangles that are left", len(corners)
        raise RangeError(message("decimate", "triangles", expected, got, "choose another number"))
    return np.asarray(points, np.float64), np.asarray(corners).astype(np.uint32)

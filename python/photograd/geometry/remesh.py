"""Triangles as equal as possible on the same surface; gpytoolbox does the work [Botsch2004]."""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._extras import import_extra
from photograd.errors import RangeError, message
from photograd.types import Array, FloatArray

ROUNDS = 10
"""Of splitting, collapsing and flipping edges, and moving vertices along the surface."""
MOST = 2_000_000
"""Triangles that a length may ask for: the library has no limit of its own."""


def remesh(
    vertices: Array, faces: Array, length: float
) -> tuple[FloatArray, npt.NDArray[np.uint32]]:
    """A mesh of the same surface, about, whose edges are about equally long.

    Args:
        vertices: (V, 3), meters.
        faces: (F, 3) vertex numbers of a manifold mesh.
        length: of an edge, meters.

    Returns:
        Vertices (v, 3) float64, meters, and faces (f, 3).

    Raises:
        DtypeError, ShapeError, RangeError: arrays or numbers that are no such thing; a length that
            asks for more than `MOST` triangles.
        IoError: the library is not installed; the extra is `remesh`.
    """
    call = Arguments("remesh", np.float64)
    vertices = call.array("vertices", vertices, ("V", 3), min_length=1)
    high = len(vertices) - 1
    faces = call.array("faces", faces, ("F", 3), dtype=np.uint32, low=0, high=high, min_length=1)
    length = call.number("length", length, above=0)
    count = surface_area(vertices, faces) / (np.sqrt(3) / 4 * length * length)
    if count > MOST:
        expected = f"a length that makes at most {MOST:,} triangles"
        got = f"{length:g} m, which makes {count:.2g}"
        raise RangeError(message("remesh", "length", expected, got))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of SciPy, by its import
        library = import_extra("remesh", "gpytoolbox", "remesh")
    points, corners = library.remesh_botsch(vertices, faces.astype(np.int32), ROUNDS, length, True)
    return np.asarray(points, np.float64), np.asarray(corners).astype(np.uint32)


def surface_area(vertices: FloatArray, faces: Array) -> float:
    """Square meters.

    Args:
        vertices: (V, 3), meters.
        faces: (F, 3) vertex numbers.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    square = np.square(np.cross(b - a, c - a)).sum(axis=1)
    return float(np.sqrt(square).sum()) / 2

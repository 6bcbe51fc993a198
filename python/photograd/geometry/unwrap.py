"""Texture coordinates of a mesh; xatlas cuts it into charts and packs them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._extras import import_extra
from photograd.types import Array, FloatArray

Numbers = npt.NDArray[np.uint32]
PADDING = 2
"""Texels between charts."""


def unwrap(vertices: Array, faces: Array, size: int) -> tuple[FloatArray, Numbers, Numbers]:
    """Cut a mesh into charts that lie side by side in a texture.

    Args:
        vertices: (V, 3), meters.
        faces: (F, 3) vertex numbers.
        size: texels along an edge of the texture, which keeps charts apart.

    Returns:
        Texture coordinates uv (T, 2) in [0, 1], faces (F, 3) as numbers of these, and the vertex
        (T,) that has them.

    Raises:
        DtypeError, ShapeError, RangeError: arrays or numbers that are no such thing.
        IoError: the library is not installed; the extra is `simplify`.
    """
    call = Arguments("unwrap", np.float64)
    vertices = call.array("vertices", vertices, ("V", 3), min_length=1)
    high = len(vertices) - 1
    faces = call.array("faces", faces, ("F", 3), dtype=np.uint32, low=0, high=high, min_length=1)
    call.integer("size", size, low=8, high=16384)
    library = import_extra("unwrap", "xatlas", "simplify")
    # float32 of meters far from the origin would merge vertices.
    center = (vertices.max(axis=0) + vertices.min(axis=0)) / 2
    scale = max(float(np.ptp(vertices, axis=0).max()), 1e-30)
    atlas, options = library.Atlas(), library.PackOptions()
    options.padding, options.resolution, options.bilinear = PADDING, size, True
    atlas.add_mesh(((vertices - center) / scale).astype(np.float32), faces)
    atlas.generate(library.ChartOptions(), options, False)
    vertex, corners, uv = atlas[0]
    clipped = np.clip(np.asarray(uv, np.float64), 0.0, 1.0)
    return clipped, np.asarray(corners, np.uint32), np.asarray(vertex, np.uint32)

"""Colors of vertices as a texture, for renderers that know textures alone.

Each face gets a square of two by two texels of its own. Its corners are three of the texels'
centers, and the fourth texel continues the plane through their colors: there a bilinear lookup is
the linear interpolation over the face, to the rounding of its coordinates.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from photograd.errors import ShapeError, message

Floats = npt.NDArray[np.float32]


def vertex_color_texture(faces: npt.NDArray[np.uint32], colors: Floats) -> tuple[Floats, Floats]:
    """Texture coordinates of each face's corners, and the texture.

    Args:
        faces: (F, 3) numbers of vertices.
        colors: (V, 3) of the vertices.

    Returns:
        uv (3 F, 2), v downwards, of the corners face by face, which share no vertex any more; and
        texels (H, W, 3). Those that continue a plane may lie outside of the colors' range.

    Raises:
        ShapeError: colors that are not (V, 3).
    """
    if colors.ndim != 2 or colors.shape[1] != 3:
        raise ShapeError(message("vertex_color_texture", "colors", "shape (V, 3)", colors.shape))
    number = np.arange(len(faces))
    columns = int(np.ceil(np.sqrt(len(faces))))
    rows = -(-len(faces) // columns)
    row, column = 2 * (number // columns), 2 * (number % columns)
    a, b, c = (colors[faces[:, corner]] for corner in range(3))
    texels = np.zeros((2 * rows, 2 * columns, 3), np.float32)
    texels[row, column], texels[row, column + 1] = a, b
    texels[row + 1, column], texels[row + 1, column + 1] = c, b + c - a
    corners = np.stack([column, row], axis=1)[:, None] + np.array([[0, 0], [1, 0], [0, 1]])
    uv = (corners + 0.5) / np.array([2 * columns, 2 * rows])
    return uv.reshape(-1, 2).astype(np.float32), texels

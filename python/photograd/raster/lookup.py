"""Which face is seen at any point of the image, between the centers of pixels as well."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.raster.visibility import mesh_arrays
from photograd.types import Array, FloatArray


@typed_call
class FaceLookup:
    """Triangles of one view, listed by tiles of the image: asks for points cost microseconds."""

    def __init__(
        self, positions: FloatArray, faces: Array, size: tuple[int, int], *, near: float = 1e-3
    ) -> None:
        """List the triangles.

        Args:
            positions: (V, 3) vertices in homogeneous pixels, of `project`.
            faces: (F, 3) vertex numbers.
            size: (height, width) of the picture in pixels.
            near: meters; nothing nearer is seen.

        Raises:
            DtypeError, ShapeError, RangeError: arrays of other types or shapes, or numbers that are
                out of range.
        """
        call = Arguments("FaceLookup", np.float64)
        positions, faces = mesh_arrays(call, positions, faces)
        self._near = call.number("near", near, above=0)
        height, width = size
        self._core = call.run(_core.PreparedTriangles, positions, faces, height, width, near)

    def nearest(
        self, points: FloatArray, *, far: float = np.inf
    ) -> tuple[npt.NDArray[np.int32], FloatArray]:
        """Numbers (N,) of the nearest faces at points (N, 2) in pixels, and their depths (N,).

        The number is -1 and the depth infinite where nothing is seen, as outside of the picture.

        Args:
            points: (N, 2) in pixels.
            far: meters; nothing farther is seen.

        Raises:
            DtypeError, ShapeError, RangeError: points that are not finite numbers (N, 2).
        """
        call = Arguments("FaceLookup.nearest", np.float64)
        points = call.array("points", points, ("N", 2))
        face, depth = call.run(self._core.nearest, points, self._near, float(far))
        return face, depth

    def count(self, points: FloatArray, depth: FloatArray) -> npt.NDArray[np.int32]:
        """Numbers (N,) of the faces at points (N, 2) in pixels that are no farther than `depth`.

        Args:
            points: (N, 2) in pixels; outside of the picture there is no face.
            depth: (N,) meters.

        Raises:
            DtypeError, ShapeError, RangeError: points or depths that are not finite numbers of
                these shapes.
        """
        call = Arguments("FaceLookup.count", np.float64)
        points = call.array("points", points, ("N", 2))
        depth = call.array("depth", depth, (len(points),))
        found: npt.NDArray[np.int32] = call.run(self._core.count, points, depth, self._near)
        return found

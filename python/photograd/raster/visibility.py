"""The visibility buffer: which triangle each pixel sees, and where on it; with its adjoint.

Formulas: cpp/photograd/raster/triangle.h. The rasterizer samples the centers of pixels, so the
derivative of `rasterize_backward` holds inside of faces; where a silhouette moves, `antialias` or
edge sampling has the rest. [Olano1997; Burns2013]
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import ShapeError, message
from photograd.raster.options import COMPARES, CULLS, RasterOptions, Stencil
from photograd.types import Array, FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class Visibility:
    """What each pixel sees.

    Attributes:
        face: (H, W) int32, the number of a triangle, -1 where nothing is seen.
        barycentrics: (H, W, 2) float64, perspective-correct weights of its second and third corner;
            0 where nothing is seen.
        depth: (H, W) float64, meters along the camera's axis; infinite where nothing is seen.
        stencil: (H, W) uint8, or None where there is no stencil buffer.
        overdraw: (H, W) int32, how many fragments lay between near and far before any other test.
    """

    face: npt.NDArray[np.int32]
    barycentrics: FloatArray
    depth: FloatArray
    stencil: npt.NDArray[np.uint8] | None
    overdraw: npt.NDArray[np.int32]

    @classmethod
    def cleared(cls, height: int, width: int, *, stencil: int | None = None) -> Visibility:
        """Buffers of a picture that sees nothing yet.

        Args:
            height, width: in pixels, up to 2^28 of them.
            stencil: the value of a stencil buffer everywhere, 0 to 255; None makes none.

        Raises:
            DtypeError, RangeError: sizes or a value that are out of range.
        """
        call = Arguments("Visibility.cleared")
        call.integer("height", height, low=1, high=2**28)
        call.integer("width", width, low=1, high=2**28 // height)
        bits = None
        if stencil is not None:
            value = call.integer("stencil", stencil, low=0, high=255)
            bits = np.full((height, width), value, np.uint8)
        return cls(
            np.full((height, width), -1, np.int32),
            np.zeros((height, width, 2)),
            np.full((height, width), np.inf),
            bits,
            np.zeros((height, width), np.int32),
        )

    @property
    def covered(self) -> npt.NDArray[np.bool_]:
        """(H, W) whether anything is seen."""
        return self.face >= 0


@typed_call
def rasterize(
    positions: FloatArray,
    faces: Array,
    size: tuple[int, int],
    options: RasterOptions | None = None,
    *,
    onto: Visibility | None = None,
    first_face: int = 0,
    behind: FloatArray | None = None,
    face_mask: Array | None = None,
) -> Visibility:
    """Draw triangles: which of them the center of each pixel sees.

    Of two triangles that share an edge, a center on it sees exactly one: the left or the top edge
    belongs to a triangle. Triangles are drawn in the order of their numbers; of equal depths, the
    first stays. A triangle may reach behind the camera. The same bits on any number of threads.

    Args:
        positions: (V, 3) vertices in homogeneous pixels, of `project`.
        faces: (F, 3) vertex numbers. A triangle seen from its edge, or without area, is not drawn.
        size: (height, width) of the picture in pixels.
        options: the tests of a fragment; None takes the defaults.
        onto: buffers to go on with, which are copied; None starts with cleared ones.
        first_face: is added to the numbers of the faces, for a second mesh in the same buffers.
        behind: (H, W) depths in meters; only what lies further away is drawn. With the depths of
            one layer it finds the next: depth peeling [Everitt2001]. None draws all.
        face_mask: (F,) bool, which of the faces are drawn; None draws all.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes, positions that are not
            finite, numbers that name no vertex, `onto` of another size or without a stencil buffer
            that the options need.
    """
    options = options or RasterOptions()
    call = Arguments("rasterize", np.float64)
    positions, faces = mesh_arrays(call, positions, faces)
    needs_stencil = options.stencil is not None
    if behind is not None:
        behind = call.array("behind", behind, tuple(size), finite=False)
    if face_mask is not None:
        face_mask = call.array("face_mask", face_mask, (len(faces),), dtype=np.bool_)
    if onto is None:
        out = Visibility.cleared(*size, stencil=0 if needs_stencil else None)
    else:
        out = _copied(onto, size, needs_stencil)
    call.run(
        _core.rasterize,
        positions,
        faces,
        options.near,
        options.far,
        CULLS.index(options.cull),
        COMPARES.index(options.depth_test),
        options.depth_write,
        (options.stencil or Stencil()).numbers(),
        first_face,
        out.face,
        out.barycentrics,
        out.depth,
        out.stencil if needs_stencil else None,
        out.overdraw,
        behind,
        face_mask,
    )
    return out


@typed_call
def rasterize_backward(
    positions: FloatArray,
    faces: Array,
    visibility: Visibility,
    d_barycentrics: FloatArray | None = None,
    d_depth: FloatArray | None = None,
) -> FloatArray:
    """dL/dpositions (V, 3) float64, through barycentrics and depth; faces that are seen are held.

    Args:
        positions, faces: as for `rasterize`; faces with `first_face` 0.
        visibility: what it returned.
        d_barycentrics: (H, W, 2), None for zero.
        d_depth: (H, W), None for zero. Both are read where a face is seen.

    Raises:
        DtypeError, ShapeError, RangeError: as for `rasterize`.
    """
    call = Arguments("rasterize_backward", np.float64)
    positions, faces = mesh_arrays(call, positions, faces)
    height, width = visibility.face.shape
    if d_barycentrics is None:
        d_barycentrics = np.zeros((height, width, 2))
    if d_depth is None:
        d_depth = np.zeros((height, width))
    d_barycentrics = call.array("d_barycentrics", d_barycentrics, (height, width, 2))
    d_depth = call.array("d_depth", d_depth, (height, width))
    d_positions = np.zeros_like(positions)
    call.run(
        _core.rasterize_backward,
        positions,
        faces,
        visibility.face,
        d_barycentrics,
        d_depth,
        d_positions,
    )
    return d_positions


def mesh_arrays(call: Arguments, positions: Array, faces: Array) -> tuple[FloatArray, Array]:
    """`positions` (V, 3) float64 and `faces` (F, 3) uint32, as the arguments of a `call`."""
    positions = call.array("positions", positions, ("V", 3))
    return positions, call.array("faces", faces, ("F", 3), dtype=np.uint32)


def _copied(onto: Visibility, size: tuple[int, int], needs_stencil: bool) -> Visibility:
    if onto.face.shape != tuple(size):
        raise ShapeError(message("rasterize", "onto", f"buffers of {size}", onto.face.shape))
    if needs_stencil and onto.stencil is None:
        remedy = "start with Visibility.cleared(height, width, stencil=0)"
        raise ShapeError(message("rasterize", "onto", "a stencil buffer", "none", remedy))
    stencil = None if onto.stencil is None else onto.stencil.copy()
    return replace(
        onto,
        face=onto.face.copy(),
        barycentrics=onto.barycentrics.copy(),
        depth=onto.depth.copy(),
        stencil=stencil,
        overdraw=onto.overdraw.copy(),
    )

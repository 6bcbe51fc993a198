"""Attributes of vertices where pixels see them, perspective-correct; with the adjoint.

Formulas: cpp/photograd/raster/interpolate.h.
"""

from __future__ import annotations

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.raster.visibility import Visibility
from photograd.types import Array, FloatArray


@typed_call
def interpolate(attributes: Array, faces: Array, visibility: Visibility) -> FloatArray:
    """Blend the attributes of a triangle's corners by the barycentrics of each pixel.

    Args:
        attributes: (V, C), any numbers of a vertex: colors, texture coordinates, normals.
        faces: (F, 3) that were rasterized.
        visibility: by `rasterize`.

    Returns:
        (H, W, C) float64, zero where nothing is seen.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes, numbers that name no
            vertex.
    """
    call = Arguments("interpolate", np.float64)
    attributes = call.array("attributes", attributes, ("V", "C"), finite=False)
    faces = call.array("faces", faces, ("F", 3), dtype=np.uint32)
    out = np.zeros((*visibility.face.shape, attributes.shape[1]))
    rows = out.reshape(-1, attributes.shape[1])
    call.run(_core.interpolate, attributes, faces, *_rows(visibility), rows)
    return out


@typed_call
def interpolate_backward(
    attributes: Array, faces: Array, visibility: Visibility, d_out: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The adjoint of `interpolate`.

    Args:
        attributes, faces, visibility: as for `interpolate`.
        d_out: (H, W, C) dL/d of what it returned.

    Returns:
        dL/dattributes (V, C), every pixel's share added in one order whatever the number of
        threads, and dL/dbarycentrics (H, W, 2), for `rasterize_backward`.

    Raises:
        DtypeError, ShapeError, RangeError: as for `interpolate`.
    """
    call = Arguments("interpolate_backward", np.float64)
    attributes = call.array("attributes", attributes, ("V", "C"), finite=False)
    faces = call.array("faces", faces, ("F", 3), dtype=np.uint32)
    channels = attributes.shape[1]
    d_out = call.array("d_out", d_out, (*visibility.face.shape, channels), finite=False)
    d_attributes, d_barycentrics = np.zeros_like(attributes), np.zeros_like(visibility.barycentrics)
    call.run(
        _core.interpolate_backward,
        attributes,
        faces,
        *_rows(visibility),
        d_out.reshape(-1, channels),
        d_attributes,
        d_barycentrics.reshape(-1, 2),
    )
    return d_attributes, d_barycentrics


def _rows(visibility: Visibility) -> tuple[Array, Array]:
    return visibility.face.reshape(-1), visibility.barycentrics.reshape(-1, 2)

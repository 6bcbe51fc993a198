"""A little of everything that the rasterizer asks of the core."""

from __future__ import annotations

import numpy as np
from photograd.raster import (
    FaceLookup,
    MeshEdges,
    RasterOptions,
    Stencil,
    interpolate,
    interpolate_backward,
    rasterize,
    rasterize_backward,
)

from support.frame_workload import frames
from support.network_workload import networks


def rasters() -> None:
    positions = np.array([[0.5, 0.5, 1], [5.0, 1, 1], [2.0, 12, 2], [7.0, -2, -1]])
    faces, size = np.array([[0, 1, 2], [1, 2, 3]]), (5, 6)
    for options in (RasterOptions(), RasterOptions(stencil=Stencil(on_pass="increment_clamp"))):
        visibility = rasterize(positions, faces, size, options)
    values = interpolate(positions, faces, visibility)
    _, d_barycentrics = interpolate_backward(positions, faces, visibility, values)
    rasterize_backward(positions, faces, visibility, d_barycentrics)
    MeshEdges.of(faces).silhouettes(positions)
    FaceLookup(positions, faces, size).nearest(np.array([[1.5, 1.5], [-1.0, 3.0]]))


LATER = (networks, rasters, frames)

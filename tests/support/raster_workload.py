"""A little of everything that the rasterizer and vector drawings ask of the core."""

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
from photograd.vector import Drawing, Rendering, Shape, Stroke, Subpath

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


def drawings() -> None:
    path = Subpath(np.array([[1.0, 1], [4, -2], [3, 4], [0, 2]]), (2, 1))
    rendering = Rendering(Drawing.of([Shape((path,)), Shape((path,), stroke=Stroke(1.0))]), (4, 5))
    rendering.backward(np.ones((4, 5, 4)))
    rendering.coverage_backward(1, rendering.coverage(1))


LATER = (networks, rasters, frames, drawings)

"""A differentiable rasterizer: triangles to pictures, and gradients through their edges.

    positions = project(mesh.vertices, camera)              # homogeneous pixels
    visibility = rasterize(positions, mesh.faces, (height, width))  # the visibility buffer
    color = interpolate(vertex_colors, mesh.faces, visibility)
    crossings = find_crossings(positions, mesh.faces, visibility, MeshEdges.of(mesh.faces))
    picture = antialias(color, crossings)

Each has a `_backward`. `rasterize_backward` holds inside of faces, `antialias_backward` adds the
silhouettes [Laine2020], and `edge_gradient` gives those without bias [Li2018]. `polygon_coverage`
is exact; `soft_silhouette` [Liu2019] is biased, and is here to be compared. All calculate in
float64 and give the same bits on any number of threads.
"""

from __future__ import annotations

from photograd.raster.antialiasing import (
    Crossings,
    antialias,
    antialias_backward,
    find_crossings,
    layered_crossings,
)
from photograd.raster.attributes import interpolate, interpolate_backward
from photograd.raster.coverage import polygon_coverage, polygon_coverage_backward
from photograd.raster.edge_sampling import (
    EdgeSamples,
    edge_gradient,
    edge_motion_backward,
    sample_edges,
)
from photograd.raster.edges import MeshEdges
from photograd.raster.footprint import footprints, footprints_backward
from photograd.raster.lookup import FaceLookup
from photograd.raster.options import RasterOptions, Stencil
from photograd.raster.projection import ProjectionGradients, project, project_backward
from photograd.raster.soft import soft_silhouette, soft_silhouette_backward
from photograd.raster.visibility import Visibility, rasterize, rasterize_backward

__all__ = [
    "Crossings",
    "EdgeSamples",
    "FaceLookup",
    "MeshEdges",
    "ProjectionGradients",
    "RasterOptions",
    "Stencil",
    "Visibility",
    "antialias",
    "antialias_backward",
    "edge_gradient",
    "edge_motion_backward",
    "find_crossings",
    "footprints",
    "footprints_backward",
    "interpolate",
    "interpolate_backward",
    "layered_crossings",
    "polygon_coverage",
    "polygon_coverage_backward",
    "project",
    "project_backward",
    "rasterize",
    "rasterize_backward",
    "sample_edges",
    "soft_silhouette",
    "soft_silhouette_backward",
]

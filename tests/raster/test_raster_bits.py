"""Registers buffers, pictures and gradients for the test of bits."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.raster import (
    FaceLookup,
    MeshEdges,
    antialias,
    antialias_backward,
    edge_gradient,
    find_crossings,
    interpolate,
    interpolate_backward,
    project,
    project_backward,
    rasterize,
    rasterize_backward,
    sample_edges,
)

from support.bits import same_bits
from tests.raster import oracle


@same_bits("rasterizer", kernels=("draw_span",))
def everything() -> list[Any]:
    """A sphere of several pieces of faces and tiles; the last ones are not whole."""
    vertices, faces = oracle.sphere(90, 60)
    camera, size = oracle.camera(150, 133, 160.0), (133, 150)
    positions, edges = project(vertices, camera), MeshEdges.of(faces)
    visibility = rasterize(positions, faces, size)
    color = interpolate(vertices, faces, visibility)
    crossings = find_crossings(positions, faces, visibility, edges)
    picture = antialias(color, crossings)
    d = np.random.default_rng(1).uniform(-1, 1, picture.shape)
    d_color, d_edges = antialias_backward(color, crossings, d, positions, edges)
    d_attributes, d_b = interpolate_backward(vertices, faces, visibility, d_color)
    d_inside = rasterize_backward(positions, faces, visibility, d_b, d[..., 0])
    lookup = FaceLookup(positions, faces, size)
    samples = sample_edges(positions, edges, size)

    def shade(points: Any) -> Any:
        return np.repeat(lookup.nearest(points)[0][:, None] >= 0, 3, axis=1).astype(float)

    sampled = edge_gradient(positions, edges, samples, shade, d)
    found = project_backward(vertices, camera, d_inside + d_edges)
    buffers = [
        visibility.face,
        visibility.barycentrics,
        visibility.depth,
        visibility.overdraw,
        picture,
    ]
    return [*buffers, d_attributes, d_inside, d_edges, sampled, found.vertices, found.fx]

"""A mesh without colors, made visible: gray under a light from above, as colors of its vertices."""

from __future__ import annotations

import numpy as np
from photograd_course.portable_math import log

from photograd.fields.mesh_surface import MeshSurface
from photograd.geometry.normals import vertex_normals
from photograd.types import FloatArray

TOWARD_LIGHT = np.array([0.5, 0.7, 0.5])
DARKEST, BRIGHTEST = 0.12, 0.88  # display values


def lit(surface: MeshSurface) -> MeshSurface:
    """The mesh with what its vertices show under a distant light as their colors.

    The display value grows linearly with the cosine between normal and light, from -1 to 1: the
    side that is turned away is not all black.

    Args:
        surface: its own colors are dropped.
    """
    normals = vertex_normals(surface.vertices, surface.faces)
    length = np.sqrt(np.square(normals).sum(axis=1))
    toward = TOWARD_LIGHT / np.sqrt(np.square(TOWARD_LIGHT).sum())
    cosine = (normals * toward).sum(axis=1) / np.where(length > 0, length, 1.0)
    shown: FloatArray = DARKEST + (BRIGHTEST - DARKEST) * (1 + cosine) / 2
    logits = np.repeat((log(shown) - log(1 - shown))[:, None], 3, axis=1)
    params = surface.params
    logits = logits.astype(params["differential"].dtype)
    return MeshSurface(params["differential"], logits, surface.faces, surface.policy)

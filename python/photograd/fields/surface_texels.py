"""The texels of a mesh: from colors to raw numbers, to another size, from another mesh."""

from __future__ import annotations

import numpy as np
from photograd_course.color import srgb_encode
from photograd_course.portable_math import log

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.fields.bake import baked
from photograd.fields.layered_picture import Unwrapped
from photograd.fields.mesh_surface import MeshSurface
from photograd.fields.surface import without_seams
from photograd.fields.textured_mesh import TexturedMesh
from photograd.geometry.unwrap import unwrap
from photograd.representation import Fittable
from photograd.textures import sample
from photograd.types import FloatArray

START_OPACITY = 0.95
CLOSEST = 1e-3
"""To 0 and 1, where a fit starts: the sigmoid reaches neither."""


def raw_texels(rgba: FloatArray, start_opacity: float | None) -> FloatArray:
    """(H, W, 4) raw numbers of display colors and opacities, or (H, W, 3) of colors alone.

    Args:
        rgba: (H, W, 4) straight, in [0, 1].
        start_opacity: where an opaque texture starts, since the sigmoid reaches 1 nowhere; None
            leaves opacity out.
    """
    channels = 3
    if start_opacity is not None:
        channels = 4
        if is_opaque(rgba):
            held = np.full_like(rgba[..., 3:], start_opacity)
            rgba = np.concatenate([rgba[..., :3], held], axis=2)
    kept = np.clip(rgba[..., :channels], CLOSEST, 1 - CLOSEST)
    found: FloatArray = log(kept) - log(1 - kept)
    return found


def is_opaque(rgba: FloatArray) -> bool:
    """Whether no texel is transparent, but for rounding in a lookup.

    Args:
        rgba: (H, W, 4).
    """
    return bool((rgba[..., 3] >= 1 - 1e-9).all())


def resampled(rgba: FloatArray, size: int) -> FloatArray:
    """A texture (H, W, 4) at `size` x `size` texels.

    Args:
        rgba: the texture.
        size: texels along each edge of the new one.
    """
    if rgba.shape[:2] == (size, size):
        return rgba
    centers = (np.arange(size) + 0.5) / size
    uv = np.stack(np.meshgrid(centers, centers), axis=-1).reshape(-1, 2)
    return sample(rgba, uv).reshape(size, size, 4)


def parts_of(field: Fittable, size: int) -> tuple[FloatArray, Unwrapped, FloatArray]:
    """Vertices, faces in a texture, and the texture (H, W, 4), of another kind of mesh.

    Args:
        field: a mesh with a texture that was held, or one with vertex colors, which is unwrapped.
        size: texels along an edge of a texture that has to be made.

    Raises:
        RangeError: another kind of model.
        SceneError: a mesh that is not manifold.
        IoError: the library that unwraps is not installed.
    """
    if isinstance(field, TexturedMesh):
        assert field.mesh.uv is not None
        vertices, faces = without_seams(field.mesh)
        vertex = np.zeros(len(field.mesh.vertices), np.uint32)
        vertex[field.mesh.faces] = faces
        unwrapped = Unwrapped(field.mesh.uv.astype(np.float64), field.mesh.faces, vertex)
        color = srgb_encode(field.colors().astype(np.float64))
        opaque = np.ones((*color.shape[:2], 1))
        return vertices.astype(np.float64), unwrapped, np.concatenate([color, opaque], axis=2)
    if isinstance(field, MeshSurface):
        unwrapped = Unwrapped(*unwrap(field.vertices, field.faces, size))
        return field.vertices, unwrapped, baked(field.vertices, unwrapped, size, field)
    got = repr(field.name)
    raise RangeError(message("Fit.start", "start_from", "a model with a mesh", got))


def checked_unwrapped(function: str, unwrapped: Unwrapped, count: int) -> Unwrapped:
    """Faces in a texture, their arrays in the types that the rasterizer takes.

    Args:
        function: on whose behalf.
        unwrapped: the faces.
        count: number of vertices.

    Raises:
        DtypeError, ShapeError, RangeError: other arrays, numbers that name nothing, texture
            coordinates outside of [0, 1].
    """
    call = Arguments(function, np.float64)
    uv = call.array("uv", unwrapped.uv, ("T", 2), low=0, high=1, min_length=1)
    rows, high = len(uv), count - 1
    vertex = call.array("vertex", unwrapped.vertex, (rows,), dtype=np.uint32, low=0, high=high)
    corners = call.array(
        "corners", unwrapped.corners, ("F", 3), dtype=np.uint32, low=0, high=rows - 1, min_length=1
    )
    return Unwrapped(uv, corners, vertex)

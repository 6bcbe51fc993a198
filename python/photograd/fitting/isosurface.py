"""A mesh of what a fit has found: the surface of constant extinction, with baked colors.

Marching cubes are scikit-image's [Lorensen1987; Lewiner2003]. A field that says its extinction at
points is asked for it. Of others, such as Gaussians, the depths that cameras all around see are
fused into a truncated signed distance [Curless1996], whose zero is the surface.

A field has no surface of its own. That of extinction depends on the level; that of depths lies
where half of the light is stopped, and has no hollows that no camera sees.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.color import srgb_encode, unpremultiply

from photograd._arrays import Arguments
from photograd._checks import require_instance
from photograd._extras import import_extra
from photograd._memory import require_room
from photograd.capture.camera import Camera
from photograd.capture.orbit import spiral_cameras
from photograd.errors import RangeError, message
from photograd.fields.leaf_mlps import LeafMlps
from photograd.fields.neural_field import NeuralField
from photograd.fields.tabulate import radiance_of
from photograd.fields.voxel_field import VoxelField
from photograd.fitting.drawing import RAYS_AT_ONCE, draw_field, mean_depth, render_field
from photograd.fitting.model import Model
from photograd.representation import Fittable, RayBatch, RenderOptions
from photograd.types import Array, FloatArray

_NAME = "extract_mesh"
RESOLUTION = 128
HALVING = 0.02
"""Of the box's diagonal: extinction at the default level halves light over this length."""
CAMERAS = 48
"""All around, for fused depths."""
TRUNCATION = 3.0
"""Of signed distances, in voxels."""


@dataclass(frozen=True, eq=False)
class ColoredMesh:
    """Triangles with a color at each vertex, in the world of the field (+Y up, meters).

    Attributes:
        vertices: (V, 3) float32.
        faces: (F, 3) int64, counterclockwise seen from outside.
        normals: (V, 3) float32, unit length, outwards.
        colors: (V, 3) float32 display values in 0..1: what the field shows there, light included.
        level: of the surface: extinction in 1/m, or 0 of a signed distance.
    """

    vertices: Array
    faces: NDArray[np.int64]
    normals: Array
    colors: Array
    level: float


@dataclass(frozen=True, eq=False)
class _Lattice:
    """Values (X, Y, Z) at points of the box, padded by a layer outside of the surface."""

    values: Array
    first: FloatArray
    spacing: FloatArray


def extract_mesh(
    model: Model, *, resolution: int = RESOLUTION, level: float | None = None
) -> ColoredMesh:
    """The surface of a model as triangles, with the colors that it has seen straight on.

    A grid has the resolution of its voxels. Of Gaussians and other fields without an extinction at
    points, depths are fused and `level` means nothing; there a color is the mean of those that the
    cameras see.

    Args:
        model: as `fit` and `load_model` return it.
        resolution: points along the longest edge of the box, where the field is no grid; 8 to 1024.
        level: extinction in 1/m on the surface; by default one that halves light over 2 % of the
            diagonal of the box.

    Raises:
        RangeError: no surface at this level, or a lattice beyond memory.
        IoError: scikit-image is not installed (extra `mesh`).
        DtypeError: no model.

    Example:
        >>> model = photograd.fit("photos", resolution=16, steps=30, rays=256)
        >>> mesh = photograd.fitting.extract_mesh(model)
        >>> mesh.faces.shape[1], mesh.colors.shape == mesh.vertices.shape
        (3, True)
    """
    require_instance(_NAME, "model", model, Model, "load_model reads one, fit makes one")
    call = Arguments(_NAME)
    resolution = call.integer("resolution", resolution, low=8, high=1024)
    measure = import_extra(_NAME, "skimage.measure", "mesh")
    field = model.field
    if isinstance(field, LeafMlps):
        field = field.baked()
    lattice = _extinction(field, resolution)
    if lattice is None:
        if level is not None:
            expected = f"no level for {field.name}, whose depths are fused"
            raise RangeError(message(_NAME, "level", expected, level, "leave it out"))
        return _fused(model, resolution, measure)
    if level is None:
        diagonal = float(np.linalg.norm(field.box[1] - field.box[0]))
        level = float(np.log(2.0)) / (HALVING * diagonal)
    level = call.number("level", level, above=0)
    vertices, faces, normals = _marched(measure, lattice, level)
    colors = _straight_on(field, vertices, normals)
    return ColoredMesh(vertices, faces, normals, colors, level)


def _marched(
    measure: Any, lattice: _Lattice, level: float
) -> tuple[Array, NDArray[np.int64], Array]:
    """Vertices, faces and outward normals of the surface; values are higher inside."""
    low, high = float(lattice.values.min()), float(lattice.values.max())
    if not low < level < high:
        expected = f"a level between {low:.4g} and {high:.4g}, the values of the field"
        raise RangeError(message(_NAME, "level", expected, f"{level:.4g}", "choose another level"))
    vertices, faces, normals, _ = measure.marching_cubes(
        lattice.values,
        level,
        spacing=tuple(lattice.spacing.tolist()),
        gradient_direction="ascent",  # of the order of corners: counterclockwise from outside
    )
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(length > 0, normals / np.where(length > 0, length, 1), [0.0, 1.0, 0.0])
    placed = vertices.astype(np.float64) + lattice.first
    return placed.astype(np.float32), faces.astype(np.int64), normals.astype(np.float32)


def _padded(values: Array, first: FloatArray, spacing: FloatArray, outside: float) -> _Lattice:
    """With a layer of `outside` around it, so that surfaces are closed."""
    return _Lattice(np.pad(values, 1, constant_values=outside), first - spacing, spacing)


def _extinction(field: Fittable, resolution: int) -> _Lattice | None:
    """sigma_t on a lattice; None of a field that does not say it at points."""
    if isinstance(field, VoxelField):
        require_room(_NAME, "the lattice", 32 * int(np.prod(field.voxel_shape)))
        sigma_t, matrix = field.extinction()
        return _padded(sigma_t, matrix[:3, 3], np.diag(matrix)[:3].copy(), 0.0)
    if not isinstance(field, NeuralField):
        return None
    shape, first, spacing = _points_of(field.box, resolution)
    radiance = radiance_of(field, float(spacing.min()) / 8)
    values = np.empty(int(np.prod(shape)), np.float32)
    dtype = field.params["density"].dtype
    for start in range(0, len(values), RAYS_AT_ONCE):
        some = np.arange(start, min(start + RAYS_AT_ONCE, len(values)))
        points = first + np.stack(np.unravel_index(some, shape), axis=1) * spacing
        along = np.tile(np.array([0.0, 0.0, 1.0]), (len(some), 1))
        values[some] = radiance(points.astype(dtype), along.astype(dtype))[0]
    return _padded(values.reshape(shape), first, spacing, 0.0)


def _points_of(box: Array, resolution: int) -> tuple[tuple[int, int, int], FloatArray, FloatArray]:
    """Shape of a lattice of cubes over a box, its first point, and its spacing (3,)."""
    lower, upper = np.asarray(box, np.float64)
    edge = float((upper - lower).max()) / resolution
    x, y, z = np.maximum(np.ceil((upper - lower) / edge - 1e-6), 2).astype(int).tolist()
    require_room(_NAME, "the lattice", 64 * x * y * z)
    first = 0.5 * (lower + upper) - 0.5 * edge * (np.array([x, y, z]) - 1)
    return (x, y, z), first, np.full(3, edge)


def _straight_on(field: Fittable, vertices: Array, normals: Array) -> Array:
    """Display colors (V, 3) of rays that begin at the vertices and look against the normals."""
    colors = np.zeros((len(vertices), 3), np.float32)
    drawn: Any = field
    kind = next(iter(field.params.values())).dtype
    for start in range(0, len(vertices), RAYS_AT_ONCE):
        some = slice(start, start + RAYS_AT_ONCE)
        along = -normals[some].astype(np.float64)
        origins = vertices[some].astype(np.float64)
        pixel = np.arange(start, start + len(origins), dtype=np.uint32)
        batch = RayBatch(origins.astype(kind), along.astype(kind), pixel)
        outputs, _ = drawn.render(batch, seed=0, step=0, options=RenderOptions(stop=1e-4))
        straight = unpremultiply(
            outputs.color.astype(np.float64), outputs.opacity.astype(np.float64)
        )
        shown = srgb_encode(straight) if field.color_space == "linear" else straight
        colors[some] = np.clip(shown, 0.0, 1.0)
    return colors


# Depths fused, for what has no extinction at points.


def _fused(model: Model, resolution: int, measure: Any) -> ColoredMesh:
    """The zero of the truncated signed distance that cameras all around see [Curless1996]."""
    field = model.field
    shape, first, spacing = _points_of(field.box, resolution)
    edge = float(spacing[0])
    points = first + np.moveaxis(np.indices(shape), 0, -1).reshape(-1, 3) * spacing
    cameras = spiral_cameras(field.box, CAMERAS, size=2 * resolution)
    along_ray = "rays" in field.capabilities
    total, weight = np.zeros(len(points), np.float32), np.zeros(len(points), np.float32)
    empty = np.zeros(len(points), bool)
    for camera in cameras:
        _, opacity, depth = render_field(field, camera, 1e-4)
        surface = np.where(opacity >= 0.5, mean_depth(depth, opacity), np.inf)
        at, distance, inside = _looked_up(camera, points, along_ray=along_ray)
        signed = (distance - surface.ravel()[at]) / (
            TRUNCATION * edge
        )  # above 0 behind the surface
        free = inside & (signed < -1.0)
        near = inside & (np.abs(signed) <= 1.0)
        empty |= free & np.isinf(surface.ravel()[at])
        total[near] += signed[near].astype(np.float32)
        total[free] -= 1.0
        weight[near | free] += 1.0
    # What no camera has seen in front of a surface is inside; what one saw through is not.
    values = np.where(weight > 0, total / np.maximum(weight, 1.0), 1.0)
    values[empty] = np.minimum(values[empty], -1e-3)
    lattice = _padded(values.reshape(shape).astype(np.float32), first, spacing, -1.0)
    vertices, faces, normals = _marched(measure, lattice, 0.0)
    colors = _mean_colors(model, cameras, vertices, normals, edge, along_ray=along_ray)
    return ColoredMesh(vertices, faces, normals, colors, 0.0)


def _looked_up(
    camera: Camera, points: Array, *, along_ray: bool
) -> tuple[NDArray[np.int64], FloatArray, NDArray[np.bool_]]:
    """The pixel that shows each point, its distance as depths count it, and whether it is one."""
    pixels, axial = camera.project(points)
    edges = np.array([camera.width, camera.height])
    inside = np.asarray(((pixels >= 0) & (pixels < edges)).all(axis=1))  # NaN is neither
    column, row = np.where(inside[:, None], pixels, 0).astype(np.int64).T
    from_camera: FloatArray = np.linalg.norm(points - camera.position, axis=1)
    distance = from_camera if along_ray else axial
    return row * camera.width + column, distance, inside


def _mean_colors(
    model: Model,
    cameras: list[Camera],
    vertices: Array,
    normals: Array,
    edge: float,
    *,
    along_ray: bool,
) -> Array:
    """Display colors (V, 3): the mean over cameras that see a vertex, by the cosine."""
    total, weight = np.zeros((len(vertices), 3)), np.full((len(vertices), 1), 1e-9)
    points = vertices.astype(np.float64)
    for camera in cameras:
        picture = draw_field(model.field, model.background, camera)
        at, distance, inside = _looked_up(camera, points, along_ray=along_ray)
        toward = camera.position - points
        toward /= np.linalg.norm(toward, axis=1, keepdims=True)
        cosine = (toward * normals).sum(axis=1)
        off = np.abs(distance - picture.depth.ravel()[at])
        visible = inside & (cosine > 0.1) & (off <= TRUNCATION * edge)
        share = np.where(visible, cosine**2, 0.0)[:, None]
        total += share * picture.color.reshape(-1, 3)[at]
        weight += share
    mean = np.where(weight > 1e-6, total / weight, 0.5)
    return np.clip(mean, 0.0, 1.0).astype(np.float32)

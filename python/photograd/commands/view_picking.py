"""What a click on a picture of `photograd view` hits: a voxel, a Gaussian, a triangle, a place.

voxels      the sample of largest weight T alpha along the ray, and the voxel that it lies in
Gaussians   the first with a weight T alpha of at least a twentieth, else the heaviest
triangles   the nearest hit
all others  the mean distance along the ray
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from photograd_course.portable_math import exp, sigmoid, softplus

from photograd.capture.camera import Camera
from photograd.commands.view_gradients import box_interval
from photograd.commands.view_hits import (
    Pick,
    box_edges,
    closed,
    nearest_triangle,
    numbers,
    only_at,
    ray_through,
)
from photograd.fields.surface import SurfaceField
from photograd.fields.textured_mesh import TexturedMesh
from photograd.fields.voxel_field import GridField, VoxelField
from photograd.fitting.drawing import draw_field
from photograd.representation import Fittable
from photograd.splats.density import rotation_matrices
from photograd.splats.model import GaussianScene
from photograd.types import Array, FloatArray

if TYPE_CHECKING:
    from photograd.fitting.photograph_gradient import PhotographGradient

NOTICEABLE = 0.05
"""Weight of a Gaussian that is hit although heavier ones may lie behind it."""
FAINT = 1 / 255
"""A ray of less opacity hits nothing."""
ACTIVATIONS = {
    "identity": lambda raw: raw,
    "relu": lambda raw: np.maximum(raw, 0.0),
    "softplus": softplus,
    "exp": exp,
    "sigmoid": sigmoid,
}


def pick(
    field: Fittable,
    camera: Camera,
    at: tuple[float, float],
    background: Array | None,
    gradient: PhotographGradient | None,
) -> Pick | None:
    """What lies behind a point of a picture; None for nothing.

    Args:
        field: that the picture shows.
        camera: of the picture, in the frame of the field.
        at: (column, row) in pixels; the center of the first is (0.5, 0.5).
        background: linear (3,) behind it, or None for white.
        gradient: of the field, or None.
    """
    origin, direction = ray_through(camera, at)
    if isinstance(field, VoxelField):
        return pick_voxel(field, origin, direction, gradient)
    if isinstance(field, GaussianScene):
        return pick_gaussian(field, camera, at, gradient)
    if isinstance(field, SurfaceField | TexturedMesh):
        return pick_triangle(field, origin, direction, gradient)
    return pick_position(field, camera, at, background)


def weights_along(field: VoxelField, origin: Array, direction: Array) -> tuple[Array, Array]:
    """Weights T alpha (S,) of samples along a ray, and where they lie (S, 3).

    Raw densities of grids are interpolated between voxels; a leaf has one density.

    Args:
        field: of voxels or leaves.
        origin, direction: (3,), of length one.
    """
    box = np.asarray(field.box, np.float64)
    start, end = box_interval(origin[None], direction[None], box)
    voxel = (box[1] - box[0]) / field.voxel_shape
    dt = 0.25 * float(voxel.min()) if field.dt is None else field.dt
    count = max(int((end - start)[0] / dt + 0.5), 0)
    points = origin + (start[0] + dt * (np.arange(count)[:, None] + 0.5)) * direction
    tau = dt * densities(field, (points - box[0]) / voxel)
    alpha = 1 - exp(-tau)
    before = np.concatenate([[0.0], np.cumsum(tau)[:-1]]) if count else tau
    return exp(-before) * alpha, points


def densities(field: VoxelField, index: FloatArray) -> FloatArray:
    """sigma_t (S,) in 1/m at points in units of voxels, (S, 3); 0 is the corner of the box.

    Args:
        field: of voxels or leaves.
        index: (S, 3).
    """
    if not isinstance(field, GridField):
        values, _ = field.extinction()
        i, j, k = np.clip(index.astype(np.int64), 0, np.array(values.shape) - 1).T
        return np.asarray(values[i, j, k], np.float64)
    empty = getattr(field, "background_density", 0.0)
    raw = field.to_voxels(field.density_rows(field.params)).astype(np.float64)
    raw[~field.active_voxels] = empty
    zero = field.policy.border == "zero"  # beyond the box is nothing, else what is at its border
    raw = np.pad(raw, 1, constant_values=empty) if zero else np.pad(raw, 1, mode="edge")
    there = np.pad(field.active_voxels, 1, constant_values=not zero)
    at = np.clip(index + 0.5, 0, np.array(raw.shape) - 1)
    low = np.minimum(at.astype(np.int64), np.array(raw.shape) - 2)
    share, total, any_corner = at - low, np.zeros(len(at)), np.zeros(len(at), bool)
    for corner in np.ndindex(2, 2, 2):
        weight = np.where(corner, share, 1 - share).prod(axis=1)
        i, j, k = (low + corner).T
        total += weight * raw[i, j, k]
        any_corner |= there[i, j, k]
    policy = field.policy
    found = policy.density_scale * ACTIVATIONS[policy.density_activation](total)
    return np.where(any_corner, found, 0.0)


def pick_voxel(
    field: VoxelField, origin: Array, direction: Array, gradient: PhotographGradient | None
) -> Pick | None:
    """The voxel of the heaviest sample; None where the ray stays clear.

    Args:
        field: of voxels or leaves.
        origin, direction: (3,), of length one.
        gradient: of the field, or None.
    """
    weights, points = weights_along(field, origin, direction)
    if weights.sum() < FAINT:
        return None
    best = int(weights.argmax())
    voxel = (field.box[1] - field.box[0]) / field.voxel_shape
    top = np.array(field.voxel_shape) - 1
    i, j, k = np.clip(((points[best] - field.box[0]) / voxel).astype(np.int64), 0, top).tolist()
    rows = field.to_voxels(np.arange(1, 1 + len(field.density_rows(field.params))))
    row = int(rows[i, j, k]) - 1
    facts = {"weight": f"{weights[best]:.3f} of {weights.sum():.3f} along the ray"}
    facts["sigma_t"] = f"{densities(field, np.array([[i, j, k]]) + 0.5)[0]:.4g} 1/m"
    if row < 0:
        facts["row"] = "none: a neighbor's density reaches it"
    else:
        facts |= facts_of_row(field.params, row, len(field.density_rows(field.params)), (i, j, k))
    if gradient is not None and gradient.kind == "voxels":
        facts["dL/dsigma_t"] = f"{gradient.values[i, j, k]:.4g} m"
    low = field.box[0] + np.array([i, j, k]) * voxel
    return Pick(f"Voxel ({i}, {j}, {k})", facts, points[best], box_edges(low, low + voxel))


def facts_of_row(
    params: Mapping[str, Array], row: int, count: int, cell: tuple[int, int, int]
) -> dict[str, str]:
    """Parameters of a voxel: a row of each group of `count` rows, or of a dense array its cell.

    Args:
        params: groups.
        row: number of the row.
        count: how many rows there are.
        cell: (i, j, k) of a dense array.
    """
    found = {}
    for name, values in params.items():
        if values.ndim == 4:
            found[name] = numbers(values[cell])
        elif len(values) == count:
            found[name] = numbers(values[row])
    return found


def splat_weights(
    field: GaussianScene, camera: Camera, at: tuple[float, float]
) -> tuple[Array, Array]:
    """Weights T alpha (M,) of the Gaussians at a point of a picture from near to far; their rows.

    Args:
        field: Gaussians.
        camera: of the picture.
        at: (column, row) in pixels.
    """
    from photograd.fitting.view_gradients import screen_covariances

    policy, own = field.policy, field.gaussians
    pixel, depth = camera.project(own.means.astype(np.float64))
    rows = np.flatnonzero(depth > policy.near)
    spread = screen_covariances(own, camera)[rows]
    wide = spread + policy.low_pass * np.eye(2)
    size = np.linalg.det(wide)
    opacity = sigmoid(own.opacity_logits[rows].astype(np.float64))
    if policy.antialiased:
        opacity = opacity * np.sqrt(np.maximum(np.linalg.det(spread) / size, 0.0))
    off = np.asarray(at) - pixel[rows]
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = np.stack([wide[:, 1, 1], -wide[:, 0, 1], wide[:, 0, 0]], axis=1) / size[:, None]
        square = inverse[:, 0] * off[:, 0] ** 2 + inverse[:, 2] * off[:, 1] ** 2
        square += 2 * inverse[:, 1] * off[:, 0] * off[:, 1]
        alpha = np.minimum(opacity * np.exp(-0.5 * square), policy.alpha_max)
    kept = np.flatnonzero(alpha >= max(policy.alpha_min, 1e-12))
    kept = kept[np.argsort(depth[rows[kept]], kind="stable")]
    passed = np.concatenate([[1.0], np.cumprod(1 - alpha[kept])[:-1]]) if len(kept) else kept
    return passed * alpha[kept], rows[kept]


def pick_gaussian(
    field: GaussianScene,
    camera: Camera,
    at: tuple[float, float],
    gradient: PhotographGradient | None,
) -> Pick | None:
    """The first Gaussian of noticeable weight, else the heaviest; None where there is none.

    Args:
        field: Gaussians.
        camera: of the picture.
        at: (column, row) in pixels.
        gradient: of the field, or None.
    """
    weights, rows = splat_weights(field, camera, at)
    if not len(rows) or weights.sum() < FAINT:
        return None
    first = np.flatnonzero(weights >= NOTICEABLE)
    best = int(first[0]) if len(first) else int(weights.argmax())
    row, params = int(rows[best]), field.params
    facts = {"weight": f"{weights[best]:.3f} of {weights.sum():.3f} at this point"}
    facts["opacity"] = f"{float(sigmoid(params['opacity_logits'][row].astype(np.float64))):.4g}"
    scales = np.exp(params["log_scales"][row].astype(np.float64))
    facts["scales"] = f"{numbers(scales)} m"
    facts |= {name: numbers(params[name][row]) for name in ("quats", "sh_constant", "sh_rest")}
    if gradient is not None:
        groups = gradient.groups.items()
        facts |= {f"dL/d {name}": numbers(values[row]) for name, values in groups if values.size}
    mean = params["means"][row].astype(np.float64)
    axes = rotation_matrices(params["quats"][row : row + 1].astype(np.float64))[0] * (2 * scales)
    lines = np.stack([mean - axes.T, mean + axes.T], axis=1)
    return Pick(f"Gaussian {row}", facts, mean, lines)


def pick_triangle(
    field: SurfaceField | TexturedMesh,
    origin: Array,
    direction: Array,
    gradient: PhotographGradient | None,
) -> Pick | None:
    """The nearest triangle; None where the ray meets none.

    Args:
        field: a mesh.
        origin, direction: (3,), of length one.
        gradient: of the field, or None.
    """
    found = nearest_triangle([field.mesh], origin, direction)
    if found is None:
        return None
    face, weights, corners = found.face, found.weights, found.corners
    numbers_of = field.mesh.faces[face]
    facts = {"vertices": ", ".join(map(str, numbers_of.tolist()))}
    facts["barycentrics"] = numbers(weights)
    if isinstance(field, SurfaceField):
        color = field.colors_at(np.array([face]), weights[None])[0]
        facts["color, opacity"] = numbers(color)
    elif field.mesh.uv is not None:
        texels = field.params["texels"]
        u, v = weights @ field.mesh.uv[numbers_of]
        row = min(int(v * texels.shape[0]), texels.shape[0] - 1)
        column = min(int(u * texels.shape[1]), texels.shape[1] - 1)
        facts[f"texel ({row}, {column})"] = f"{numbers(sigmoid(texels[row, column]))}, linear"
    if gradient is not None and gradient.kind == "surface":
        for number in numbers_of.tolist():
            row_of = gradient.groups["vertices"][number]
            facts[f"dL/dx of vertex {number}"] = f"{numbers(row_of)} 1/m"
            facts[f"dL/dx . n of vertex {number}"] = f"{gradient.values[number]:.4g} 1/m"
    return Pick(f"Triangle {face}", facts, weights @ corners, closed(corners))


def pick_position(
    field: Fittable, camera: Camera, at: tuple[float, float], background: Array | None
) -> Pick | None:
    """The mean place along a ray of a field whose parameters lie nowhere in space.

    Args:
        field: a network, for example.
        camera: of the picture.
        at: (column, row) in pixels.
        background: linear (3,) behind it, or None for white.
    """
    single = only_at(camera, at)
    picture = draw_field(field, background, single)
    depth, opacity = float(picture.depth[0, 0]), float(picture.opacity[0, 0])
    if not np.isfinite(depth):
        return None
    origin, direction = ray_through(camera, at)
    along = depth if "rays" in field.capabilities else depth / float(direction @ camera.forward)
    position = origin + along * direction
    facts = {"distance": f"{along:.4g} m", "opacity": f"{opacity:.4g}"}
    facts["color"] = f"{numbers(picture.color[0, 0])}, display values"
    facts["parameters"] = ", ".join(f"{name} {p.shape}" for name, p in field.params.items())
    reach = 0.01 * float(np.linalg.norm(field.box[1] - field.box[0]))
    lines = np.stack([position - reach * np.eye(3), position + reach * np.eye(3)], axis=1)
    return Pick(f"A place of {field.name}", facts, position, lines)

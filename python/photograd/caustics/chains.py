"""Chains of specular surfaces: where light goes, and how its way moves with the surfaces.

A chain follows a ray from surface to surface, refracted by glass and reflected by mirrors, until
nothing specular is left in its way. The value is where the ray ends up: a point, a direction and a
factor of power. The adjoint is attached: it holds which triangle is hit and which lobe is chosen,
and moves all points, normals and directions behind a surface that moves [NimierDavid2019].

    forward    (o, d, f)_{k+1} = scatter(intersect((o, d)_k, surface_k))
    backward   (d_o, d_d, d_f)_k and dL/dsurface_k from (d_o, d_d, d_f)_{k+1}, last surface first

What it leaves out: a ray that comes to hit another triangle, or none. Where the direction behind a
surface is continuous across its edges, nothing is lost.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.caustics.intersections import (
    Point,
    dot,
    on_sphere,
    on_sphere_backward,
    on_triangle,
    on_triangle_backward,
    sphere_distances,
    unit,
)
from photograd.caustics.scattering import Scattered, fresnel, scatter, scatter_backward, sides
from photograd.caustics.surfaces import SpecularMesh, SpecularSphere, Surface, SurfaceGradient
from photograd.errors import RangeError, message
from photograd.geometry.mesh import Bvh, Mesh
from photograd.types import Array, FloatArray

OFFSET = 1e-5
"""Of the extent of all surfaces: rays that leave a surface do not meet it again within it."""
LEAST = 0.1
"""Probability of each lobe of glass, at least. At the rim of a sphere F goes to 1 with an infinite
slope, and the derivative of a refraction sampled with 1 - F would have an infinite variance."""
ENDED, TRAPPED, LEAKED = 0, 1, 2


@dataclass(frozen=True, eq=False)
class _Step:
    """Rays at one surface, as they arrive, and what was decided there."""

    rays: Array  # (N,) of the chain's
    surface: int
    origin: FloatArray
    direction: FloatArray
    primitive: Array  # (N,) triangle, or whether it is the farther point of a sphere
    reflected: Array
    pmf: FloatArray
    factor: FloatArray  # (N,) of power before the surface


@typed_call
@dataclass(eq=False)
class Chains:
    """Where R rays end up.

    Attributes:
        origin: (R, 3) last point on a surface, meters; the ray's own where none was hit.
        direction: (R, 3) unit, behind it.
        factor: (R,) what is left of the power, 0 of rays that are trapped or leaked.
        state: (R,) ENDED; TRAPPED by total reflection or `max_surfaces`; LEAKED where shading
            normals send it to the wrong side.
        count: (R,) surfaces on the way.
        first: (R,) number of the first surface, or -1.
    """

    origin: FloatArray
    direction: FloatArray
    factor: FloatArray
    state: Array
    count: Array
    first: Array
    steps: list[_Step] = field(default_factory=list, repr=False)


@typed_call
class SpecularScene:
    """Surfaces ready for `trace_chains`; the hierarchy over their triangles is built once."""

    def __init__(self, surfaces: Sequence[Surface]) -> None:
        """Build the hierarchy.

        Args:
            surfaces: meshes and spheres; none may be inside of another's glass.

        Raises:
            RangeError: no surface.
            SceneError: meshes that cannot be traced.
        """
        surfaces = list(surfaces)
        if not surfaces:
            got = "none"
            raise RangeError(message("SpecularScene", "surfaces", "at least one", got))
        self.surfaces = surfaces
        self._meshes = [i for i, s in enumerate(surfaces) if isinstance(s, SpecularMesh)]
        parts = [s for s in surfaces if isinstance(s, SpecularMesh)]
        corners = [part.vertices[part.faces].reshape(-1, 3) for part in parts]
        corners += [
            s.center + k * s.radius
            for s in surfaces
            if isinstance(s, SpecularSphere)
            for k in (-np.ones((1, 3)), np.ones((1, 3)))
        ]
        every = np.concatenate(corners)
        self.offset = OFFSET * float((every.max(axis=0) - every.min(axis=0)).max())
        flat = [Mesh(part.vertices.astype(np.float32), part.faces) for part in parts]
        self._bvh = Bvh(flat) if flat else None

    def nearest(self, o: FloatArray, d: FloatArray) -> tuple[Array, Array]:
        """Number of the nearest surface (R,), -1 for none; triangle, or 1 for a far point (R,).

        Args:
            o, d: (R, 3) rays.
        """
        best = np.full(len(o), np.inf)
        surface = np.full(len(o), -1)
        primitive = np.zeros(len(o), np.int64)
        if self._bvh is not None and len(o):
            hits = self._bvh.trace(o, d, self.offset)
            best = np.where(hits.hit, hits.t, np.inf)
            surface = np.where(hits.hit, np.array(self._meshes)[hits.instance], -1)
            primitive = np.where(hits.hit, hits.primitive, 0).astype(np.int64)
        for i, sphere in enumerate(self.surfaces):
            if not isinstance(sphere, SpecularSphere):
                continue
            near, far = sphere_distances(o, d, sphere.center, sphere.radius)
            t = np.where(near > self.offset, near, np.where(far > self.offset, far, np.inf))
            closer = t < best
            best = np.where(closer, t, best)
            surface = np.where(closer, i, surface)
            primitive = np.where(closer, (near <= self.offset).astype(np.int64), primitive)
        return surface, primitive


@typed_call
def trace_chains(
    scene: SpecularScene,
    origins: Array,
    directions: Array,
    u: Array | None = None,
    *,
    max_surfaces: int = 16,
) -> Chains:
    """Follow rays until nothing specular is in their way.

    Args:
        scene: the surfaces.
        origins: (R, 3) meters, outside of all glass.
        directions: (R, 3) of any length but zero, made unit.
        u: (R, K) numbers in [0, 1): surface k of a ray reflects where u[:, k] is below
            0.1 + 0.8 F, or 1 under total reflection, with `factor` divided by the probability;
            behind K surfaces a ray is trapped. None refracts at all glass.
        max_surfaces: longest chain, for `u` None.

    Raises:
        ShapeError, RangeError: rays of other shapes, or numbers that are not finite.
    """
    call = Arguments("trace_chains", np.float64)
    o = call.array("origins", origins, ("R", 3))
    d = unit(call.array("directions", directions, ("R", 3)))
    count = len(o)
    if u is not None:
        u = call.array("u", u, ("R", "K"), low=0.0, high=1.0)
    limit = max_surfaces if u is None else u.shape[1]
    chains = Chains(
        o.copy(),
        d,
        np.ones(count),
        np.zeros(count, np.int8),
        np.zeros(count, np.int64),
        np.full(count, -1),
    )
    rays = np.arange(count)
    for k in range(limit + 1):
        surface, primitive = scene.nearest(chains.origin[rays], chains.direction[rays])
        if k == 0:
            chains.first = surface
        rays, surface, primitive = (x[surface >= 0] for x in (rays, surface, primitive))
        if k == limit or not len(rays):
            chains.state[rays] = TRAPPED
            chains.factor[rays] = 0.0
            break
        for number in np.unique(surface):
            own = surface == number
            column = None if u is None else u[rays[own], k]
            _step(scene, chains, rays[own], int(number), primitive[own], column)
        rays = rays[chains.state[rays] == ENDED]
    return chains


def _step(
    scene: SpecularScene,
    chains: Chains,
    rays: Array,
    number: int,
    primitive: Array,
    u: FloatArray | None,
) -> None:
    """Let `rays` pass the surface of this number."""
    o, d, before = chains.origin[rays], chains.direction[rays], chains.factor[rays]
    surface = scene.surfaces[number]
    point = _intersect(surface, o, d, primitive)
    eta = surface.eta
    _, facing, c, e = sides(d, point.normal, 1.0 if eta is None else eta)
    F = np.ones(len(rays)) if eta is None else fresnel(e, c)
    p = np.where(F < 1.0, LEAST + (1.0 - 2.0 * LEAST) * F, 1.0)
    reflected = np.full(len(rays), eta is None) if u is None else u < p
    pmf = np.ones(len(rays)) if u is None else np.where(reflected, p, 1.0 - p)
    total = (F >= 1.0) & ~reflected
    out = scatter(d, point.normal, eta, reflected, pmf)
    flat = facing if isinstance(surface, SpecularSphere) else _flat_side(surface, primitive, d)
    wrong = (dot(out.direction, flat) > 0) != reflected
    state = np.where(total, TRAPPED, np.where(wrong, LEAKED, ENDED)).astype(np.int8)
    chains.state[rays] = state
    chains.factor[rays] = np.where(state == ENDED, before * out.factor, 0.0)
    chains.count[rays] += 1
    good = state == ENDED
    kept = rays[good]
    chains.origin[kept], chains.direction[kept] = point.position[good], out.direction[good]
    chains.steps.append(
        _Step(
            kept,
            number,
            o[good],
            d[good],
            primitive[good],
            reflected[good],
            pmf[good],
            before[good],
        )
    )


def _flat_side(mesh: SpecularMesh, primitive: Array, d: FloatArray) -> FloatArray:
    """(N, 3) normals of triangles, towards where rays come from; not unit."""
    corners = mesh.vertices[mesh.faces[primitive]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(np.where(dot(d, normal) < 0, 1.0, -1.0)[:, None] * normal)


def _intersect(surface: Surface, o: FloatArray, d: FloatArray, primitive: Array) -> Point:
    if isinstance(surface, SpecularSphere):
        return on_sphere(o, d, surface.center, surface.radius, primitive == 1)
    corners, normals = _triangles(surface, primitive)
    return on_triangle(o, d, corners, normals)


def _triangles(mesh: SpecularMesh, primitive: Array) -> tuple[FloatArray, FloatArray | None]:
    corner = mesh.faces[primitive]
    return mesh.vertices[corner], None if mesh.normals is None else mesh.normals[corner]


@typed_call
def trace_chains_backward(
    scene: SpecularScene, chains: Chains, d_origin: Array, d_direction: Array, d_factor: Array
) -> list[SurfaceGradient]:
    """dL/d of each surface, the adjoint of `trace_chains` with triangles and lobes held.

    Rays that did not end, and those that met nothing, say nothing.

    Args:
        scene, chains: of the forward pass.
        d_origin: (R, 3) dL/dorigin of the chains' ends.
        d_direction: (R, 3) dL/ddirection.
        d_factor: (R,) dL/dfactor.

    Raises:
        ShapeError, RangeError: arrays of other shapes, or numbers that are not finite.
    """
    call = Arguments("trace_chains_backward", np.float64)
    shape = chains.origin.shape
    live = (chains.state == ENDED)[:, None]
    d_o = call.array("d_origin", d_origin, shape) * live
    d_d = call.array("d_direction", d_direction, shape) * live
    d_f = call.array("d_factor", d_factor, shape[:1]) * live[:, 0]
    found = [_Sums(surface) for surface in scene.surfaces]
    for step in reversed(chains.steps):
        surface, rays = scene.surfaces[step.surface], step.rays
        o, d = step.origin, step.direction
        point = _intersect(surface, o, d, step.primitive)
        out = scatter(d, point.normal, surface.eta, step.reflected, step.pmf)
        into = Scattered(d_d[rays], d_f[rays] * step.factor)
        bent = scatter_backward(d, point.normal, surface.eta, step.reflected, step.pmf, into)
        at = Point(d_o[rays], bent.normal, np.zeros((len(rays), 2)))
        d_o[rays], d_d[rays] = found[step.surface].add(step, surface, at)
        d_d[rays] += bent.direction
        d_f[rays] *= out.factor
        found[step.surface].eta += float(bent.eta.sum()) if surface.eta is not None else 0.0
    return [sums.gradient() for sums in found]


class _Sums:
    """The gradient of one surface, while it is added up."""

    def __init__(self, surface: Surface) -> None:
        count = len(surface.vertices) if isinstance(surface, SpecularMesh) else 0
        self.vertices, self.normals = np.zeros((count, 3)), np.zeros((count, 3))
        self.eta, self.center, self.radius = 0.0, np.zeros(3), 0.0

    def add(self, step: _Step, surface: Surface, d_point: Point) -> tuple[FloatArray, FloatArray]:
        """Add what a step says; dL/d of the rays that arrive."""
        o, d = step.origin, step.direction
        if isinstance(surface, SpecularSphere):
            far = step.primitive == 1
            found = on_sphere_backward(o, d, surface.center, surface.radius, far, d_point)
            self.center += found.surface[0].sum(axis=0)
            self.radius += float(found.surface[1].sum())
            return found.origin, found.direction
        corners, normals = _triangles(surface, step.primitive)
        found = on_triangle_backward(o, d, corners, normals, d_point)
        index = surface.faces[step.primitive].reshape(-1)
        for total, rows in zip((self.vertices, self.normals), found.surface, strict=True):
            for axis in range(3):
                values = rows[:, :, axis].reshape(-1)
                total[:, axis] += np.bincount(index, values, len(total))
        return found.origin, found.direction

    def gradient(self) -> SurfaceGradient:
        """What was added."""
        return SurfaceGradient(self.vertices, self.normals, self.eta, self.center, self.radius)

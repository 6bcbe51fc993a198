"""What meshes have in common whose vertices are recovered: parameterization, priors, checks.

    x = (I + lambda L)^-1 u         vertices, as [Nicolet2021] parameterizes them

The faces are held: a surface keeps the topology that it starts with.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt

from photograd._checks import require_bounds
from photograd._fit_options import FitOptions
from photograd.errors import SceneError, message
from photograd.geometry.large_steps import LargeSteps
from photograd.geometry.mesh import Mesh
from photograd.geometry.mesh_priors import LaplacianEnergy, NormalConsistency
from photograd.raster import MeshEdges
from photograd.representation import Fittable, ParamSpec, Prior
from photograd.types import Array, FloatArray

VERTEX_RATE = 0.02
"""Adam's rate of u, in extents of the mesh."""


@dataclass(frozen=True)
class SurfacePolicy:
    """How the vertices of a mesh are parameterized, and what is asked of their places.

    smoothness: lambda of `LargeSteps`; 0 moves each vertex by itself.
    extent: size of the scene in meters; the learning rate of the vertices is in units of it.
    laplacian, normal_consistency: weights of the priors of `photograd.geometry.mesh_priors`.

    Raises:
        RangeError: a number that is negative or not finite.
    """

    smoothness: float = 10.0
    extent: float = 1.0
    laplacian: float = 0.0
    normal_consistency: float = 0.0

    def __post_init__(self) -> None:
        require_bounds(self, "smoothness", "extent", "laplacian", "normal_consistency", low=0)

    @classmethod
    def of(cls, vertices: Array, smoothness: float, options: FitOptions | None = None) -> Self:
        """That of a mesh.

        Args:
            vertices: (V, 3) meters.
            smoothness: lambda of `LargeSteps`.
            options: with weights of priors; None for none.
        """
        extent = float(np.sqrt(np.square(np.ptp(vertices, axis=0)).sum()))
        weights = (0.0, 0.0) if options is None else (options.laplacian, options.normal_consistency)
        return cls(smoothness, extent, *weights)


class SurfaceField(Fittable):
    """params["differential"] (V, 3) meters: u = (I + lambda L) x of the vertices x.

    Attributes:
        faces: (F, 3) uint32 vertex numbers, held.
        edges: of the faces.
        policy: how the vertices are parameterized.
    """

    capabilities: ClassVar[frozenset[str]] = frozenset({"image"})
    color_space: ClassVar[str] = "display"
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "optional"
    first_model_kinds: ClassVar[tuple[str, ...]] = ("mesh", "textured_mesh", "textured_surface")
    first_model_help: ClassVar[str] = "or without one, from a sphere"
    same_resolution: ClassVar[bool] = False
    fit_options: ClassVar[frozenset[str]] = frozenset({"laplacian", "normal_consistency"})
    row_updates: ClassVar[bool] = False
    gradient_picture: ClassVar[str] = "surface"
    export_suffixes: ClassVar[tuple[str, ...]] = (".glb", ".npz")
    exported_as: ClassVar[str] = "mesh.glb"
    faces: npt.NDArray[np.uint32]
    edges: MeshEdges
    policy: SurfacePolicy
    _steps: LargeSteps
    _laplacian: LaplacianEnergy
    _normals: NormalConsistency

    def _hold(self, count: int, faces: npt.NDArray[np.uint32], policy: SurfacePolicy) -> None:
        """Keep faces and policy, with what depends on them alone.

        Raises SceneError for a mesh that is not manifold.
        """
        self.faces, self.policy = faces, policy
        self.edges = manifold_edges(faces)
        ends = self.edges.ends
        self._steps = LargeSteps(ends, count, policy.smoothness)
        self._laplacian = LaplacianEnergy(ends, count, max(policy.extent, 1e-12))
        self._normals = NormalConsistency(ends, self.edges.opposite)

    @property
    def vertices(self) -> FloatArray:
        """(V, 3) float64 in the world, meters."""
        return self._steps.solve(self.params["differential"].astype(np.float64))

    @property
    def mesh(self) -> Mesh:
        """Vertices and faces, for tracing rays."""
        return Mesh(self.vertices, self.faces)

    @property
    def box(self) -> Array:
        """(2, 3) corners of the mesh in world meters."""
        vertices = self.vertices
        return np.stack([vertices.min(axis=0), vertices.max(axis=0)])

    @abstractmethod
    def colors_at(self, face: Array, weights: FloatArray) -> FloatArray:
        """(N, 4) straight display color and opacity at points of faces.

        Args:
            face: (N,) numbers of faces.
            weights: (N, 3) barycentrics.
        """

    @abstractmethod
    def color_logits(self) -> Array:
        """(V, 3) raw display colors of the vertices: sigmoid makes the colors of them."""

    @abstractmethod
    def unsmoothed(self) -> Self:
        """The same mesh with smoothness 0, which is drawn without a system to be solved."""

    def vertex_spec(self) -> ParamSpec:
        """Of the group "differential"."""
        extent = self.policy.extent
        far = 1e3 * max(extent, 1.0) * (1 + self.policy.smoothness)
        rate = max(VERTEX_RATE * extent, 1e-12)
        return ParamSpec(self.params["differential"].shape, "m", (-far, far), rate, "world")

    def priors(self) -> Sequence[Prior]:
        """Smooth vertices and smooth normals, as functions of u."""
        return (self._prior("laplacian", self._laplacian), self._prior("normals", self._normals))

    def _prior(self, name: str, energy: LaplacianEnergy | NormalConsistency) -> Prior:
        def value(u: Array) -> float:
            return energy.value(self._steps.solve(u))

        def gradient(u: Array, d_value: float = 1.0) -> Array:
            found = self._steps.solve(energy.gradient(self._steps.solve(u), d_value))
            return found.astype(u.dtype)

        return Prior(name, "differential", value, gradient)

    def observe(self, context: Any, gradients: dict[str, Array]) -> None:
        """Add the gradients of the priors, by the weights of the policy.

        Args:
            context: of the batch's rendering; not used.
            gradients: by group, changed in place.
        """
        del context
        weights = self.policy.laplacian, self.policy.normal_consistency
        u = self.params["differential"]
        for weight, prior in zip(weights, self.priors(), strict=True):
            if weight > 0:
                gradients["differential"] += prior.gradient(u, weight)


def require_area(function: str, vertices: FloatArray, faces: Array) -> None:
    """Raise SceneError for a triangle without area.

    Args:
        function: on whose behalf.
        vertices: (V, 3) meters.
        faces: (F, 3) vertex numbers.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    flat = np.flatnonzero(~np.cross(b - a, c - a).any(axis=1))
    if len(flat):
        got = f"{len(flat)} without, the first face {flat[0]}"
        raise SceneError(message(function, "faces", "triangles with area", got))


def manifold_edges(faces: Array) -> MeshEdges:
    """The edges of faces (F, 3).

    Raises SceneError where a face has one vertex twice, or an edge three faces or more.
    """
    a, b, c = faces.T
    twice = np.flatnonzero((a == b) | (b == c) | (c == a))
    if len(twice):
        got = f"{len(twice)} with one vertex twice, the first face {twice[0]}"
        raise SceneError(message("surface", "faces", "triangles of three vertices", got))
    edges = MeshEdges.of(faces)
    if edges.crowded:
        first = edges.ends[edges.inner < 0][0].tolist()
        got = f"{edges.crowded} with more, the first between vertices {first[0]} and {first[1]}"
        remedy = "repair the mesh: it is not manifold"
        raise SceneError(message("surface", "faces", "edges of one or two faces", got, remedy))
    return edges


def without_seams(mesh: Mesh) -> tuple[Array, Array]:
    """Vertices (V, 3) and faces (F, 3) of `mesh`, the vertices at one position merged into one."""
    vertices, which = np.unique(mesh.vertices + 0.0, axis=0, return_inverse=True)
    return vertices, which.reshape(-1)[mesh.faces]

"""A triangle mesh whose texture is fitted: an unlit surface that shines with its own radiance.

    color(ray) = T(uv, level),  T = sigmoid(texels), looked up in mip maps      where the ray hits
    level      = log2(distance * pixel_angle * texels per meter of the triangle)

Vertices, faces and texture coordinates are held. The lookup is linear in T, and neither uv nor the
level depends on it, so that the adjoint with respect to the texels is exact. There is none with
respect to the camera or the vertices: where a silhouette moves, a pixel jumps from one surface to
another, and the derivative of the lookup alone would miss that [Li2018].
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from photograd_course.color import srgb_encode
from photograd_course.portable_math import log, sigmoid
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain, require_bounds
from photograd._fit_options import FitOptions
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import START_COLOR
from photograd.fields.surface_files import UNLIT, write_glowing_mesh
from photograd.geometry.mesh import Bvh, Mesh
from photograd.representation import (
    COPIES,
    Fittable,
    Memory,
    Outputs,
    ParamSpec,
    RayBatch,
    RenderOptions,
    Start,
    register,
)
from photograd.textures import (
    build_mips,
    build_mips_backward,
    sample,
    sample_mips,
    sample_mips_backward,
)
from photograd.types import Array

LN_2 = 0.6931471805599453


@dataclass(frozen=True)
class MeshPolicy:
    """How a textured mesh is drawn.

    pixel_angle: of a pixel in radians, which decides the level of the mip map; 0 always takes the
    finest.

    Raises:
        RangeError: a negative angle, or one that is not finite.
    """

    pixel_angle: float = 0.0

    def __post_init__(self) -> None:
        require_bounds(self, "pixel_angle", low=0)


@dataclass(frozen=True)
class MeshContext:
    """What the backward pass needs: the colors as they were, and where they were looked up."""

    mips: list[Array]
    hit: NDArray[np.int64]  # numbers of the rays that hit something
    uv: Array
    level: Array


@register
class TexturedMesh(Fittable):
    """params["texels"] (H, W, 3) raw: the linear color of a texel is sigmoid(texel).

    Texture coordinates have v downwards; both sides of a triangle show the texture. Distances of
    `Outputs.depth` are those of the hit, opacity is 1 there and 0 elsewhere.

    Attributes:
        mesh: vertices in world meters, faces, uv in [0, 1].
        policy: how it is drawn.
    """

    name: ClassVar[str] = "textured_mesh"
    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})
    no_camera_adjoint: ClassVar[str] = "visibility is discontinuous at silhouettes"
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "required"
    first_model_kinds: ClassVar[tuple[str, ...]] = ("textured_mesh",)
    first_model_help: ClassVar[str] = (
        "its mesh comes from a file: --start-from mesh.glb, or read_textured_mesh"
    )
    row_updates: ClassVar[bool] = False
    counts: ClassVar[str] = "texture"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 512}
    export_suffixes: ClassVar[tuple[str, ...]] = (".glb", ".npz")
    exported_as: ClassVar[str] = "mesh.glb"

    def __init__(self, texels: Array, mesh: Mesh, policy: MeshPolicy | None = None) -> None:
        """Raises DtypeError, ShapeError, RangeError or SceneError for arrays that are no such mesh.

        A mesh needs texture coordinates, all of them in [0, 1].

        Args:
            texels: (H, W, 3) raw colors.
            mesh: held as it is.
            policy: of the lookup; None takes the default.
        """
        call = Arguments("TexturedMesh")
        texels = call.array("texels", texels, ("H", "W", 3), finite=False, min_length=1)
        if mesh.uv is None or not bool(((mesh.uv >= 0) & (mesh.uv <= 1)).all()):
            got = "none" if mesh.uv is None else "others"
            remedy = "unwrap the mesh, so that no texture repeats"
            expected = "texture coordinates in [0, 1]"
            raise RangeError(message("TexturedMesh", "mesh.uv", expected, got, remedy))
        self.params = {"texels": texels}
        self.mesh = mesh
        self.policy = policy or MeshPolicy()
        self._bvh = Bvh(mesh)
        self._density = _uv_per_meter(mesh)

    @classmethod
    def of_mesh(cls, mesh: Mesh) -> Self:
        """A mesh without a texture yet, all middle gray, for a fit to start from."""
        gray = float(log(START_COLOR / (1 - START_COLOR)))
        return cls(np.full((1, 1, 3), gray, np.float32), mesh)

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Two triangles and a third behind them, 6 x 7 random texels, seen at levels 0 to 2."""
        vertices = [[-1, -1, 0], [1, -1, 0.3], [1, 1, 0], [-1, 1, -0.3]]
        vertices += [[0.3, -1.8, -1], [2.5, -1, -1], [1, 2, -1]]
        uv = [[0.05, 0.95], [0.6, 0.9], [0.55, 0.1], [0.2, 0.45], [0.6, 1], [1, 0.9], [0.8, 0]]
        faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6]])
        u = uniform(seed, step=0, pixel=np.arange(6 * 7 * 3), sample=0, dimension=0)
        mesh = Mesh(np.array(vertices, np.float64), faces, np.array(uv, np.float64))
        return cls((2 * u - 1).reshape(6, 7, 3).astype(dtype), mesh, MeshPolicy(0.35))

    def example_batch(self, *, seed: int) -> RayBatch:
        """60 rays from a point in front towards the square of the triangles; some pass by."""
        pixel = np.arange(60, dtype=np.uint32)
        u = [uniform(seed, step=1, pixel=pixel, sample=0, dimension=k) for k in range(2)]
        target = np.stack([3.6 * u[0] - 1.8, 3.6 * u[1] - 1.8, np.zeros(60)], axis=-1)
        origin = np.array([0.3, 0.2, 3.0])
        directions = target - origin
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return RayBatch(np.tile(origin, (60, 1)), directions, pixel)

    @property
    def box(self) -> Array:
        """(2, 3) corners of the mesh in world meters."""
        return self._bvh.bounds.astype(np.float64)

    @property
    def resolution(self) -> int:
        """Texels along the longer edge of the texture."""
        height, width = self.shape[:2]
        return max(height, width)

    @property
    def shape(self) -> tuple[int, int, int]:
        """(H, W, 3) of the texture."""
        height, width, channels = self.params["texels"].shape
        return height, width, channels

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """One group. Adam moves a texel by about its rate."""
        shape = self.params["texels"].shape
        return {"texels": ParamSpec(shape, "1", (-20.0, 20.0), 0.3, "none")}

    def colors(self) -> Array:
        """(H, W, 3) linear colors of the texels, in (0, 1)."""
        found: Array = sigmoid(self.params["texels"])
        return found

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, MeshContext]:
        """Color (R, 3) linear, opacity (R,) 0 or 1, depth (R,) m.

        Raises RangeError for `options.camera_adjoint`.
        """
        del seed, step  # nothing random here
        if options.camera_adjoint:
            expected = "no derivative with respect to the camera"
            got = f"one: {self.no_camera_adjoint}"
            raise RangeError(message("TexturedMesh.render", "camera_adjoint", expected, got))
        dtype = self.params["texels"].dtype
        origins = np.ascontiguousarray(batch.origins, dtype)
        directions = np.ascontiguousarray(batch.directions, dtype)
        hits = self._bvh.trace(origins, directions)
        points = self._bvh.surface_points(origins, directions, hits)
        hit = np.flatnonzero(hits.hit)
        depth = np.where(hits.hit, points.t, 0).astype(dtype)
        uv = np.ascontiguousarray(points.uv[hit])
        level = self._levels(depth[hit], hits.primitive[hit])
        mips = build_mips(self.colors())
        color = np.zeros((len(origins), 3), dtype)
        color[hit] = sample_mips(mips, uv, level)
        outputs = Outputs(color, hits.hit.astype(dtype), depth)
        return outputs.checked("TexturedMesh.render", batch), MeshContext(mips, hit, uv, level)

    def render_backward(self, context: MeshContext, d_outputs: Outputs) -> dict[str, Array]:
        """{"texels": (H, W, 3)}; opacity and depth do not depend on the texels."""
        color = context.mips[0]
        d_color = np.ascontiguousarray(np.asarray(d_outputs.color, color.dtype)[context.hit])
        d_mips, _, _ = sample_mips_backward(context.mips, context.uv, context.level, d_color)
        return {"texels": build_mips_backward(d_mips) * color * (1 - color)}

    def _levels(self, distance: Array, face: NDArray[np.int32]) -> Array:
        """(N,) levels of the mip map for hits at a distance (m) on faces."""
        height, width = self.shape[:2]
        texels = float(np.sqrt(height * width)) * self._density[face]
        footprint = distance * self.policy.pixel_angle * texels
        return (log(np.maximum(footprint, 1.0)) / LN_2).astype(distance.dtype)

    # What a fit asks.

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """The mesh of the first model, its texture at the resolution of the options.

        Raises RangeError for a model that is none.
        """
        first, size = start.field, start.options.resolution
        if not isinstance(first, TexturedMesh):
            got = "none" if first is None else repr(first.name)
            expected = f"a model of {cls.name}"
            raise RangeError(
                message("Fit.start", "start_from", expected, got, cls.first_model_help)
            )
        centers = (np.arange(size) + 0.5) / size
        texels = first.params["texels"].astype(np.float32)
        uv = np.stack(np.meshgrid(centers, centers), axis=-1).reshape(-1, 2).astype(np.float32)
        angles = [1.0 / view.camera.fx for view in start.capture.train]
        policy = MeshPolicy(float(np.median(angles)))
        field = cls(sample(texels, uv).reshape(size, size, 3), first.mesh, policy)
        return field, f"mesh: {len(first.mesh.faces):,} triangles, held"

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """The texels; the mesh."""
        size = options.resolution
        return {"texels": (FLOAT, (size, size, 3))}, {
            "vertices": (("float32",), ("V", 3)),
            "faces": (("uint32",), ("F", 3)),
            "uv": (("float32",), ("V", 2)),
        }

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The textured mesh of a checkpoint."""
        del options
        mesh = Mesh(state["vertices"], state["faces"], state["uv"])
        return cls(params["texels"], mesh, from_plain("checkpoint", MeshPolicy, policy))

    @classmethod
    def memory(cls, box: Array, options: FitOptions, available: int) -> Sequence[Memory]:
        """Of the texture and its mip map."""
        del box
        size = COPIES * 4 * 4 * options.resolution * options.resolution
        fits = int(options.resolution * float(np.sqrt(min(1.0, available / (2 * size)))))
        what = f"a texture of {options.resolution} texels along an edge"
        return (Memory("resolution", what, size, f"--resolution {fits} takes half of it"),)

    def state(self) -> dict[str, Array]:
        """The mesh, which no fit changes."""
        assert self.mesh.uv is not None
        return {"vertices": self.mesh.vertices, "faces": self.mesh.faces, "uv": self.mesh.uv}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Raises RangeError unless `state` is that of the same mesh."""
        own = self.state()
        if set(state) != set(own) or not all(np.array_equal(state[k], own[k]) for k in own):
            expected = f"this mesh's {sorted(own)}"
            where = "TexturedMesh.load_state"
            raise RangeError(message(where, "state", expected, f"{sorted(state)}"))

    def gradient_image(self, gradients: Mapping[str, Array]) -> Array:
        """(H, W) the mean of the texels' channels."""
        mean: Array = gradients["texels"].mean(axis=2)
        return mean

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """Write a .glb file, its texture in it (sRGB, 8 bits), or all arrays to an .npz file."""
        if path.suffix.lower() != ".glb":
            return super().export(path, background)
        assert self.mesh.uv is not None
        pixels = np.rint(255 * np.clip(srgb_encode(self.colors()), 0, 1)).astype(np.uint8)
        mesh = self.mesh
        write_glowing_mesh(path, mesh.vertices, mesh.faces, uv=mesh.uv, pixels=pixels)
        return (f"its texture is radiance: {UNLIT} shows it without lights",)


def _uv_per_meter(mesh: Mesh) -> Array:
    """(F,) root of the ratio of a triangle's area in the texture to that in the world, in 1/m."""
    assert mesh.uv is not None
    world = mesh.vertices.astype(np.float64)[mesh.faces]
    flat = mesh.uv.astype(np.float64)[mesh.faces]
    a, b = world[:, 1] - world[:, 0], world[:, 2] - world[:, 0]
    area = np.linalg.norm(np.cross(a, b), axis=1)
    (u1, v1), (u2, v2) = (flat[:, 1] - flat[:, 0]).T, (flat[:, 2] - flat[:, 0]).T
    ratio: Array = np.sqrt(np.abs(u1 * v2 - u2 * v1) / np.maximum(area, 1e-30))
    return ratio

"""A triangle mesh whose vertices and colors are both recovered, drawn by the rasterizer.

    x     = (I + lambda L)^-1 u                     vertices, as [Nicolet2021] parameterizes them
    image = antialias(interpolate(sigmoid(c)))      color, opacity and depth, edges blended

The faces are held in a step: a surface keeps the topology that it starts with. Between steps
`remesh` may give it new ones on the same surface. `surface_picture` draws it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from photograd_course.color import srgb_decode
from photograd_course.portable_math import log, sigmoid
from photograd_course.random import normal_vectors, uniform

from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain
from photograd._fit_options import FitOptions
from photograd.capture.frames import invert_rigid
from photograd.capture.orbit import orbit_cameras
from photograd.errors import RangeError, message
from photograd.fields.bake import colors_nearby
from photograd.fields.surface import (
    SurfaceField,
    SurfacePolicy,
    manifold_edges,
    require_area,
    without_seams,
)
from photograd.fields.surface_files import UNLIT, write_glowing_mesh
from photograd.fields.surface_picture import SurfacePicture
from photograd.fields.textured_mesh import TexturedMesh
from photograd.geometry.icosphere import icosphere
from photograd.geometry.large_steps import LargeSteps
from photograd.geometry.normals import vertex_normals
from photograd.geometry.remesh import remesh, surface_area
from photograd.representation import (
    COPIES,
    FitInProgress,
    ImageBatch,
    Memory,
    Outputs,
    ParamSpec,
    RenderOptions,
    Start,
    register,
)
from photograd.types import Array, FloatArray


@dataclass(frozen=True, eq=False)
class SurfaceContext:
    """What the backward pass needs."""

    picture: SurfacePicture
    camera_adjoint: bool


@register
class MeshSurface(SurfaceField):
    """params["differential"] (V, 3) meters: u = (I + lambda L) x of the vertices x.
    params["color_logits"] (V, 3): the display color of a vertex is sigmoid of it.

    Both sides of a triangle are seen. An edge may have one face or two. It calculates in float64.

    Attributes:
        faces: (F, 3) uint32, held.
        edges: of the faces.
        policy: how the vertices are parameterized.
    """

    name: ClassVar[str] = "mesh"
    fit_options: ClassVar[frozenset[str]] = SurfaceField.fit_options | {"remesh"}
    counts: ClassVar[str] = "sphere"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 16, "steps": 1000}

    def __init__(
        self,
        differential: Array,
        color_logits: Array,
        faces: Array,
        policy: SurfacePolicy | None = None,
    ) -> None:
        """`of_mesh` takes vertices.

        Args:
            differential: (V, 3) u, float32 or float64.
            color_logits: (V, 3), of the same type.
            faces: (F, 3) vertex numbers.
            policy: of the parameterization; None takes the default.

        Raises:
            DtypeError, ShapeError, RangeError: arrays of other types or shapes, values that are
                not finite, numbers that name no vertex.
            SceneError: a face with one vertex twice, or an edge of three faces or more.
        """
        call = Arguments("MeshSurface")
        differential = call.array("differential", differential, ("V", 3), min_length=1)
        count = len(differential)
        logits = call.array("color_logits", color_logits, (count, 3), dtype=differential.dtype)
        faces = call.array(
            "faces", faces, ("F", 3), dtype=np.uint32, low=0, high=count - 1, min_length=1
        )
        self.params = {"differential": differential, "color_logits": logits}
        self._hold(count, faces, policy or SurfacePolicy())

    @classmethod
    def of_mesh(
        cls,
        vertices: Array,
        faces: Array,
        color_logits: Array | None = None,
        *,
        smoothness: float = 10.0,
        dtype: type[np.floating[Any]] = np.float32,
        options: FitOptions | None = None,
    ) -> Self:
        """The parameters of a mesh, by default middle gray.

        Args:
            vertices: (V, 3) in the world, meters.
            faces: (F, 3) vertex numbers.
            color_logits: (V, 3), or None for zeros.
            smoothness: lambda of `LargeSteps`.
            dtype: of the parameters.
            options: of a fit, with the weights of the priors; None for none.

        Raises:
            DtypeError, ShapeError, RangeError: as for the class.
            SceneError: as for the class, or a triangle without area.
        """
        call = Arguments("MeshSurface.of_mesh", np.float64)
        vertices = call.array("vertices", vertices, ("V", 3), min_length=1)
        high = len(vertices) - 1
        faces = call.array("faces", faces, ("F", 3), dtype=np.uint32, low=0, high=high)
        require_area("MeshSurface.of_mesh", vertices, faces)
        policy = SurfacePolicy.of(vertices, smoothness, options)
        steps = LargeSteps(manifold_edges(faces).ends, len(vertices), smoothness)
        logits = np.zeros_like(vertices) if color_logits is None else np.asarray(color_logits)
        return cls(steps.times(vertices).astype(dtype), logits.astype(dtype), faces, policy)

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """An icosahedron, its vertices and colors random."""
        sphere = icosphere(1)
        rows = np.arange(len(sphere.vertices))
        shift, logits = (normal_vectors(seed, step=2, row=rows, sample=k) for k in range(2))
        vertices = 0.7 * sphere.vertices.astype(np.float64) + 0.05 * shift
        return cls.of_mesh(vertices, sphere.faces, logits, smoothness=0.5, dtype=dtype)

    def example_batch(self, *, seed: int) -> ImageBatch:
        """A picture of 8 x 7 pixels from some meters away."""
        box = np.array([[-0.8, -0.8, -0.8], [0.8, 0.8, 0.8]])
        camera = list(orbit_cameras(box, 5, size=8, elevation=20.0))[seed % 5]
        # No vertex or edge at the center of a pixel.
        shift = float(uniform(seed, step=3, pixel=0, sample=0, dimension=0))
        low = replace(camera, height=7, cy=camera.cy - 0.5 + 0.1 * shift)
        pose = invert_rigid(low.world_from_camera)[:3]
        return ImageBatch(low, np.ascontiguousarray(pose))

    def colors(self) -> FloatArray:
        """(V, 3) float64 display colors of the vertices, in (0, 1)."""
        found: FloatArray = sigmoid(self.params["color_logits"].astype(np.float64))
        return found

    def colors_at(self, face: Array, weights: FloatArray) -> FloatArray:
        """(N, 4) straight display color and opacity at points of faces."""
        found = np.einsum("nk,nkc->nc", weights, self.colors()[self.faces[face]])
        return np.concatenate([found, np.ones((len(found), 1))], axis=1)

    def color_logits(self) -> Array:
        """(V, 3) raw display colors of the vertices."""
        return self.params["color_logits"]

    def unsmoothed(self) -> Self:
        """The same mesh with smoothness 0."""
        logits = self.params["color_logits"]
        return type(self).of_mesh(self.vertices, self.faces, logits, smoothness=0.0)

    @property
    def resolution(self) -> int:
        """Divisions of an icosahedron's edge that give about as many vertices."""
        divisions = math.sqrt(max(len(self.params["differential"]) - 2, 0) / 10)
        return max(1, round(divisions))

    @property
    def shape(self) -> tuple[int, ...]:
        """(V, F), the numbers of vertices and faces."""
        return len(self.params["differential"]), len(self.faces)

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Both have a row a vertex."""
        shape = self.params["color_logits"].shape
        return {
            "differential": self.vertex_spec(),
            "color_logits": ParamSpec(shape, "1", (-20.0, 20.0), 0.05, "none"),
        }

    def render(
        self, batch: ImageBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, SurfaceContext]:
        """Color (P, 3), opacity (P,) and depth (P,) of all pixels, row by row.

        Raises Error if one is not finite.
        """
        del seed, step  # nothing random here
        picture = SurfacePicture.of(self.vertices, self.colors(), self.faces, self.edges, batch)
        rows = picture.image.reshape(-1, 5).astype(self.params["color_logits"].dtype)
        color, opacity, depth = rows[:, :3], rows[:, 3], rows[:, 4]
        outputs = Outputs(*(np.ascontiguousarray(part) for part in (color, opacity, depth)))
        outputs = outputs.checked("MeshSurface.render", batch)
        return outputs, SurfaceContext(picture, options.camera_adjoint)

    def render_backward(self, context: SurfaceContext, d_outputs: Outputs) -> dict[str, Array]:
        """dL/d params, and "camera_from_world" (3, 4) if the options asked."""
        found = context.picture.backward(context.picture.cotangent(d_outputs))
        colors = context.picture.colors
        gradients: dict[str, Array] = {
            "differential": self._steps.solve(found.vertices),
            "color_logits": found.colors * colors * (1 - colors),
        }
        if context.camera_adjoint:
            gradients["camera_from_world"] = found.camera_from_world
        dtype = self.params["color_logits"].dtype
        return {name: gradient.astype(dtype) for name, gradient in gradients.items()}

    # What a fit asks.

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """The mesh of the first model, or the largest ellipsoid in the box.

        Raises RangeError for a model without a mesh, SceneError for one that is not manifold.
        """
        first = start.field
        if first is None:
            low, high = start.bounds.box
            sphere = icosphere(start.options.resolution)
            vertices = (low + high) / 2 + (high - low) / 2 * sphere.vertices.astype(np.float64)
            field = cls.of_mesh(vertices, sphere.faces, options=start.options)
        elif isinstance(first, SurfaceField):
            logits = first.color_logits()
            smoothness = first.policy.smoothness
            field = cls.of_mesh(
                first.vertices, first.faces, logits, smoothness=smoothness, options=start.options
            )
        elif isinstance(first, TexturedMesh):
            field = cls.of_mesh(*without_seams(first.mesh), options=start.options)
        else:
            expected = f"a model of {' or '.join(cls.first_model_kinds)}"
            raise RangeError(
                message("Fit.start", "start_from", expected, repr(first.name), cls.first_model_help)
            )
        source = "ellipsoid in the box" if first is None else f"that of the {first.name}"
        return field, f"mesh: {source}, {len(field.faces):,} triangles"

    def adapted(self, fit: FitInProgress) -> Self:
        """With new triangles where the options say so; the optimizer's moments begin anew.

        Raises IoError where the library that makes them is not installed.
        """
        if fit.step_number not in self.events(fit.options):
            return self
        after = self.remeshed()
        for name, values in after.params.items():
            fit.optimizer.resample(name, partial(_emptied, values))
        return after

    @classmethod
    def events(cls, options: FitOptions) -> dict[int, str]:
        """Each new mesh."""
        if not options.remesh:
            return {}
        return {int(part * options.steps): "remeshed" for part in options.refine_at}

    def remeshed(self) -> Self:
        """About as many triangles of equal size on the same surface, its colors looked up there.

        Raises:
            IoError: the library is not installed; the extra is `remesh`.
            SceneError: what came out is not manifold.
        """
        before = self.vertices
        area = surface_area(before, self.faces)
        length = math.sqrt(area / len(self.faces) * 4 / math.sqrt(3))
        vertices, faces = remesh(before, self.faces, length)
        colors, found = colors_nearby(vertices, vertex_normals(vertices, faces), self)
        for row in np.flatnonzero(~found):
            near = np.square(before - vertices[row]).sum(axis=1).argmin()
            colors[row, :3] = self.colors()[near]
        kept = np.clip(colors[:, :3], 1e-6, 1 - 1e-6)
        logits = log(kept) - log(1 - kept)
        dtype = self.params["differential"].dtype.type
        after = type(self).of_mesh(
            vertices, faces, logits, smoothness=self.policy.smoothness, dtype=dtype
        )
        after.policy = self.policy  # extent and rates are those of the start
        return after

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """A row a vertex; the faces."""
        del options
        rows: dict[str, Row] = {
            "differential": (FLOAT, ("V", 3)),
            "color_logits": (FLOAT, ("V", 3)),
        }
        return rows, {"faces": (("uint32",), ("F", 3))}

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The mesh of a checkpoint."""
        del options
        told = from_plain("checkpoint", SurfacePolicy, policy)
        return cls(params["differential"], params["color_logits"], state["faces"], told)

    @classmethod
    def memory(cls, box: Array, options: FitOptions, available: int) -> Sequence[Memory]:
        """Of the vertices and the faces of a sphere."""
        del box
        size = (COPIES * 4 * 6 * 10 + 12 * 20) * options.resolution * options.resolution
        fits = int(options.resolution * float(np.sqrt(min(1.0, available / (2 * size)))))
        triangles = 20 * options.resolution * options.resolution
        what = f"a sphere of {triangles:,} triangles"
        return (Memory("resolution", what, size, f"--resolution {fits} takes half of it"),)

    def state(self) -> dict[str, Array]:
        """The faces, which no fit changes."""
        return {"faces": self.faces}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Raises RangeError unless `state` is that of the same mesh."""
        if set(state) != {"faces"} or not np.array_equal(state["faces"], self.faces):
            where = "MeshSurface.load_state"
            raise RangeError(message(where, "state", "this mesh's ['faces']", f"{sorted(state)}"))

    def stored(self) -> dict[str, Array]:
        """Vertices in meters, linear colors and faces."""
        return {
            "vertices": self.vertices.astype(np.float32),
            "colors": srgb_decode(self.colors()).astype(np.float32),
            "faces": self.faces,
        }

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """Write a .glb file with the colors of the vertices, or all arrays to an .npz file."""
        if path.suffix.lower() != ".glb":
            return super().export(path, background)
        arrays = self.stored()
        write_glowing_mesh(path, arrays["vertices"], self.faces, colors=arrays["colors"])
        return (f"its vertex colors are radiance: {UNLIT} shows them without lights",)


def _emptied(values: Array, moment: FloatArray) -> FloatArray:
    """A moment of no history for new `values`."""
    return np.zeros(values.shape, moment.dtype)

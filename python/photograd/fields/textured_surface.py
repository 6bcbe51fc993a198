"""A triangle mesh whose vertices, texture and opacity are recovered, drawn by the rasterizer.

    x       = (I + lambda L)^-1 u                vertices, as [Nicolet2021] parameterizes them
    c, a    = sigmoid(texels)                    display color and opacity of a texel
    texture = (a c, a), in mip maps              what is transparent has no color to leak
    image   = layers of faces, edges blended     `layered_picture` draws them

The faces and their texture coordinates are held. Without opacity a = 1, and one layer is all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from photograd_course.portable_math import sigmoid
from photograd_course.random import normal_vectors, uniform

from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain, require_bounds
from photograd._fit_options import FitOptions
from photograd.capture.frames import invert_rigid
from photograd.capture.orbit import orbit_cameras
from photograd.errors import RangeError, message
from photograd.fields.layered_picture import LayeredPicture, Unwrapped
from photograd.fields.surface import SurfaceField, SurfacePolicy, manifold_edges, require_area
from photograd.fields.surface_files import UNLIT, write_glowing_mesh
from photograd.fields.surface_texels import (
    START_OPACITY,
    checked_unwrapped,
    is_opaque,
    parts_of,
    raw_texels,
    resampled,
)
from photograd.geometry.large_steps import LargeSteps
from photograd.geometry.octahedron import unwrapped_sphere
from photograd.representation import (
    COPIES,
    ImageBatch,
    Memory,
    Outputs,
    ParamSpec,
    RenderOptions,
    Start,
    register,
)
from photograd.textures import sample
from photograd.types import Array, FloatArray

SMOOTHNESS = SurfacePolicy().smoothness
TEXEL_RATE = 0.1
"""Adam's rate of raw texels."""
TEXELS_PER_EDGE = 4
"""Of a sphere that a fit starts from: texels along an edge of a triangle."""


@dataclass(frozen=True)
class TexturePolicy(SurfacePolicy):
    """How a mesh with a texture is parameterized and drawn.

    max_layers: transparent faces that a pixel shows, one behind the other, at most.

    Raises:
        RangeError: numbers out of range.
    """

    max_layers: int = 8

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "max_layers", low=1, high=64)


@dataclass(frozen=True, eq=False)
class TextureContext:
    """What the backward pass needs."""

    picture: LayeredPicture
    texels: FloatArray
    camera_adjoint: bool


@register
class TexturedSurface(SurfaceField):
    """params["differential"] (V, 3) meters: u = (I + lambda L) x of the vertices x.
    params["texels"] (H, W, 4) raw: sigmoid makes display color and opacity of them; (H, W, 3) is
    opaque.

    Both sides of a triangle show the texture. An edge may have one face or two. It calculates in
    float64.

    Attributes:
        unwrapped: the faces in the texture.
        faces: (F, 3) uint32 vertex numbers, held.
        edges: of the faces.
        policy: how it is parameterized and drawn.
    """

    name: ClassVar[str] = "textured_surface"
    fit_options: ClassVar[frozenset[str]] = SurfaceField.fit_options | {"opacity"}
    counts: ClassVar[str] = "texture"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 128, "steps": 1000}
    policy: TexturePolicy

    def __init__(
        self,
        differential: Array,
        texels: Array,
        unwrapped: Unwrapped,
        policy: TexturePolicy | None = None,
    ) -> None:
        """`of_mesh` takes vertices.

        Args:
            differential: (V, 3) u, float32 or float64.
            texels: (H, W, 3) or (H, W, 4), of the same type.
            unwrapped: the faces in the texture.
            policy: of the parameterization; None takes the default.

        Raises:
            DtypeError, ShapeError, RangeError: arrays of other types or shapes, values that are
                not finite, numbers that name nothing, coordinates outside of [0, 1].
            SceneError: a face with one vertex twice, or an edge of three faces or more.
        """
        call = Arguments("TexturedSurface")
        differential = call.array("differential", differential, ("V", 3), min_length=1)
        channels = 4 if np.shape(texels)[2:] == (4,) else 3
        texels = call.array(
            "texels", texels, ("H", "W", channels), dtype=differential.dtype, min_length=1
        )
        self.params = {"differential": differential, "texels": texels}
        self.unwrapped = checked_unwrapped("TexturedSurface", unwrapped, len(differential))
        self._hold(len(differential), self.unwrapped.faces, policy or TexturePolicy())

    @classmethod
    def of_mesh(
        cls,
        vertices: Array,
        unwrapped: Unwrapped,
        texels: Array,
        *,
        smoothness: float = 10.0,
        dtype: type[np.floating[Any]] = np.float32,
        options: FitOptions | None = None,
    ) -> Self:
        """The parameters of a mesh.

        Args:
            vertices: (V, 3) in the world, meters.
            unwrapped: its faces in the texture.
            texels: (H, W, 3) or (H, W, 4) raw.
            smoothness: lambda of `LargeSteps`.
            dtype: of the parameters.
            options: of a fit, with the weights of the priors; None for none.

        Raises:
            DtypeError, ShapeError, RangeError: as for the class.
            SceneError: as for the class, or a triangle without area.
        """
        call = Arguments("TexturedSurface.of_mesh", np.float64)
        vertices = call.array("vertices", vertices, ("V", 3), min_length=1)
        unwrapped = checked_unwrapped("TexturedSurface.of_mesh", unwrapped, len(vertices))
        require_area("TexturedSurface.of_mesh", vertices, unwrapped.faces)
        policy = TexturePolicy.of(vertices, smoothness, options)
        steps = LargeSteps(manifold_edges(unwrapped.faces).ends, len(vertices), smoothness)
        raw = np.asarray(texels).astype(dtype)
        return cls(steps.times(vertices).astype(dtype), raw, unwrapped, policy)

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """An octahedron with each edge halved, vertices and 9 x 8 texels random."""
        sphere, uv, corners, vertex = unwrapped_sphere(2)
        shift = normal_vectors(seed, step=2, row=np.arange(len(sphere)), sample=0)
        u = uniform(seed, step=3, pixel=np.arange(9 * 8 * 4), sample=0, dimension=0)
        texels = (3 * u - 1.5).reshape(9, 8, 4)
        unwrapped = Unwrapped(uv, corners, vertex)
        return cls.of_mesh(
            0.7 * sphere + 0.05 * shift, unwrapped, texels, smoothness=0.5, dtype=dtype
        )

    def example_batch(self, *, seed: int) -> ImageBatch:
        """A picture of 8 x 7 pixels from some meters away."""
        box = np.array([[-0.8, -0.8, -0.8], [0.8, 0.8, 0.8]])
        camera = list(orbit_cameras(box, 5, size=8, elevation=20.0))[seed % 5]
        # No vertex or edge at the center of a pixel.
        shift = float(uniform(seed, step=3, pixel=0, sample=1, dimension=0))
        low = replace(camera, height=7, cy=camera.cy - 0.5 + 0.1 * shift)
        pose = invert_rigid(low.world_from_camera)[:3]
        return ImageBatch(low, np.ascontiguousarray(pose))

    @property
    def has_opacity(self) -> bool:
        """Whether texels have an opacity."""
        return bool(self.params["texels"].shape[2] == 4)

    def rgba(self) -> FloatArray:
        """(H, W, 4) float64 display color and opacity of the texels, straight."""
        found = sigmoid(self.params["texels"].astype(np.float64))
        if self.has_opacity:
            return found
        return np.concatenate([found, np.ones((*found.shape[:2], 1))], axis=2)

    def colors_at(self, face: Array, weights: FloatArray) -> FloatArray:
        """(N, 4) straight display color and opacity at points of faces."""
        flat = self.unwrapped
        uv = np.einsum("nk,nkc->nc", weights, flat.uv[flat.corners[face]])
        found: FloatArray = sample(self.rgba(), uv)
        return found

    def color_logits(self) -> Array:
        """(V, 3) raw display colors of the vertices, at one of their texture coordinates each."""
        flat = self.unwrapped
        row = np.zeros(len(self.params["differential"]), np.int64)
        row[flat.vertex] = np.arange(len(flat.vertex))
        colors = sample(self.rgba(), flat.uv[row])[None]
        found: Array = raw_texels(colors, None)[0]
        return found

    def unsmoothed(self) -> Self:
        """The same mesh with smoothness 0."""
        texels = self.params["texels"]
        field = type(self).of_mesh(self.vertices, self.unwrapped, texels, smoothness=0.0)
        field.policy = replace(field.policy, max_layers=self.policy.max_layers)
        return field

    @property
    def resolution(self) -> int:
        """Texels along the longer edge of the texture."""
        height, width = self.shape[2:]
        return max(height, width)

    @property
    def shape(self) -> tuple[int, ...]:
        """(V, F, H, W), the numbers of vertices and faces, and the size of the texture."""
        return len(self.params["differential"]), len(self.faces), *self.params["texels"].shape[:2]

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Vertices, and texels; Adam moves a texel by about its rate."""
        texels = ParamSpec(self.params["texels"].shape, "1", (-20.0, 20.0), TEXEL_RATE, "none")
        return {"differential": self.vertex_spec(), "texels": texels}

    def render(
        self, batch: ImageBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, TextureContext]:
        """Color (P, 3), opacity (P,) and depth (P,) of all pixels, row by row.

        Raises Error if one is not finite.
        """
        del seed, step  # nothing random here
        texels = self.rgba()
        texture = np.concatenate([texels[..., 3:] * texels[..., :3], texels[..., 3:]], axis=2)
        layers = self.policy.max_layers if self.has_opacity else 1
        picture = LayeredPicture.of(
            self.vertices, texture, self.unwrapped, self.edges, batch, layers
        )
        rows = picture.image.reshape(-1, 5).astype(self.params["texels"].dtype)
        color, opacity, depth = rows[:, :3], rows[:, 3], rows[:, 4]
        outputs = Outputs(*(np.ascontiguousarray(part) for part in (color, opacity, depth)))
        outputs = outputs.checked("TexturedSurface.render", batch)
        return outputs, TextureContext(picture, texels, options.camera_adjoint)

    def render_backward(self, context: TextureContext, d_outputs: Outputs) -> dict[str, Array]:
        """dL/d params, and "camera_from_world" (3, 4) if the options asked."""
        picture = context.picture
        parts = picture.position_gradients(picture.cotangent(d_outputs))
        d_vertices, d_pose = picture.pose_gradients(parts.silhouettes + parts.interior)
        color, opacity = context.texels[..., :3], context.texels[..., 3:]
        d_color, d_opacity = parts.texture[..., :3], parts.texture[..., 3:]
        d_texels = np.concatenate(
            [
                d_color * opacity * color * (1 - color),
                (d_opacity + (d_color * color).sum(axis=2, keepdims=True))
                * opacity
                * (1 - opacity),
            ],
            axis=2,
        )
        channels = self.params["texels"].shape[2]
        gradients: dict[str, Array] = {
            "differential": self._steps.solve(d_vertices),
            "texels": np.ascontiguousarray(d_texels[..., :channels]),
        }
        if context.camera_adjoint:
            gradients["camera_from_world"] = d_pose
        dtype = self.params["texels"].dtype
        return {name: gradient.astype(dtype) for name, gradient in gradients.items()}

    # What a fit asks.

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """The mesh of the first model with its texture, or the largest ellipsoid in the box.

        Raises RangeError for a model without a mesh, or one with opacity where `options.opacity`
        is off; SceneError for one that is not manifold; IoError where a mesh of vertex colors has
        to be unwrapped and the library is not installed.
        """
        first, options = start.field, start.options
        size = options.resolution
        smoothness = first.policy.smoothness if isinstance(first, SurfaceField) else SMOOTHNESS
        if first is None:
            low, high = start.bounds.box
            sphere, uv, corners, vertex = unwrapped_sphere(max(2, size // (2 * TEXELS_PER_EDGE)))
            vertices = (low + high) / 2 + (high - low) / 2 * sphere
            unwrapped, rgba = Unwrapped(uv, corners, vertex), np.array([[[0.5, 0.5, 0.5, 1.0]]])
        elif isinstance(first, TexturedSurface):
            vertices, unwrapped, rgba = first.vertices, first.unwrapped, first.rgba()
        else:
            vertices, unwrapped, rgba = parts_of(first, size)
        if not options.opacity and not is_opaque(rgba):
            expected, remedy = "an opaque model", "--opacity recovers that, too"
            raise RangeError(message("Fit.start", "start_from", expected, "opacity", remedy))
        start_opacity = START_OPACITY if options.opacity else None
        texels = raw_texels(resampled(rgba, size), start_opacity)
        field = cls.of_mesh(vertices, unwrapped, texels, smoothness=smoothness, options=options)
        source = "ellipsoid in the box" if first is None else f"that of the {first.name}"
        return field, f"mesh: {source}, {len(field.faces):,} triangles"

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """A row a vertex, and the texels; the faces in the texture."""
        size = options.resolution
        rows: dict[str, Row] = {
            "differential": (FLOAT, ("V", 3)),
            "texels": (FLOAT, (size, size, 4 if options.opacity else 3)),
        }
        return rows, {
            "uv": (("float64",), ("T", 2)),
            "corners": (("uint32",), ("F", 3)),
            "vertex": (("uint32",), ("T",)),
        }

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
        told = from_plain("checkpoint", TexturePolicy, policy)
        unwrapped = Unwrapped(state["uv"], state["corners"], state["vertex"])
        return cls(params["differential"], params["texels"], unwrapped, told)

    @classmethod
    def memory(cls, box: Array, options: FitOptions, available: int) -> Sequence[Memory]:
        """Of a texture and its mip map, in float64 where it is drawn."""
        del box
        size = (COPIES + 8) * 4 * 4 * options.resolution * options.resolution
        fits = int(options.resolution * float(np.sqrt(min(1.0, available / (2 * size)))))
        what = f"a texture of {options.resolution} texels along an edge"
        return (Memory("resolution", what, size, f"--resolution {fits} takes half of it"),)

    def state(self) -> dict[str, Array]:
        """The faces in the texture, which no fit changes."""
        flat = self.unwrapped
        return {"uv": flat.uv, "corners": flat.corners, "vertex": flat.vertex}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Raises RangeError unless `state` is that of the same mesh."""
        own = self.state()
        if set(state) != set(own) or not all(np.array_equal(state[k], own[k]) for k in own):
            where, expected = "TexturedSurface.load_state", f"this mesh's {sorted(own)}"
            raise RangeError(message(where, "state", expected, f"{sorted(state)}"))

    def gradient_image(self, gradients: Mapping[str, Array]) -> Array:
        """(H, W) the mean of the texels' channels."""
        mean: Array = gradients["texels"].mean(axis=2)
        return mean

    def stored(self) -> dict[str, Array]:
        """Vertices in meters, the faces in the texture, and its texels."""
        vertices = self.vertices.astype(np.float32)
        return {"vertices": vertices, "rgba": self.rgba().astype(np.float32), **self.state()}

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """Write a .glb file, its texture in it (sRGB, 8 bits), or all arrays to an .npz file."""
        if path.suffix.lower() != ".glb":
            return super().export(path, background)
        flat, pixels = self.unwrapped, np.rint(255 * self.rgba()).astype(np.uint8)
        if not self.has_opacity:
            pixels = np.ascontiguousarray(pixels[..., :3])
        placed = self.vertices.astype(np.float32)[flat.vertex]
        write_glowing_mesh(path, placed, flat.corners, uv=flat.uv, pixels=pixels)
        notes = [f"its texture is radiance: {UNLIT} shows it without lights"]
        if self.has_opacity:
            notes.append("opacity is blended in display values here, in linear ones elsewhere")
        return tuple(notes)

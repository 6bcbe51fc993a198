"""Direct light in a described scene, for captures: the path tracer at two segments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd.capture.camera import Camera
from photograd.lights import SunLight, cap_height
from photograd.scenes.description import SceneDescription, SceneMesh
from photograd.transport.accumulation import Accumulation
from photograd.transport.material import Material
from photograd.transport.path_options import PathOptions
from photograd.transport.scene import Environment, Scene
from photograd.transport.shapes import MeshShape
from photograd.transport.texture import Texture, TextureUse
from photograd.transport.tracer import PathTracer
from photograd.types import Array

Floats = npt.NDArray[np.float32]


def vertex_color_texture(faces: npt.NDArray[np.uint32], colors: Floats) -> tuple[Floats, Floats]:
    """Texture coordinates of each face's corners, and the texture.

    Args:
        faces: (F, 3) numbers of vertices.
        colors: (V, 3) of the vertices.

    Returns:
        uv (3 F, 2), v downwards, of the corners face by face, which share no vertex any more; and
        texels (H, W, 3). Those that continue a plane may lie outside of the colors' range.

    Raises:
        ShapeError: colors that are not (V, 3).
    """
    call = Arguments("vertex_color_texture")
    colors = call.array("colors", colors, ("V", 3), finite=False)
    number = np.arange(len(faces))
    columns = int(np.ceil(np.sqrt(len(faces))))
    rows = -(-len(faces) // columns)
    row, column = 2 * (number // columns), 2 * (number % columns)
    a, b, c = (colors[faces[:, corner]] for corner in range(3))
    texels = np.zeros((2 * rows, 2 * columns, 3), np.float32)
    texels[row, column], texels[row, column + 1] = a, b
    texels[row + 1, column], texels[row + 1, column + 1] = c, b + c - a
    corners = np.stack([column, row], axis=1)[:, None] + np.array([[0, 0], [1, 0], [0, 1]])
    uv = (corners + 0.5) / np.array([2 * columns, 2 * rows])
    return uv.reshape(-1, 2).astype(np.float32), texels


# Direct light in a described scene, for captures: the path tracer at two segments.


TWO_SEGMENTS = PathOptions(max_depth=2, roulette_from=None)
"""From the camera to a surface, and on to a light."""


def lit_scene(description: SceneDescription, camera: Camera) -> Scene:
    """The description's meshes, Lambertian, under its sun and sky; its density is left out.

    Raises:
        SceneError: what a path tracer cannot draw.
    """
    parts = [_drawable(f"mesh {k}", mesh) for k, mesh in enumerate(description.meshes)]
    sun, sky = description.sun, description.sky
    return Scene(
        description.name,
        tuple(shape for shape, _, _ in parts),
        {shape.name: material for shape, material, _ in parts},
        camera,
        Environment(sky.zenith, sky.horizon, sky.ground),
        (SunLight(sun.direction, sun.radiance, cap_height(sun.angular_radius)),),
        {shape.name: texture for shape, _, texture in parts if texture is not None},
    )


class DirectLight:
    """A described scene ready to be photographed: direct light, soft shadows, alpha."""

    def __init__(self, description: SceneDescription) -> None:
        """Build the hierarchy.

        Raises:
            SceneError: a mesh that cannot be traced.
        """
        anywhere = Camera(1, 1, 1.0, 1.0, 0.5, 0.5, np.eye(4))
        scene = lit_scene(description, anywhere)
        # Lights are chosen by the powers that they have when the tracer is built. BSDF sampling
        # finds the sky but hardly ever the sun: a sky that is dark until then leaves nearly all
        # light samples to the sun, and multiple importance sampling accounts for the few others.
        self._tracer = PathTracer(replace(scene, environment=Environment.constant(0.0)))
        sky = description.sky
        self._tracer.params["environment"] = np.array(
            [sky.zenith, sky.horizon, sky.ground], self._tracer.dtype
        )

    def render_view(self, camera: Camera, spp: int, seed: int) -> tuple[Array, Array]:
        """Linear radiance (H, W, 3), premultiplied, and alpha (H, W), as `capture_scene` asks.

        Alpha is the share of the samples whose ray of the camera meets a surface; those that meet
        none are black, whatever they see of the sky. The same seed gives the same bits on any
        number of threads.

        Raises:
            RangeError: spp below 1.
            Error: radiance that is not finite; names the pixel.
        """
        sums = Accumulation.empty(camera.height, camera.width)
        hits = np.zeros((camera.height, camera.width))
        self._tracer.add_samples(
            sums, spp, seed=seed, options=TWO_SEGMENTS, camera=camera, hits=hits
        )
        return sums.mean, hits / spp


def _drawable(name: str, mesh: SceneMesh) -> tuple[MeshShape, Material, Texture | None]:
    if mesh.albedo_kind == "constant":
        shape = MeshShape(name, mesh.vertices, mesh.faces, name)
        return shape, Material("lambert", {"albedo": mesh.albedo}), None
    vertices, faces, uv, texels = mesh.vertices, mesh.faces, mesh.uv, mesh.albedo
    if mesh.albedo_kind == "vertices":
        uv, texels = vertex_color_texture(faces, mesh.albedo)
        vertices = vertices[faces].reshape(-1, 3)
        faces = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)
    white = Material("lambert", {"albedo": np.ones(3)}, {"albedo": TextureUse(name)})
    return MeshShape(name, vertices, faces, name, uv=uv), white, Texture(texels, ("clamp", "clamp"))

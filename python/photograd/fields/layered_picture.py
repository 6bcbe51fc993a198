"""A mesh with a texture of color and opacity as a picture, and the adjoint through all of it.

Transparent faces are drawn by depth peeling [Everitt2001]: layer k of a pixel is the nearest face
behind layer k - 1. With the texture T = (alpha c, alpha), looked up in mip maps at (u, v) of the
pixel and at the level of its footprint, and z its depth, from the last layer on to the first:

    S_k = (T_rgb, alpha, alpha z) + (1 - alpha) C_(k+1)      C_k = antialias(S_k)

C_0 is the picture. With g = d_S_k:

    d_T_rgb = g_rgb     d_alpha = g_3 + z g_4 - <g, C_(k+1)>     d_z = alpha g_4
    d_C_(k+1) = (1 - alpha) g

and d_T goes on to texels, to (u, v) and to the level, these two to the vertices by barycentrics
and footprints. The derivative with respect to the vertices has two parts: what moves inside of
faces, and the weights of the antialiasing at silhouettes [Laine2020]. Which faces a pixel shows in
which order, and how many layers there are, is held.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import numpy.typing as npt
from photograd_course.portable_math import matmul

from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.fields.surface_picture import picture_cotangent
from photograd.raster import (
    Crossings,
    MeshEdges,
    Visibility,
    antialias,
    antialias_backward,
    footprints,
    footprints_backward,
    interpolate,
    interpolate_backward,
    layered_crossings,
    project,
    project_backward,
    rasterize,
    rasterize_backward,
)
from photograd.raster.silhouettes import sums
from photograd.representation import ImageBatch, Outputs
from photograd.textures import (
    build_mips,
    build_mips_backward,
    mip_level,
    mip_level_backward,
    sample_mips,
    sample_mips_backward,
)
from photograd.types import Array, FloatArray


@dataclass(frozen=True, eq=False)
class Unwrapped:
    """Faces whose corners have texture coordinates, and the vertices that these belong to.

    Attributes:
        uv: (T, 2) texture coordinates in [0, 1], v downwards.
        corners: (F, 3) numbers of texture coordinates.
        vertex: (T,) the vertex that has them; one with several lies on a seam.
    """

    uv: FloatArray
    corners: npt.NDArray[np.uint32]
    vertex: npt.NDArray[np.uint32]

    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        """(F, 3) vertex numbers."""
        return self.vertex[self.corners]


@dataclass(frozen=True, eq=False)
class LayeredGradients:
    """dL/d of what a picture was made from, float64."""

    silhouettes: FloatArray  # (V, 3) of positions in homogeneous pixels
    interior: FloatArray  # (V, 3) of the same
    texture: FloatArray  # (h, w, 4)


@dataclass(frozen=True, eq=False)
class _Layer:
    """What one layer shows, where it shows anything: N pixels."""

    visibility: Visibility
    crossings: Crossings
    uv: FloatArray  # (N, 2)
    footprint: FloatArray  # (N, 2, 2)
    level: FloatArray  # (N,)
    texel: FloatArray  # (N, 4)
    over: FloatArray  # (H, W, 5) S_k
    behind: FloatArray  # (H, W, 5) C_(k+1)


@dataclass(frozen=True, eq=False)
class LayeredPicture:
    """A picture, and what its backward pass needs.

    Attributes:
        image: (H, W, 5) color, opacity and depth in meters, the first and the last premultiplied.
        vertices: (V, 3) in the world, meters.
        local: (V, 3) in the frame of the camera.
        positions: (V, 3) homogeneous pixels.
        camera: at the origin.
        pose: (3, 4) camera_from_world.
        edges: of the faces.
        unwrapped: the faces in the texture.
        mips: of the texture.
        layers: from the nearest on.
    """

    image: FloatArray
    vertices: FloatArray
    local: FloatArray
    positions: FloatArray
    camera: Camera
    pose: FloatArray
    edges: MeshEdges
    unwrapped: Unwrapped
    mips: list[Array]
    layers: tuple[_Layer, ...]

    @classmethod
    def of(
        cls,
        vertices: FloatArray,
        texture: FloatArray,
        unwrapped: Unwrapped,
        edges: MeshEdges,
        batch: ImageBatch,
        max_layers: int,
    ) -> Self:
        """Draw a mesh.

        Args:
            vertices: (V, 3) in the world, meters.
            texture: (h, w, 4) premultiplied color and opacity.
            unwrapped: the faces in the texture.
            edges: of the faces.
            batch: the camera.
            max_layers: what lies behind so many faces is not seen.
        """
        pose = batch.camera_from_world
        if pose is None:
            pose = invert_rigid(batch.camera.world_from_camera)[:3]
        pose = np.asarray(pose, np.float64)
        camera = replace(batch.camera, world_from_camera=np.eye(4))
        local = matmul(vertices, pose[:, :3].T) + pose[:, 3]
        positions, mips = project(local, camera), build_mips(texture)
        size = (camera.height, camera.width)
        visible = _peeled(positions, unwrapped.faces, size, max_layers)
        crossings = layered_crossings(positions, unwrapped.faces, visible, edges)
        below, layers = np.zeros((*size, 5)), []
        for visibility, crossed in zip(reversed(visible), reversed(crossings), strict=True):
            layer = _shaded(visibility, crossed, positions, unwrapped, mips, below)
            layers.append(layer)
            below = antialias(layer.over, crossed)
        drawn = vertices, local, positions, camera, pose, edges, unwrapped, mips
        return cls(below, *drawn, tuple(reversed(layers)))

    def cotangent(self, d_outputs: Outputs) -> FloatArray:
        """dL/d `image`, as `picture_cotangent` has it.

        Args:
            d_outputs: dL/d outputs of the pixels.
        """
        height, width = self.image.shape[:2]
        return picture_cotangent(d_outputs, height, width)

    @property
    def shown(self) -> Array:
        """Numbers of the faces that pixels show, in any layer."""
        layers = [layer.visibility for layer in self.layers]
        return np.unique(np.concatenate([each.face[each.covered] for each in layers]))

    def position_gradients(self, d_image: FloatArray) -> LayeredGradients:
        """The parts of the adjoint.

        Args:
            d_image: (H, W, 5) dL/d of `image`.
        """
        silhouettes, interior = np.zeros_like(self.positions), np.zeros_like(self.positions)
        d_mips = [np.zeros_like(level) for level in self.mips]
        for layer in self.layers:
            g, d_edges = antialias_backward(
                layer.over, layer.crossings, d_image, self.positions, self.edges
            )
            silhouettes += d_edges
            interior += self._layer_backward(layer, g, d_mips)
            alpha = np.zeros(g.shape[:2])
            alpha[layer.visibility.covered] = layer.texel[:, 3]
            d_image = (1 - alpha[..., None]) * g
        return LayeredGradients(silhouettes, interior, build_mips_backward(d_mips))

    def pose_gradients(self, d_positions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """dL/dvertices (V, 3) and dL/d camera_from_world (3, 4).

        Args:
            d_positions: (V, 3) dL/d of the positions in homogeneous pixels.
        """
        d_local = project_backward(self.local, self.camera, d_positions).vertices
        d_turn = np.einsum("vi,vj->ij", d_local, self.vertices)
        d_pose = np.concatenate([d_turn, d_local.sum(axis=0)[:, None]], axis=1)
        return matmul(d_local, self.pose[:, :3]), d_pose

    def _layer_backward(
        self, layer: _Layer, d_over: FloatArray, d_mips: list[FloatArray]
    ) -> FloatArray:
        """dL/dpositions (V, 3) inside of the faces of a layer; adds to `d_mips`."""
        shown, visibility, flat = layer.visibility.covered, layer.visibility, self.unwrapped
        g, depth = d_over[shown], layer.visibility.depth[layer.visibility.covered]
        d_alpha = g[:, 3] + depth * g[:, 4] - (g * layer.behind[shown]).sum(axis=1)
        d_texel = np.concatenate([g[:, :3], d_alpha[:, None]], axis=1)
        d_levels, d_uv, d_level = sample_mips_backward(self.mips, layer.uv, layer.level, d_texel)
        for k, part in enumerate(d_levels):
            d_mips[k] += part
        d_uv_map, d_footprints = np.zeros((*shown.shape, 2)), np.zeros((*shown.shape, 2, 2))
        d_uv_map[shown] = d_uv
        d_footprints[shown] = mip_level_backward(self.mips[0].shape, layer.footprint, d_level)
        _, d_barycentrics = interpolate_backward(flat.uv, flat.corners, visibility, d_uv_map)
        placed = self.positions[flat.vertex]
        _, d_uv_mapd = footprints_backward(flat.uv, placed, flat.corners, visibility, d_footprints)
        d_depth = np.zeros(shown.shape)
        d_depth[shown] = layer.texel[:, 3] * g[:, 4]
        found: FloatArray = rasterize_backward(
            self.positions, flat.faces, visibility, d_barycentrics, d_depth
        )
        return found + sums(flat.vertex.astype(np.int64), d_uv_mapd, len(found))


def _peeled(
    positions: FloatArray, faces: Array, size: tuple[int, int], max_layers: int
) -> list[Visibility]:
    """At least one layer, then as long as one shows anything."""
    layers = [rasterize(positions, faces, size)]
    while len(layers) < max_layers:
        behind = rasterize(positions, faces, size, behind=layers[-1].depth)
        if not behind.covered.any():
            break
        layers.append(behind)
    return layers


def _shaded(
    visibility: Visibility,
    crossings: Crossings,
    positions: FloatArray,
    flat: Unwrapped,
    mips: list[Array],
    behind: FloatArray,
) -> _Layer:
    shown = visibility.covered
    uv = interpolate(flat.uv, flat.corners, visibility)[shown]
    footprint = footprints(flat.uv, positions[flat.vertex], flat.corners, visibility)[shown]
    level = mip_level(mips[0].shape, footprint)
    texel = sample_mips(mips, uv, level)
    over = behind.copy()
    alpha, depth = texel[:, 3:], visibility.depth[shown][:, None]
    over[shown] = np.concatenate([texel, alpha * depth], axis=1) + (1 - alpha) * behind[shown]
    return _Layer(visibility, crossings, uv, footprint, level, texel, over, behind)

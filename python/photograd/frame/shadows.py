"""Shadow maps: depths that a light sees, compared with those of the points that are lit.

A light that shines to all sides has six views, a spot one, and parallel light one from very far
away. Comparisons are averaged over neighboring texels, percentage-closer filtering
[Williams1978; Reeves1987]; what is compared is never blurred depth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd._arrays import Arguments
from photograd._checks import require_types
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.errors import ShapeError, message
from photograd.frame.gbuffer import draw_surfaces
from photograd.frame.scene import KINDS, FrameScene
from photograd.types import Array, FloatArray


@typed_call
@dataclass(frozen=True)
class ShadowSettings:
    """How shadows are looked up.

    Attributes:
        size: texels along a side of a map.
        filter_radius: texels; comparisons with (2 filter_radius + 1)^2 of them are averaged.
        depth_bias: meters by which a point may lie behind the map's depth and still be lit.
        normal_bias: texels by which a point is moved along its normal before the comparison. Too
            little of either shades lit surfaces in stripes, too much detaches shadows.

    Raises:
        DtypeError, RangeError: no numbers, or out of range.
    """

    size: int = 1024
    filter_radius: int = 1
    depth_bias: float = 0.0
    normal_bias: float = 1.5

    def __post_init__(self) -> None:
        require_types(self)
        call = Arguments("ShadowSettings")
        call.integer("size", self.size, low=1, high=16384)
        call.integer("filter_radius", self.filter_radius, low=0, high=16)
        call.number("depth_bias", self.depth_bias, low=-1e6, high=1e6)
        call.number("normal_bias", self.normal_bias, low=0.0, high=1e3)


SHADOW_DEFAULTS = ShadowSettings()


@typed_call
@dataclass(frozen=True, eq=False)
class ShadowMap:
    """What a light sees.

    Attributes:
        cameras: its views.
        depths: (K, S, S) float64, of each view; infinite where it sees nothing.
    """

    cameras: tuple[Camera, ...]
    depths: FloatArray


@typed_call
def draw_shadow_map(scene: FrameScene, cameras: tuple[Camera, ...]) -> ShadowMap:
    """Draw what covers what is behind it, from the views of a light: glass, too, as for paths.

    Faces that cover only a part cast no shadow.

    Args:
        scene: whose shadows these are.
        cameras: square views of one size.

    Raises:
        RangeError, ShapeError: no view, or views of several sizes.
    """
    call = Arguments("draw_shadow_map")
    call.integer("len(cameras)", len(cameras), low=1, high=6)
    sizes = {(camera.height, camera.width) for camera in cameras}
    if len(sizes) > 1:
        got = ", ".join(f"{height} x {width}" for height, width in sorted(sizes))
        raise ShapeError(message("draw_shadow_map", "cameras", "views of one size", got))
    kinds = ("opaque", "mask", "glass")
    if (scene.kind == KINDS.index("mask")).any():
        depths = np.stack([draw_surfaces(scene, camera, *kinds)[0].depth for camera in cameras])
    else:
        depths = np.empty((len(cameras), *sizes.pop()))
        for camera, depth in zip(cameras, depths, strict=True):
            scene.draw_depth(camera, depth, *kinds)
    call.array("depths", depths, ("K", "S", "S"), finite=False)
    return ShadowMap(cameras, depths)


@typed_call
def look_up_shadow(
    shadow: ShadowMap, points: Array, normals: Array, settings: ShadowSettings = SHADOW_DEFAULTS
) -> Array:
    """The part of a light that reaches points.

    Args:
        shadow: of the light.
        points: (N, 3) in the world, meters.
        normals: (N, 3) unit, towards the side that is looked at.
        settings: of the comparison.

    Returns:
        (N,) from 0 to 1, of the dtype of `points`; 1 where no view of the light looks.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes.
    """
    call = Arguments("look_up_shadow")
    points = call.array("points", points, ("N", 3))
    normals = call.array("normals", normals, ("N", 3))
    visibility = np.empty(len(points), points.dtype)
    call.run(
        _core.shadow_lookup,
        shadow.depths,
        np.stack([_pixels_from_world(camera) for camera in shadow.cameras]),
        settings.filter_radius,
        settings.depth_bias,
        settings.normal_bias,
        1.0 / shadow.cameras[0].fx,
        points,
        normals,
        visibility,
    )
    return visibility


def _pixels_from_world(camera: Camera) -> FloatArray:
    """(3, 4), of `photograd.raster.project`."""
    pose = invert_rigid(camera.world_from_camera)[:3]
    rows = [camera.fx * pose[0] + camera.cx * pose[2], camera.fy * pose[1] + camera.cy * pose[2]]
    return np.stack([*rows, pose[2]])


CUBE = ((0, 1), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1))
"""(axis, sign) of the views of a cube."""


def cube_views(position: Array, size: int) -> tuple[Camera, ...]:
    """Six views of 90 degrees and two texels, which overlap so that filters find their neighbors.

    Args:
        position: (3,) in the world.
        size: texels along a side.
    """
    focal = 0.5 * size * size / (size + 2.0)
    return tuple(_view(position, sign * np.eye(3)[axis], size, focal) for axis, sign in CUBE)


def cone_view(position: Array, axis: Array, cosine: float, size: int) -> Camera:
    """The view of a cone with the cosine of half its angle, which has to be above 0.

    Args:
        position, axis: (3,) each, in the world.
        cosine: between the axis and the rim.
        size: texels along a side.
    """
    tangent = np.sqrt(max(1.0 - cosine * cosine, 1e-12)) / cosine
    return _view(position, axis, size, 0.5 * size * size / ((size + 2.0) * tangent))


FAR = 1e4
"""Distance of a directional light's view, in radii of the scene."""


def parallel_view(direction: Array, center: Array, radius: float, size: int) -> Camera:
    """A view along parallel light, as of a camera that is 10^4 radii away.

    Its rays differ from parallel ones by 10^-4 radians, a tenth of a texel of 1024 at most.

    Args:
        direction: (3,) unit, towards the light.
        center, radius: of the sphere that is seen whole.
        size: texels along a side.
    """
    distance = FAR * radius
    position = np.asarray(center) + distance * np.asarray(direction)
    return _view(position, -np.asarray(direction), size, 0.5 * (size - 2.0) * FAR)


def _view(position: Array, forward: Array, size: int, focal: float) -> Camera:
    forward = np.asarray(forward, np.float64) / np.linalg.norm(forward)
    side = np.eye(3)[int(np.argmin(np.abs(forward)))]
    right = np.cross(forward, side)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = right, np.cross(forward, right), forward
    pose[:3, 3] = position
    half = 0.5 * size
    return Camera(size, size, focal, focal, half, half, pose)

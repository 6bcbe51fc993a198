"""Camera paths: through the cameras of a capture, and from a file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from photograd._arrays import Arguments
from photograd._json_node import JsonNode, read_json
from photograd.capture.camera import Camera
from photograd.capture.frames import (
    OPENGL_FROM_OPENCV,
    Y_UP_FROM_Z_UP,
    check_pose,
    quaternion_from_rotation,
    rotation_from_quaternion,
)
from photograd.capture.intrinsics import read_intrinsics
from photograd.errors import RangeError, message
from photograd.types import FloatArray

_READER = "read_camera_path"


def resized_camera(camera: Camera, width: int, height: int) -> Camera:
    """The camera with a picture of another size that is as high: its vertical angle of view stays.

    A wider picture shows more at the sides. Pixels stay square if they are, and the principal point
    stays where it is in height, and in the middle if it is there.

    Args:
        camera: to be changed.
        width: in pixels.
        height: in pixels.

    Raises:
        RangeError: what `Camera` raises.
    """
    scale = height / camera.height
    aside = camera.cx - 0.5 * camera.width
    return replace(
        camera,
        width=width,
        height=height,
        fx=camera.fx * scale,
        fy=camera.fy * scale,
        cx=0.5 * width + aside * scale,
        cy=camera.cy * scale,
    )


def interpolate_cameras(cameras: Sequence[Camera], count: int) -> list[Camera]:
    """`count` cameras on a smooth path through others, in their order, with the first one's size.

    Positions follow cubic Hermite segments whose tangents are half the step between the neighbors
    (Catmull-Rom), turns the shorter arc between unit quaternions [Shoemake1985], focal lengths the
    line between their logarithms. The first and the last camera are on the path; the others are if
    their number less one divides `count` less one.

    Args:
        cameras: at least one.
        count: of cameras on the path, at least 1.

    Raises:
        RangeError: no cameras, or a count below 1.
    """
    count = Arguments("interpolate_cameras").integer("count", count, low=1)
    if not cameras:
        raise RangeError(message("interpolate_cameras", "cameras", "at least one camera", "none"))
    size = cameras[0].width, cameras[0].height
    fitted = [resized_camera(camera, *size) for camera in cameras]
    quats = _quaternions(fitted)
    path = []
    for along in np.linspace(0.0, len(fitted) - 1.0, count):
        k = min(int(along), max(len(fitted) - 2, 0))
        after, u = min(k + 1, len(fitted) - 1), float(along) - k
        pose = np.eye(4)
        pose[:3, :3] = rotation_from_quaternion(_slerp(quats[k], quats[after], u))
        pose[:3, 3] = _catmull_rom([camera.position for camera in fitted], k, u)
        a, b = fitted[k], fitted[after]
        path.append(
            replace(
                a,
                fx=a.fx ** (1 - u) * b.fx**u,
                fy=a.fy ** (1 - u) * b.fy**u,
                cx=(1 - u) * a.cx + u * b.cx,
                cy=(1 - u) * a.cy + u * b.cy,
                world_from_camera=pose,
            )
        )
    return path


def _quaternions(cameras: Sequence[Camera]) -> list[FloatArray]:
    """Unit quaternions of the poses, each on the side of the one before it."""
    found: list[FloatArray] = []
    for camera in cameras:
        q = quaternion_from_rotation(camera.world_from_camera[:3, :3])
        found.append(-q if found and float((q * found[-1]).sum()) < 0 else q)
    return found


def _slerp(a: FloatArray, b: FloatArray, u: float) -> FloatArray:
    angle = math.acos(min(float((a * b).sum()), 1.0))
    if angle < 1e-6:
        return (1 - u) * a + u * b
    turned: FloatArray = (math.sin((1 - u) * angle) * a + math.sin(u * angle) * b) / math.sin(angle)
    return turned


def _catmull_rom(points: Sequence[FloatArray], k: int, u: float) -> FloatArray:
    """The point at u of segment k; at the ends the tangent is the step to the only neighbor."""
    last = len(points) - 1
    a, b = points[k], points[min(k + 1, last)]
    before = points[k - 1] if k > 0 else 2 * a - b
    after = points[k + 2] if k + 2 <= last else 2 * b - a
    m, n = 0.5 * (b - before), 0.5 * (after - a)
    point: FloatArray = (
        (1 + 2 * u) * (1 - u) ** 2 * a
        + u * (1 - u) ** 2 * m
        + u * u * (3 - 2 * u) * b
        + u * u * (u - 1) * n
    )
    return point


# Camera paths from files.


def read_camera_path(path: Path, size: tuple[int, int]) -> list[Camera]:
    """The cameras of a JSON file, in its order, in the world of the project (+Y up).

    Either a transforms.json, whose frames need no images, or a camera path as the viewer of
    nerfstudio saves it ("camera_path"). Both have OpenGL cameras in a world with +Z up.

    Args:
        path: the file.
        size: (width, height) in pixels, of cameras for which the file does not say it.

    Raises:
        IoError: no file, or one that is none of these.
        RangeError, ShapeError, SceneError: numbers that make no camera; names the frame.
    """
    root = read_json(_READER, path)
    if "camera_path" in root:
        cameras = [_path_camera(root, node, size) for node in root["camera_path"].items()]
    else:
        cameras = [_frame_camera(root, node, size) for node in root["frames"].items()]
    if not cameras:
        raise RangeError(message(_READER, f"{path}", "at least one camera", "none"))
    return cameras


def _frame_camera(root: JsonNode, node: JsonNode, size: tuple[int, int]) -> Camera:
    """A frame of a transforms.json; its lens is left aside."""
    lens = read_intrinsics(root, node, size)
    matrix = node["transform_matrix"].numbers((4, 4), (3, 4))
    return Camera(*lens.size, *lens.pixels, _pose(f"{node.where}: transform_matrix", matrix))


def _path_camera(root: JsonNode, node: JsonNode, size: tuple[int, int]) -> Camera:
    """A camera of nerfstudio's viewer: 16 numbers row by row, the vertical angle in degrees."""
    width = root["render_width"].count() if "render_width" in root else size[0]
    height = root["render_height"].count() if "render_height" in root else size[1]
    matrix = node["camera_to_world"].numbers((16,)).reshape(4, 4)
    angle = node["fov"].number()
    if not 1e-3 < angle < 179.0:
        expected = "an angle of view in degrees, above 0.001 and below 179"
        raise RangeError(message(_READER, f"{node.where}: fov", expected, angle))
    focal = 0.5 * height / math.tan(0.5 * math.radians(angle))
    pose = _pose(f"{node.where}: camera_to_world", matrix)
    return Camera(width, height, focal, focal, 0.5 * width, 0.5 * height, pose)


def _pose(where: str, matrix: FloatArray) -> FloatArray:
    pose: FloatArray = Y_UP_FROM_Z_UP @ check_pose(_READER, where, matrix) @ OPENGL_FROM_OPENCV
    return pose

"""Captures reconstructed by OpenSfM: reconstruction.json and a folder of photographs.

Rotation is an axis-angle vector, with the translation it makes camera_from_world in OpenCV axes.
The world is east, north, up. Focal lengths are in units of the longer side of the image and image
coordinates start in its middle, so that one file serves any resolution.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from photograd._json_node import JsonNode, read_json
from photograd.capture.assemble import (
    Photograph,
    find_photograph,
    kind_of_images,
    make_camera,
    make_capture,
    transform_points,
    undistortion_lines,
)
from photograd.capture.capture import Capture, hold_out
from photograd.capture.convention import check_convention
from photograd.capture.frames import (
    Y_UP_FROM_Z_UP,
    check_pose,
    invert_rigid,
    rotation_from_axis_angle,
)
from photograd.capture.undistort import Distortion
from photograd.capture.view import View
from photograd.errors import IoError, SceneError, message
from photograd.types import FloatArray

_NAME = "load_opensfm"


def load_opensfm(path: Path, *, trust_poses: bool = False, allow_outside: bool = False) -> Capture:
    """Read the largest reconstruction of a file; its photographs lie in images/ beside it.

    Args:
        path: the JSON file.
        trust_poses: do not ask whether the poses look like another convention.
        allow_outside: also photographs that lie outside of images/.

    Raises:
        IoError, RangeError, ShapeError, SceneError: names the shot or camera at fault.
    """
    parts = read_json(_NAME, path).items()
    if not parts:
        raise IoError(message(_NAME, path.name, "at least one reconstruction", "none"))
    root = max(parts, key=lambda part: len(list(part["shots"].members())))
    image_folder = path.parent / "images"
    if not image_folder.is_dir():
        raise IoError(message(_NAME, str(path.parent), "a folder 'images'", "none"))
    shots = list(root["shots"].members())
    pairs = [
        _read_shot(root, name, shot, image_folder, allow_outside=allow_outside)
        for name, shot in shots
    ]
    images = kind_of_images(_NAME, [photograph for _, photograph in pairs])
    views = [view.transformed(Y_UP_FROM_Z_UP) for view, _ in pairs]
    lines = [
        "camera_from_world -> world_from_camera, OpenCV camera kept",
        "+Z up (east, north, up) -> +Y up",
        *undistortion_lines(views),
    ]
    if len(parts) > 1:
        lines.append(f"largest of {len(parts)} reconstructions taken")
    if not trust_poses:
        lines.extend(check_convention(_NAME, views, Y_UP_FROM_Z_UP, up_is_known=True))
    capture = make_capture("opensfm", path, hold_out(views), images, Y_UP_FROM_Z_UP, lines)
    points, colors = _read_points(root)
    return replace(capture, points=points, point_colors=colors)


def _read_shot(
    root: JsonNode, name: str, shot: JsonNode, folder: Path, *, allow_outside: bool
) -> tuple[View, Photograph]:
    """One view, still in the file's world."""
    frame = f"shot '{name}'"
    photograph = find_photograph(_NAME, frame, folder, name, allow_outside=allow_outside)
    size = (photograph.header.width, photograph.header.height)
    camera_from_world = np.eye(4)
    camera_from_world[:3, :3] = rotation_from_axis_angle(shot["rotation"].numbers((3,)))
    camera_from_world[:3, 3] = shot["translation"].numbers((3,))
    pose = invert_rigid(check_pose(_NAME, f"{frame}: rotation", camera_from_world))
    calibration = root["cameras"][shot["camera"].text()]
    declared = (calibration["width"].count(), calibration["height"].count())
    if abs(size[0] * declared[1] / (size[1] * declared[0]) - 1.0) > 0.01:
        expected = f"an image in the ratio {declared[0]} x {declared[1]}"
        raise IoError(message(_NAME, frame, expected, f"{size[0]} x {size[1]}"))
    pixels, distortion = _lens(calibration, size)
    camera = make_camera(_NAME, frame, size, pixels, pose)
    space = photograph.header.color_space
    return View(name, camera, photograph.file, space, distortion, source_size=size), photograph


def _lens(
    node: JsonNode, size: tuple[int, int]
) -> tuple[tuple[float, float, float, float], Distortion | None]:
    """(fx, fy, cx, cy) in pixels of an image of `size`, and the lens."""

    def number(key: str) -> float:
        return node[key].number() if key in node else 0.0

    longer = max(size)
    kind = node["projection_type"].text()
    if kind == "perspective":
        focal_x = focal_y = node["focal"].number()
    elif kind == "brown":
        focal_x, focal_y = node["focal_x"].number(), node["focal_y"].number()
        if number("k3") != 0.0:
            remedy = "undistort the images first"
            raise SceneError(message(_NAME, f"{node.where}: k3", 0, number("k3"), remedy))
    else:
        raise IoError(message(_NAME, node["projection_type"].where, "perspective or brown", kind))
    distortion = Distortion(number("k1"), number("k2"), number("p1"), number("p2"))
    center_x, center_y = number("c_x") * longer, number("c_y") * longer
    pixels = (
        focal_x * longer,
        focal_y * longer,
        0.5 * size[0] + center_x,
        0.5 * size[1] + center_y,
    )
    return pixels, None if distortion.is_identity else distortion


def _read_points(root: JsonNode) -> tuple[FloatArray | None, npt.NDArray[np.uint8] | None]:
    nodes = [node for _, node in root["points"].members()] if "points" in root else []
    if not nodes:
        return None, None
    positions = np.array([node["coordinates"].numbers((3,)) for node in nodes])
    colors = np.array([node["color"].numbers((3,)) for node in nodes])
    return transform_points(Y_UP_FROM_Z_UP, positions), colors.clip(0.0, 255.0).astype(np.uint8)

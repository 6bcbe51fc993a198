"""Cameras for other programs: transforms.json of nerfstudio, and COLMAP models, text and binary.

Photographs are neither copied nor changed: what is written describes the pixels of their files,
lens included. transforms.json has OpenGL cameras in a world with +Z up. A COLMAP model has OpenCV
cameras; its world here has +y down, half a turn about x from ours, as splats that are fitted to it
expect [Schoenberger2016].
"""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any, Literal

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.colmap_model import MODELS
from photograd.capture.frames import (
    OPENGL_FROM_OPENCV,
    Y_UP_FROM_Z_UP,
    invert_rigid,
    quaternion_from_rotation,
)
from photograd.capture.undistort import ColmapLens, Distortion, FisheyeDistortion
from photograd.capture.view import View
from photograd.errors import IoError, SceneError, message
from photograd.types import FloatArray

_JSON, _COLMAP = "write_transforms", "write_colmap"
Form = Literal["binary", "text"]
Y_DOWN_FROM_Y_UP: FloatArray = np.diag([1.0, -1.0, -1.0, 1.0])
"""Half a turn about x, its own inverse."""
_NO_COLOR = (128, 128, 128)


def write_transforms(path: Path, capture: Capture) -> tuple[str, ...]:
    """Write all views of a capture, with its split, as nerfstudio's transforms.json.

    Args:
        path: the file, ends in .json; images are named relative to its folder. Points go into a
            .ply file beside it.
        capture: whose photographs are files.

    Returns:
        What the reader must know, one sentence each.

    Raises:
        IoError: another end of the name, or a file that cannot be written.
        SceneError: a view that is no file, or a lens that the format does not know.
    """
    if path.suffix.lower() != ".json":
        raise IoError(message(_JSON, "path", "a name that ends in .json", path.name))
    frames = [_frame(view, path.parent) for view in capture.views]
    content: dict[str, Any] = {"camera_model": _common_model(capture.views), "frames": frames}
    names = {
        view.name: frame["file_path"] for view, frame in zip(capture.views, frames, strict=True)
    }
    for split in ("train", "val", "test"):
        views: Sequence[View] = getattr(capture, split)
        content[f"{split}_filenames"] = [names[view.name] for view in views]
    if capture.points is not None:
        points = path.with_name(f"{path.stem}_points.ply")
        atomic_write(points, _points_ply(capture))
        content["ply_file_path"] = points.name
    atomic_write(path, json.dumps(content, indent=1).encode("utf-8"))
    told = ["+Y up -> +Z up, OpenCV camera -> OpenGL"]
    if any(frame["file_path"].startswith("..") for frame in frames):
        told.append("photographs lie outside of the file's folder: readers may ask for trust")
    return tuple(told)


def _frame(view: View, folder: Path) -> dict[str, Any]:
    camera = view.source_camera()
    turned = invert_rigid(Y_UP_FROM_Z_UP) @ camera.world_from_camera @ OPENGL_FROM_OPENCV
    entry: dict[str, Any] = {
        "file_path": _relative(_JSON, view, folder),
        "w": camera.width,
        "h": camera.height,
        "fl_x": camera.fx,
        "fl_y": camera.fy,
        "cx": camera.cx,
        "cy": camera.cy,
        "transform_matrix": turned.tolist(),
    }
    lens = view.distortion
    if isinstance(lens, ColmapLens):
        remedy = "write a COLMAP model instead"
        expected = "a lens of k1, k2, p1, p2 or OPENCV_FISHEYE"
        raise SceneError(message(_JSON, f"view '{view.name}'", expected, lens.model, remedy))
    if isinstance(lens, FisheyeDistortion):
        entry |= dict(zip(("k1", "k2", "k3", "k4"), astuple(lens), strict=True))
    elif isinstance(lens, Distortion):
        entry |= dict(zip(("k1", "k2", "p1", "p2"), astuple(lens), strict=True))
    if view.mask_file is not None:
        entry["mask_path"] = Path(os.path.relpath(view.mask_file, folder)).as_posix()
    return entry


def _common_model(views: Sequence[View]) -> str:
    """The camera model of the file, which has one for all frames."""
    fisheye = [isinstance(view.distortion, FisheyeDistortion) for view in views]
    if any(fisheye) and not all(fisheye):
        expected, got = "one kind of lens", "fisheye lenses and others"
        raise SceneError(message(_JSON, "capture", expected, got, "write a COLMAP model instead"))
    return "OPENCV_FISHEYE" if any(fisheye) else "OPENCV"


def _relative(function: str, view: View, folder: Path) -> str:
    """The name of a view's file, relative to a folder, with slashes."""
    if not isinstance(view.image, Path):
        got = "pixels in memory"
        remedy = "write_blender_capture writes them"
        raise SceneError(message(function, f"view '{view.name}'", "a file", got, remedy))
    return Path(os.path.relpath(view.image.resolve(), folder.resolve())).as_posix()


def _points_ply(capture: Capture) -> bytes:
    """Colored points in the world of the file."""
    assert capture.points is not None
    rotation = invert_rigid(Y_UP_FROM_Z_UP)[:3, :3]
    rows = np.zeros(len(capture.points), [("xyz", "<f4", 3), ("rgb", "u1", 3)])
    rows["xyz"] = capture.points @ rotation.T
    rows["rgb"] = _NO_COLOR if capture.point_colors is None else capture.point_colors
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}"]
    lines += [f"property float {name}" for name in "xyz"]
    lines += [f"property uchar {name}" for name in ("red", "green", "blue")]
    return "\n".join([*lines, "end_header\n"]).encode("ascii") + rows.tobytes()


# COLMAP models.


def write_colmap(folder: Path, capture: Capture, *, form: Form = "binary") -> tuple[str, ...]:
    """Write all views and points of a capture as a COLMAP model in `folder`/sparse/0.

    Args:
        folder: to write in; made if it is missing.
        capture: whose photographs are files.
        form: of the model's files, "binary" or "text".

    Returns:
        What the reader must know, one sentence each.

    Raises:
        IoError: a file that cannot be written.
        SceneError: a view that is no file.
    """
    views = capture.views
    home = _common_folder(views)
    cameras, numbers = _distinct_cameras(views)
    images = [
        (_relative(_COLMAP, view, home), number, *_colmap_pose(view.source_camera()))
        for view, number in zip(views, numbers, strict=True)
    ]
    none = np.zeros((0, 3))
    points = none if capture.points is None else capture.points @ Y_DOWN_FROM_Y_UP[:3, :3].T
    colors = capture.point_colors
    colors = np.full((len(points), 3), _NO_COLOR, np.uint8) if colors is None else colors
    files = (_binary if form == "binary" else _text)(cameras, images, points, colors)
    target = folder / "sparse" / "0"
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as failure:
        got = failure.strerror or str(failure)
        raise IoError(message(_COLMAP, f"{target}", "a folder to write in", got)) from failure
    for name, content in files.items():
        atomic_write(target / name, content)
    return (
        "+Y up -> +y down, as COLMAP's models have it",
        f"photographs are named as in {home}: link or copy it to {folder / 'images'}",
    )


_Camera = tuple[str, int, int, tuple[float, ...]]
_Image = tuple[str, int, FloatArray, FloatArray]


def _common_folder(views: Sequence[View]) -> Path:
    """The deepest folder that holds all photographs."""
    names = [_relative(_COLMAP, view, Path.cwd()) for view in views]
    folders = [str((Path.cwd() / name).resolve().parent) for name in names]
    return Path(os.path.commonpath(folders))


def _distinct_cameras(views: Sequence[View]) -> tuple[list[_Camera], list[int]]:
    """Cameras that differ, and the number (from 1) of each view's."""
    cameras: list[_Camera] = []
    numbers = []
    for view in views:
        camera = _colmap_camera(view)
        if camera not in cameras:
            cameras.append(camera)
        numbers.append(cameras.index(camera) + 1)
    return cameras, numbers


def _colmap_camera(view: View) -> _Camera:
    camera, lens = view.source_camera(), view.distortion
    pinhole = (camera.fx, camera.fy, camera.cx, camera.cy)
    if isinstance(lens, ColmapLens):
        return lens.model, camera.width, camera.height, tuple(lens.parameters)
    if isinstance(lens, FisheyeDistortion):
        return "OPENCV_FISHEYE", camera.width, camera.height, (*pinhole, *astuple(lens))
    if isinstance(lens, Distortion):
        return "OPENCV", camera.width, camera.height, (*pinhole, *astuple(lens))
    return "PINHOLE", camera.width, camera.height, pinhole


def _colmap_pose(camera: Camera) -> tuple[FloatArray, FloatArray]:
    """Quaternion (w, x, y, z) and translation of camera_from_world, the world with +y down."""
    camera_from_world = invert_rigid(Y_DOWN_FROM_Y_UP @ camera.world_from_camera)
    return quaternion_from_rotation(camera_from_world[:3, :3]), camera_from_world[:3, 3]


def _text(
    cameras: Sequence[_Camera], images: Sequence[_Image], points: FloatArray, colors: Any
) -> dict[str, bytes]:
    """The three files; an image has a line for its pose and one, empty, for what it observes."""
    rows = {"cameras.txt": ["# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]"]}
    for number, (model, width, height, numbers) in enumerate(cameras, 1):
        listed = " ".join(map(repr, map(float, numbers)))
        rows["cameras.txt"].append(f"{number} {model} {width} {height} {listed}")
    rows["images.txt"] = ["# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME"]
    for number, (name, camera, quaternion, translation) in enumerate(images, 1):
        listed = " ".join(map(repr, [*quaternion.tolist(), *translation.tolist()]))
        rows["images.txt"] += [f"{number} {listed} {camera} {name}", ""]
    rows["points3D.txt"] = ["# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]"]
    for number, (point, color) in enumerate(zip(points.tolist(), colors.tolist(), strict=True), 1):
        listed = " ".join([*map(repr, point), *map(str, color)])
        rows["points3D.txt"].append(f"{number} {listed} 0")
    return {name: ("\n".join(lines) + "\n").encode("utf-8") for name, lines in rows.items()}


def _binary(
    cameras: Sequence[_Camera], images: Sequence[_Image], points: FloatArray, colors: Any
) -> dict[str, bytes]:
    """The same in the binary form of `colmap_model`."""
    numbers = {name: number for number, (name, _) in enumerate(MODELS)}
    parts: dict[str, list[bytes]] = {
        name: [] for name in ("cameras.bin", "images.bin", "points3D.bin")
    }
    parts["cameras.bin"].append(struct.pack("<Q", len(cameras)))
    for number, (model, width, height, values) in enumerate(cameras, 1):
        head = struct.pack("<iiQQ", number, numbers[model], width, height)
        parts["cameras.bin"].append(head + struct.pack(f"<{len(values)}d", *values))
    parts["images.bin"].append(struct.pack("<Q", len(images)))
    for number, (name, camera, quaternion, translation) in enumerate(images, 1):
        head = struct.pack("<i7di", number, *quaternion, *translation, camera)
        parts["images.bin"].append(head + name.encode("utf-8") + b"\0" + struct.pack("<Q", 0))
    rows = np.zeros(
        len(points),
        [("id", "<u8"), ("xyz", "<f8", 3), ("rgb", "u1", 3), ("error", "<f8"), ("seen", "<u8")],
    )
    rows["id"], rows["xyz"], rows["rgb"] = np.arange(len(points)) + 1, points, colors
    parts["points3D.bin"] = [struct.pack("<Q", len(points)), rows.tobytes()]
    return {name: b"".join(content) for name, content in parts.items()}

"""Forward-facing captures with poses_bounds.npy [Mildenhall2019].

One row of 17 numbers an image: a (3, 5) matrix, row by row, whose first three columns are the
camera's axes (down, right, backwards) in the world, the fourth its position, the fifth (height,
width, focal length); then the nearest and farthest depth. Images belong to rows in the order of
their names.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from photograd._arrays import Arguments
from photograd._files import read_npy
from photograd.capture.assemble import (
    Photograph,
    check_same_size,
    kind_of_images,
    list_images,
    make_camera,
    make_capture,
)
from photograd.capture.capture import Capture, hold_out
from photograd.capture.convention import check_convention
from photograd.capture.frames import check_pose, world_from_estimated_up
from photograd.capture.view import View
from photograd.errors import IoError, RangeError, message
from photograd.images.read import read_header
from photograd.types import FloatArray

_NAME = "load_llff"


def load_llff(folder: Path, *, trust_poses: bool = False) -> Capture:
    """Read poses_bounds.npy and images/ in `folder`.

    Images may be smaller than the poses say, by one factor for both sides; the focal length
    follows.

    Args:
        folder: holds poses_bounds.npy and images/.
        trust_poses: do not ask whether the poses look like another convention.

    Raises:
        IoError, RangeError, ShapeError, SceneError: names the row or image at fault.
    """
    table = read_npy(_NAME, folder / "poses_bounds.npy")
    call = Arguments(_NAME, np.float64)
    table = call.array("poses_bounds.npy", table, ("N", 17), finite=False)
    image_folder = folder / "images"
    if not image_folder.is_dir():
        raise IoError(message(_NAME, str(folder), "a folder 'images'", "none"))
    files = list_images(image_folder)
    if len(files) != len(table):
        got = f"{len(files)} images for {len(table)} poses"
        remedy = "rows belong to images in the order of names: every image needs its row"
        raise IoError(message(_NAME, "images", "as many images as poses", got, remedy))
    photographs = [Photograph(file, read_header(file)) for file in files]
    check_same_size(_NAME, [(f"image '{p.file.name}'", p) for p in photographs])
    images = kind_of_images(_NAME, photographs)
    views = [_read_row(row, photograph) for row, photograph in zip(table, photographs, strict=True)]
    poses = [view.camera.world_from_camera for view in views]
    world_from_source, up_line = world_from_estimated_up(poses, declared_z_up=False)
    views = [view.transformed(world_from_source) for view in views]
    lines = ["camera axes (down, right, backwards) -> OpenCV, scale arbitrary", up_line]
    header = photographs[0].header
    if (table[0, 9], table[0, 4]) != (header.width, header.height):
        declared = f"{table[0, 9]:g} x {table[0, 4]:g}"
        lines.append(f"focal length scaled from {declared} to {header.width} x {header.height}")
    if not trust_poses:
        lines.extend(check_convention(_NAME, views, world_from_source, up_is_known=False))
    capture = make_capture("llff", folder, hold_out(views), images, world_from_source, lines)
    return replace(capture, depth_range=_depth_range(table))


def _read_row(row: FloatArray, photograph: Photograph) -> View:
    frame = f"row of image '{photograph.file.name}'"
    if not bool(np.isfinite(row).all()):
        raise RangeError(message(_NAME, frame, "finite numbers", "NaN or infinity"))
    matrix = row[:15].reshape(3, 5)
    axes = np.stack([matrix[:, 1], matrix[:, 0], -matrix[:, 2], matrix[:, 3]], axis=1)
    pose = check_pose(_NAME, f"{frame}: pose", axes)
    height, width, focal = matrix[:, 4]
    header = photograph.header
    if not (height >= 1.0 and width >= 1.0):
        got = f"{height:g} x {width:g}"
        raise RangeError(message(_NAME, f"{frame}: height, width", "positive sizes", got))
    scale_x, scale_y = header.width / width, header.height / height
    if abs(scale_x / scale_y - 1.0) > 0.01:
        got = f"{header.width} x {header.height}"
        expected = f"an image in the ratio {width:g} x {height:g}"
        raise IoError(message(_NAME, frame, expected, got))
    size = (header.width, header.height)
    pixels = (focal * scale_x, focal * scale_y, 0.5 * header.width, 0.5 * header.height)
    camera = make_camera(_NAME, frame, size, pixels, pose)
    return View(photograph.file.name, camera, photograph.file, header.color_space, source_size=size)


def _depth_range(table: FloatArray) -> tuple[float, float]:
    nearest, farthest = float(table[:, 15].min()), float(table[:, 16].max())
    if not 0.0 < nearest < farthest:
        got = f"{nearest:g} to {farthest:g}"
        raise RangeError(message(_NAME, "depth bounds", "0 < nearest < farthest", got))
    return nearest, farthest

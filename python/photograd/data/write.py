"""Writing captures in the Blender convention, as one step: a reader sees all of it or nothing."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

import numpy as np
from photograd_course.errors import IoError, RangeError, SceneError, ShapeError, message

from .assemble import box_from_source
from .camera import Camera
from .capture import check_box
from .frames import OPENGL_FROM_OPENCV, Y_UP_FROM_Z_UP, FloatArray, invert_rigid
from .image_write import write_exr, write_png
from .images import ImageArray

_NAME = "write_blender_capture"

Frame: TypeAlias = tuple[str, Camera, ImageArray, ImageArray | None]
"""Name, camera, display-encoded (H, W, 4) image with straight alpha in 0..1, and linear radiance
(H, W, 4) premultiplied by alpha, or None."""


def write_blender_capture(
    path: Path,
    splits: Mapping[str, Sequence[Frame]],
    *,
    aabb: FloatArray | None = None,
    overwrite: bool = False,
) -> None:
    """Write transforms_{split}.json with OpenGL cameras and +Z up, PNG images and EXR radiance.

    Everything is written to a hidden folder beside `path`, which is renamed at the end.

    Args:
        path: folder to create.
        splits: frames of "train", and of "test" and "val" if any.
        aabb: (2, 3) box of the scene in our frame (+Y up); stored in the file's frame.
        overwrite: replace an existing folder (else it must not exist, or be empty).

    Raises:
        IoError: the folder exists, or cannot be written.
        RangeError, SceneError, ShapeError: cameras or images that the format cannot express: it has
            one size, one focal length fx = fy and the principal point in the middle.
    """
    path = Path(path)
    if path.exists() and (not path.is_dir() or any(path.iterdir())) and not overwrite:
        remedy = "choose another, or overwrite it"
        raise IoError(message(_NAME, str(path), "a new folder", "one with content", remedy))
    _check_splits(splits)
    extra: dict[str, object] = {}
    if aabb is not None:
        box = check_box(_NAME, "aabb", aabb)
        extra["aabb"] = box_from_source(invert_rigid(Y_UP_FROM_Z_UP), box).tolist()
    partial = path.with_name(f".{path.name}.partial")
    try:
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)
        for split, frames in splits.items():
            _write_split(partial, split, frames, extra)
        _replace_folder(partial, path)
    except IoError:
        raise
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message(_NAME, str(path), "a writable folder", got)) from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _replace_folder(partial: Path, path: Path) -> None:
    """Rename; what stood there is moved aside first and removed last."""
    aside = path.with_name(f".{path.name}.replaced")
    shutil.rmtree(aside, ignore_errors=True)
    if path.exists():
        path.replace(aside)
    try:
        partial.replace(path)
    except OSError:
        if aside.exists():
            aside.replace(path)
        raise
    shutil.rmtree(aside, ignore_errors=True)


def _write_split(
    folder: Path, split: str, frames: Sequence[Frame], extra: Mapping[str, object]
) -> None:
    (folder / split).mkdir()
    camera = frames[0][1]
    listed = []
    for name, frame_camera, image, radiance in frames:
        write_png(folder / split / f"{name}.png", image)
        if radiance is not None:
            write_exr(folder / split / f"{name}.exr", radiance)
        turned = invert_rigid(Y_UP_FROM_Z_UP) @ frame_camera.world_from_camera
        matrix = turned @ OPENGL_FROM_OPENCV
        listed.append({"file_path": f"./{split}/{name}", "transform_matrix": matrix.tolist()})
    angle = 2.0 * math.atan(0.5 * camera.width / camera.fx)
    content = {"camera_angle_x": angle, **extra, "frames": listed}
    text = json.dumps(content, indent=1)
    (folder / f"transforms_{split}.json").write_text(text, encoding="utf-8")


def _check_splits(splits: Mapping[str, Sequence[Frame]]) -> None:
    unknown = sorted(set(splits) - {"train", "test", "val"})
    if unknown or not splits.get("train"):
        got = f"unknown {unknown}" if unknown else "no training frames"
        raise SceneError(message(_NAME, "splits", "'train', and 'test' and 'val' if any", got))
    first = splits["train"][0][1]
    for split, frames in splits.items():
        names = [frame[0] for frame in frames]
        if not frames or len(set(names)) != len(names):
            got = "none" if not frames else "a name twice"
            raise SceneError(message(_NAME, f"split '{split}'", "frames of different names", got))
        for name, camera, image, radiance in frames:
            _check_frame(f"{split} '{name}'", name, camera, first, (image, radiance))


def _check_frame(
    where: str,
    name: str,
    camera: Camera,
    first: Camera,
    images: tuple[ImageArray, ImageArray | None],
) -> None:
    if not name or name != Path(name).name or name.startswith("."):
        raise SceneError(message(_NAME, where, "a plain file name", repr(name)))
    same = (camera.width, camera.height, camera.fx) == (first.width, first.height, first.fx)
    centred = np.allclose(
        [camera.cx, camera.cy, camera.fy],
        [0.5 * camera.width, 0.5 * camera.height, camera.fx],
        rtol=1e-12,
        atol=0.0,
    )
    if not (same and centred):
        expected = "one size, one focal length fx = fy, principal point in the middle"
        listed = (camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy)
        raise RangeError(message(_NAME, f"{where}: camera", expected, listed))
    shape = (camera.height, camera.width, 4)
    for image in images:
        if image is not None and image.shape != shape:
            raise ShapeError(message(_NAME, f"{where}: image", f"shape {shape}", image.shape))

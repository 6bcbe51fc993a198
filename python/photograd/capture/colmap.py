"""Captures reconstructed by COLMAP: a sparse model and the photographs that it was made from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from photograd.capture.assemble import (
    Photograph,
    check_size,
    find_photograph,
    kind_of_images,
    make_camera,
    make_capture,
    transform_points,
    undistortion_lines,
)
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture, hold_out
from photograd.capture.colmap_model import (
    ColmapCamera,
    ColmapImage,
    ColmapModel,
    read_binary_model,
    read_text_model,
)
from photograd.capture.frames import (
    check_pose,
    invert_rigid,
    rotation_from_quaternion,
    world_from_estimated_up,
)
from photograd.capture.undistort import ColmapLens, Distortion, FisheyeDistortion, Lens
from photograd.capture.view import View
from photograd.errors import IoError, RangeError, SceneError, message
from photograd.types import FloatArray

_NAME = "load_colmap"
_MODEL_FOLDERS = ("sparse/0", "sparse", "colmap/sparse/0", "0", "")
_RADIAL = ("SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV")
_FISHEYE = (
    "SIMPLE_FISHEYE",
    "FISHEYE",
    "SIMPLE_RADIAL_FISHEYE",
    "RADIAL_FISHEYE",
    "OPENCV_FISHEYE",
)
_ONE_FOCAL_LENGTH = ("RADIAL", "RADIAL_FISHEYE")
"""Models with one focal length, beside those that are called SIMPLE."""


def find_model(folder: Path) -> Path | None:
    """The folder at or below `folder` that holds cameras.bin or cameras.txt, if any."""
    for name in _MODEL_FOLDERS:
        for suffix in ("bin", "txt"):
            if (folder / name / f"cameras.{suffix}").is_file():
                return folder / name
    return None


def load_colmap(folder: Path, *, trust_poses: bool = False, allow_outside: bool = False) -> Capture:
    """Read a sparse model in text or binary form (binary if both are there) and its images.

    Args:
        folder: holds sparse/0, sparse, colmap/sparse/0 or the model itself; the images lie in
            images/ beside it or up to two folders above.
        trust_poses: do not compare the poses with the model's own observations.
        allow_outside: also photographs that lie outside of images/.

    Raises:
        IoError, RangeError, ShapeError, SceneError: names the image or camera at fault.
    """
    model_folder = find_model(folder)
    if model_folder is None:
        raise IoError(message(_NAME, str(folder), "cameras.bin or cameras.txt", "neither"))
    binary = (model_folder / "cameras.bin").is_file()
    model = read_binary_model(model_folder) if binary else read_text_model(model_folder)
    if not model.images:
        raise IoError(message(_NAME, str(model_folder), "at least one image", "an empty model"))
    image_folder = _find_images(folder, model_folder)
    pairs = [
        _read_view(model, image, image_folder, allow_outside=allow_outside)
        for image in model.images
    ]
    images = kind_of_images(_NAME, [photograph for _, photograph in pairs])
    if not trust_poses:
        _check_observations(model, [view for view, _ in pairs])
    poses = [view.camera.world_from_camera for view, _ in pairs]
    world_from_source, up_line = world_from_estimated_up(poses, declared_z_up=False)
    views = [view.transformed(world_from_source) for view, _ in pairs]
    lines = (
        f"{'binary' if binary else 'text'} model in {model_folder.name}: camera_from_world "
        "-> world_from_camera, OpenCV camera kept, scale arbitrary",
        up_line,
        *undistortion_lines(views),
    )
    capture = make_capture("colmap", folder, hold_out(views), images, world_from_source, lines)
    if model.points is None or not len(model.points.ids):
        return capture
    points = _finite_points(model.points.positions, world_from_source)
    return replace(capture, points=points, point_colors=model.points.colors)


def _find_images(folder: Path, model_folder: Path) -> Path:
    ancestors = [folder, model_folder, *list(model_folder.resolve().parents)[:3]]
    candidates = [ancestor / "images" for ancestor in ancestors]
    for candidate in candidates:
        if candidate.is_dir():
            return candidate
    tried = ", ".join(str(candidate) for candidate in dict.fromkeys(candidates))
    raise IoError(message(_NAME, str(folder), "a folder 'images'", f"none of {tried}"))


def _read_view(
    model: ColmapModel, image: ColmapImage, folder: Path, *, allow_outside: bool
) -> tuple[View, Photograph]:
    """One view, still in the model's world."""
    frame = f"image '{image.name}'"
    if image.camera_id not in model.cameras:
        known = f"a camera id of {sorted(model.cameras)[:8]}"
        raise IoError(message(_NAME, frame, known, image.camera_id))
    length = float(np.linalg.norm(image.quaternion))
    if not 0.5 < length < 2.0:
        raise RangeError(message(_NAME, f"{frame}: quaternion", "unit length", f"{length:.6g}"))
    camera_from_world = np.eye(4)
    camera_from_world[:3, :3] = rotation_from_quaternion(image.quaternion)
    camera_from_world[:3, 3] = image.translation
    pose = invert_rigid(check_pose(_NAME, f"{frame}: pose", camera_from_world))
    photograph = find_photograph(_NAME, frame, folder, image.name, allow_outside=allow_outside)
    stored = model.cameras[image.camera_id]
    check_size(_NAME, frame, photograph, (stored.width, stored.height))
    camera, distortion = pinhole_and_lens(stored, image.camera_id, pose)
    space = photograph.header.color_space
    size = (stored.width, stored.height)
    view = View(image.name, camera, photograph.file, space, distortion, source_size=size)
    return view, photograph


def pinhole_and_lens(
    camera: ColmapCamera, camera_id: int, pose: FloatArray
) -> tuple[Camera, Lens | None]:
    """Split COLMAP's parameters into a pinhole at `pose` (world_from_camera) and a lens.

    Parameters are one focal length f or two, fx and fy, then cx, cy and the lens. The pinhole has
    the same focal lengths and principal point: the middle of the photograph keeps its scale, and
    what a fisheye lens shows beyond the pinhole's borders is cut off.

    Args:
        camera: as COLMAP describes it.
        camera_id: its number, for errors.
        pose: (4, 4) of the view.

    Raises:
        IoError: a camera of no focal length, or a model that pycolmap has to compute, which is not
            installed (extra `sfm`).
        RangeError: sizes or focal lengths that make no camera.
    """
    if camera.model == "EQUIRECTANGULAR":
        remedy = "render perspective views of the panoramas with COLMAP first"
        where = f"camera {camera_id}: model"
        raise IoError(
            message(_NAME, where, "a perspective or fisheye camera", camera.model, remedy)
        )
    values = list(camera.parameters)
    single = camera.model.startswith("SIMPLE_") or camera.model in _ONE_FOCAL_LENGTH
    focals = 1 if single else 2
    fx, fy = values[0], values[focals - 1]
    cx, cy = values[focals : focals + 2]
    size, pixels = (camera.width, camera.height), (fx, fy, cx, cy)
    pinhole = make_camera(_NAME, f"camera {camera_id}", size, pixels, pose)
    rest = values[focals + 2 :]
    if camera.model in _RADIAL:
        lens = Distortion(*rest)
        return pinhole, None if lens.is_identity else lens
    if camera.model in _FISHEYE:
        return pinhole, FisheyeDistortion(*rest)
    return pinhole, ColmapLens(camera.model, camera.parameters)


def _check_observations(model: ColmapModel, views: list[View]) -> None:
    """Poses in another convention do not see the points where the model says they were seen."""
    if model.points is None or not len(model.points.ids):
        return
    order = np.argsort(model.points.ids)
    ids = model.points.ids[order]
    for view, image in zip(views, model.images, strict=True):
        rows = np.searchsorted(ids, image.point_ids).clip(max=len(ids) - 1)
        known = ids[rows] == image.point_ids
        if known.sum() < 8:
            continue
        projected = reproject(view, model.points.positions[order[rows[known]]])
        error = np.linalg.norm(projected - image.pixels[known], axis=1)
        error = np.where(np.isfinite(error), error, np.inf)
        if float(np.median(error)) > 0.05 * max(view.camera.width, view.camera.height):
            got = (
                f"a median error of {float(np.median(error)):.1f} px over {int(known.sum())} points"
            )
            remedy = "is the pose world_from_camera, or in OpenGL axes?"
            expected = "its points where it observed them, as a camera_from_world pose puts them"
            raise SceneError(message(_NAME, f"image '{image.name}'", expected, got, remedy))


def reproject(view: View, points: FloatArray) -> FloatArray:
    """Pixels (N, 2) of the distorted photograph where `view` shows points (N, 3); NaN behind it."""
    camera = view.camera
    pixels, _ = camera.project(points)
    if view.distortion is None:
        return pixels
    focal, center = np.array([camera.fx, camera.fy]), np.array([camera.cx, camera.cy])
    shown: FloatArray = view.distortion.distort((pixels - center) / focal) * focal + center
    return shown


def _finite_points(positions: FloatArray, world_from_source: FloatArray) -> FloatArray:
    bad = ~(np.abs(positions) < 1e12).all(axis=1)
    if bool(bad.any()):
        got = f"{int(bad.sum())} that are not"
        raise RangeError(message(_NAME, "points3D", "finite positions", got))
    return transform_points(world_from_source, positions)

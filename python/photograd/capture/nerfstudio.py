"""Captures in one transforms.json, as nerfstudio [Tancik2023] and instant-ngp [Mueller2022] write.

Poses are camera to world with OpenGL axes; intrinsics are shared or per frame, with OpenCV
distortion.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from photograd._files import TRUST, inside
from photograd._json_node import JsonNode, read_json
from photograd._ply import read_ply
from photograd.capture.assemble import (
    Photograph,
    check_size,
    find_photograph,
    is_file,
    kind_of_images,
    make_camera,
    make_capture,
    transform_points,
    undistortion_lines,
)
from photograd.capture.capture import Capture, Split, hold_out
from photograd.capture.convention import check_convention
from photograd.capture.frames import (
    MAX_COORDINATE,
    OPENGL_FROM_OPENCV,
    check_pose,
    world_from_estimated_up,
)
from photograd.capture.intrinsics import read_intrinsics
from photograd.capture.view import View
from photograd.errors import IoError, message
from photograd.types import FloatArray

_NAME = "load_nerfstudio"
_IGNORED = ("aabb_scale", "scale", "offset", "depth_unit_scale_factor")
_SPLITS = ("train", "val", "test")


def load_nerfstudio(
    path: Path, *, trust_poses: bool = False, allow_outside: bool = False
) -> Capture:
    """Read a transforms.json; image paths are relative to its folder.

    The file's own split (`train_filenames`, `val_filenames`, `test_filenames`) is used if it has
    one. +Z is taken as up if the cameras agree; else up is their mean up. Images are undistorted
    when they are read, and `View.valid_mask` says which pixels the lens covers.

    Args:
        path: the JSON file.
        trust_poses: do not ask whether the poses look like another convention.
        allow_outside: also photographs, masks and points that lie outside of the folder.

    Raises:
        IoError, RangeError, ShapeError, SceneError: names the frame and member at fault.
    """
    root = read_json(_NAME, path)
    views: list[View] = []
    photographs: list[Photograph] = []
    for node in root["frames"].items():
        view, photograph = _read_frame(root, node, path.parent, allow_outside=allow_outside)
        views.append(view)
        photographs.append(photograph)
    images = kind_of_images(_NAME, photographs)
    poses = [view.camera.world_from_camera for view in views]
    world_from_source, up_line = world_from_estimated_up(poses, declared_z_up=True)
    views = [view.transformed(world_from_source) for view in views]
    lines = ["OpenGL camera -> OpenCV", up_line, *_remarks(root), *undistortion_lines(views)]
    if not trust_poses:
        lines.extend(check_convention(_NAME, views, world_from_source, up_is_known=False))
    split, val = _split(root, views)
    points, colors, point_lines = _read_points(
        root, path.parent, world_from_source, allow_outside=allow_outside
    )
    lines.extend(point_lines)
    capture = make_capture("nerfstudio", path, split, images, world_from_source, lines)
    return replace(capture, val=val, points=points, point_colors=colors)


def _read_frame(
    root: JsonNode, node: JsonNode, folder: Path, *, allow_outside: bool
) -> tuple[View, Photograph]:
    """One view, still in the file's world."""
    reference = node["file_path"].text()
    frame = f"{node.where} '{reference}'"
    photograph = find_photograph(_NAME, frame, folder, reference, allow_outside=allow_outside)
    size = (photograph.header.width, photograph.header.height)
    lens = read_intrinsics(root, node, size)
    check_size(_NAME, frame, photograph, lens.size)
    matrix = node["transform_matrix"].numbers((4, 4), (3, 4))
    pose = check_pose(_NAME, f"{frame}: transform_matrix", matrix) @ OPENGL_FROM_OPENCV
    camera = make_camera(_NAME, frame, size, lens.pixels, pose)
    mask_file = None
    if "mask_path" in node:
        mask_reference = node["mask_path"].text()
        where = f"{frame}: mask_path"
        mask = find_photograph(_NAME, where, folder, mask_reference, allow_outside=allow_outside)
        check_size(_NAME, where, mask, size)
        mask_file = mask.file
    view = View(
        name=reference.removeprefix("./"),
        camera=camera,
        image=photograph.file,
        color_space=photograph.header.color_space,
        distortion=lens.distortion,
        source_size=size,
        mask_file=mask_file,
    )
    return view, photograph


def _read_points(
    root: JsonNode, folder: Path, world_from_source: FloatArray, *, allow_outside: bool
) -> tuple[FloatArray | None, npt.NDArray[np.uint8] | None, list[str]]:
    """Points of `ply_file_path`, which lie in the world of the poses, moved with them into ours."""
    if "ply_file_path" not in root:
        return None, None, []
    reference = root["ply_file_path"].text()
    where = root["ply_file_path"].where
    file = inside(_NAME, where, folder, reference, allow_outside=allow_outside, remedy=TRUST)
    if not is_file(file):
        return None, None, [f"ply_file_path: no file {reference}, so no sparse points"]
    positions, colors = read_point_ply(file)
    if not len(positions):
        return None, None, [f"ply_file_path: no points in {reference}"]
    return transform_points(world_from_source, positions), colors, []


def _remarks(root: JsonNode) -> list[str]:
    lines = []
    if "applied_transform" in root:
        matrix = root["applied_transform"].numbers((3, 4), (4, 4))
        check_pose(_NAME, root["applied_transform"].where, matrix)
        lines.append("applied_transform: already contained in the poses, not taken back")
    ignored = [key for key in _IGNORED if key in root]
    if ignored:
        lines.append(f"ignored members: {', '.join(ignored)}")
    return lines


def _split(root: JsonNode, views: list[View]) -> tuple[Split, tuple[View, ...]]:
    """The split, and the validation views."""
    if "train_filenames" not in root:
        return hold_out(views), ()
    by_name = {view.name: view for view in views}
    splits: dict[str, tuple[View, ...]] = {}
    for split in _SPLITS:
        chosen = []
        key = f"{split}_filenames"
        for node in root[key].items() if key in root else []:
            name = node.text().removeprefix("./")
            if name not in by_name:
                raise IoError(message(_NAME, node.where, "the file_path of a frame", repr(name)))
            chosen.append(by_name[name])
        splits[split] = tuple(chosen)
    counts = ", ".join(f"{len(splits[split])} {split}" for split in _SPLITS)
    line = f"split as the file has it ({counts})"
    return (splits["train"], splits["test"], line), splits["val"]


# Colored points in .ply files: what structure from motion hands to what starts from it.


_READER = "read_point_ply"
_POSITION, _COLOR = ("x", "y", "z"), ("red", "green", "blue")


def read_point_ply(path: Path) -> tuple[FloatArray, npt.NDArray[np.uint8] | None]:
    """Positions (N, 3) in the frame of the file and 8-bit display colors (N, 3), or None.

    Args:
        path: of the file.

    Raises:
        IoError: no file, a damaged one, or positions or colors that are none.
    """
    elements = read_ply(_READER, path)
    if "vertex" not in elements:
        raise IoError(message(_READER, f"{path}", "an element 'vertex'", sorted(elements)))
    vertex = elements["vertex"]
    names = set(vertex.dtype.names or ())
    wanted = _POSITION + (_COLOR if names.issuperset(_COLOR) else ())
    bad = [name for name in wanted if name not in names or vertex.dtype[name].kind not in "fiu"]
    if bad:
        got = f"none in {', '.join(bad)}"
        raise IoError(message(_READER, f"{path}", "numbers x, y and z for each point", got))
    positions = np.stack([vertex[name].astype(np.float64) for name in _POSITION], axis=1)
    outside = ~(np.abs(positions) <= MAX_COORDINATE).all(axis=1)
    if outside.any():
        row = int(np.flatnonzero(outside)[0])
        got = f"{positions[row].tolist()} in row {row}"
        raise IoError(message(_READER, f"{path}", "finite positions up to 1e9", got))
    if wanted == _POSITION:
        return positions, None
    if any(vertex.dtype[name] != np.uint8 for name in _COLOR):
        got = ", ".join(str(vertex.dtype[name]) for name in _COLOR)
        raise IoError(message(_READER, f"{path}", "colors as 8-bit numbers (uchar)", got))
    return positions, np.stack([vertex[name] for name in _COLOR], axis=1)

"""Captures stored like NeRF's synthetic scenes: transforms_{train,test,val}.json [Mildenhall2020].

Poses are camera to world with OpenGL axes in a world with +Z up. Images are named without suffix.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from photograd._json_node import JsonNode, read_json
from photograd.capture.assemble import (
    Photograph,
    box_from_source,
    check_same_size,
    check_size,
    find_photograph,
    kind_of_images,
    make_camera,
    make_capture,
    undistortion_lines,
)
from photograd.capture.capture import Capture, check_box, hold_out
from photograd.capture.convention import check_convention
from photograd.capture.frames import OPENGL_FROM_OPENCV, Y_UP_FROM_Z_UP, check_pose
from photograd.capture.intrinsics import read_intrinsics
from photograd.capture.view import View
from photograd.errors import IoError, message
from photograd.images.read import ColorSpace

_NAME = "load_blender"


def load_blender(
    folder: Path,
    *,
    color_space: ColorSpace = "display",
    trust_poses: bool = False,
    allow_outside: bool = False,
) -> Capture:
    """Read a capture in the Blender convention.

    Args:
        folder: holds transforms_train.json, and transforms_test.json and transforms_val.json if
            any.
        color_space: "linear" prefers .exr where a frame has both .png and .exr.
        trust_poses: do not ask whether the poses look like another convention.
        allow_outside: also photographs that lie outside of the folder.

    Raises:
        IoError, RangeError, ShapeError, SceneError: names the file, frame and member at fault.
    """
    roots: dict[str, JsonNode] = {}
    for split in ("train", "test", "val"):
        path = folder / f"transforms_{split}.json"
        if split == "train" or path.exists():
            roots[split] = read_json(_NAME, path)
    views: dict[str, tuple[View, ...]] = {}
    found: list[tuple[str, Photograph]] = []
    for split, root in roots.items():
        views[split] = _read_split(root, folder, color_space, found, allow_outside=allow_outside)
    check_same_size(_NAME, found)
    images = kind_of_images(_NAME, [photograph for _, photograph in found])
    everything = [view for split in views.values() for view in split]
    lines = ["OpenGL camera -> OpenCV", "+Z up -> +Y up", *undistortion_lines(everything)]
    if not trust_poses:
        lines.extend(check_convention(_NAME, everything, Y_UP_FROM_Z_UP, up_is_known=True))
    bounds = None
    if "aabb" in roots["train"]:
        node = roots["train"]["aabb"]
        box = check_box(_NAME, node.where, node.numbers((2, 3)))
        bounds = box_from_source(Y_UP_FROM_Z_UP, box)
        lines.append("aabb: declared in the +Z up frame, turned like the poses")
    parts = (views["train"], views.get("test", ()), "split as the files have it")
    if not parts[1]:
        parts = hold_out(views["train"])
    capture = make_capture("blender", folder, parts, images, Y_UP_FROM_Z_UP, lines)
    return replace(capture, val=views.get("val", ()), bounds=bounds)


def _read_split(
    root: JsonNode,
    folder: Path,
    color_space: ColorSpace,
    found: list[tuple[str, Photograph]],
    *,
    allow_outside: bool,
) -> tuple[View, ...]:
    views: list[View] = []
    for node in root["frames"].items():
        reference = node["file_path"].text()
        frame = f"{node.where} '{reference}'"
        photograph = find_photograph(
            _NAME, frame, folder, reference, color_space, allow_outside=allow_outside
        )
        size = (photograph.header.width, photograph.header.height)
        lens = read_intrinsics(root, node, size)
        check_size(_NAME, frame, photograph, lens.size)
        matrix = node["transform_matrix"].numbers((4, 4), (3, 4))
        pose = check_pose(_NAME, f"{frame}: transform_matrix", matrix)
        camera = make_camera(
            _NAME, frame, size, lens.pixels, Y_UP_FROM_Z_UP @ pose @ OPENGL_FROM_OPENCV
        )
        name = reference.removeprefix("./")
        space = photograph.header.color_space
        views.append(View(name, camera, photograph.file, space, lens.distortion, source_size=size))
        found.append((frame, photograph))
    if not views:
        raise IoError(message(_NAME, f"{root.where}: frames", "at least one frame", "none"))
    return tuple(views)

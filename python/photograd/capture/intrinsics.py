"""Intrinsics as `transforms.json` files write them, shared by all frames or frame by frame."""

from __future__ import annotations

import math
from dataclasses import dataclass

from photograd._json_node import JsonNode
from photograd.capture.undistort import Distortion, FisheyeDistortion, Lens
from photograd.errors import IoError, RangeError, SceneError, message

_RADIAL = ("k1", "k2", "p1", "p2")
_FISHEYE = ("k1", "k2", "k3", "k4")
_TERMS = {*_RADIAL, *_FISHEYE, "k5", "k6"}
MODELS = {"PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "OPENCV_FISHEYE"}


@dataclass(frozen=True)
class Intrinsics:
    """Of a frame.

    Attributes:
        size: width and height of the image in pixels.
        pixels: (fx, fy, cx, cy), pixel centers at +0.5.
        distortion: the lens; None of a pinhole.
    """

    size: tuple[int, int]
    pixels: tuple[float, float, float, float]
    distortion: Lens | None


def read_intrinsics(shared: JsonNode, frame: JsonNode, image_size: tuple[int, int]) -> Intrinsics:
    """Intrinsics of one frame; what the frame does not say, the file says for all.

    `fl_x` is the focal length in pixels, else `camera_angle_x` is the full horizontal angle of view
    in radians: fx = (w / 2) / tan(angle / 2). Missing: fy = fx, principal point in the middle, size
    that of the image.

    Args:
        shared: members that hold for all frames.
        frame: members of this one.
        image_size: (width, height) of its image.

    Raises:
        IoError: members missing or of the wrong type, or a camera model that is not supported.
        RangeError: not finite, not positive, or an angle outside (0, pi).
        SceneError: coefficients beyond k1, k2, p1, p2, or k1 to k4 of OPENCV_FISHEYE.
    """

    def lookup(key: str) -> JsonNode | None:
        for node in (frame, shared):
            if key in node:
                return node[key]
        return None

    def number(key: str, default: float) -> float:
        node = lookup(key)
        return default if node is None else node.number()

    model = _model(lookup("camera_model"))
    width = node.count() if (node := lookup("w")) else image_size[0]
    height = node.count() if (node := lookup("h")) else image_size[1]
    fx = _focal(lookup("fl_x"), lookup("camera_angle_x"), width)
    fy = _focal(lookup("fl_y"), lookup("camera_angle_y"), height)
    if fx is None:
        expected = "a member 'fl_x' or 'camera_angle_x'"
        raise IoError(message(frame.function, frame.where, expected, "neither"))
    known = _FISHEYE if model == "OPENCV_FISHEYE" else _RADIAL
    for key in sorted(_TERMS - set(known)):
        if number(key, 0.0) != 0.0:
            remedy = "undistort the images first"
            got = number(key, 0.0)
            raise SceneError(message(frame.function, f"{frame.where}: {key}", 0, got, remedy))
    terms = [number(key, 0.0) for key in known]
    lens = FisheyeDistortion(*terms) if known == _FISHEYE else Distortion(*terms)
    pixels = (fx, fx if fy is None else fy, number("cx", 0.5 * width), number("cy", 0.5 * height))
    return Intrinsics((width, height), pixels, None if lens == Distortion() else lens)


def _focal(pixels: JsonNode | None, angle: JsonNode | None, size: int) -> float | None:
    if pixels is not None:
        focal = pixels.number()
        if not 0.0 < focal < 1e9:
            expected = "a positive focal length in pixels"
            raise RangeError(message(pixels.function, pixels.where, expected, focal))
        return focal
    if angle is None:
        return None
    radians = angle.number()
    if not 1e-6 < radians < math.pi - 1e-6:
        raise RangeError(
            message(angle.function, angle.where, "an angle in (0, pi) radians", radians)
        )
    return 0.5 * size / math.tan(0.5 * radians)


def _model(node: JsonNode | None) -> str:
    model = "OPENCV" if node is None else node.text()
    if node is not None and model not in MODELS:
        expected = "one of " + ", ".join(sorted(MODELS))
        remedy = "undistort the images to a pinhole first"
        raise IoError(message(node.function, node.where, expected, model, remedy))
    return model

"""What all readers share: find the photographs and check them against their cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from photograd_course.portable_math import matmul

from photograd._files import TRUST, inside
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture, Split
from photograd.capture.view import View
from photograd.errors import Error, IoError, SceneError, message
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.read import IMAGE_SUFFIXES, ColorSpace, ImageHeader, read_header
from photograd.types import FloatArray


@dataclass(frozen=True)
class Photograph:
    """An image file that a capture refers to, and its header."""

    file: Path
    header: ImageHeader


def find_photograph(
    function: str,
    frame: str,
    folder: Path,
    reference: str,
    color_space: ColorSpace = "display",
    *,
    allow_outside: bool = False,
) -> Photograph:
    """The image file that `reference` names relative to `folder`.

    Without a suffix (the Blender convention), those of `IMAGE_SUFFIXES` are tried in this order, or
    the linear ones first when linear radiance is asked for.

    Args:
        function: on whose behalf errors speak.
        frame: what errors call the view.
        folder: of the capture.
        reference: the name in the capture's file.
        color_space: "linear" tries .exr and .hdr first.
        allow_outside: whether it may lie elsewhere.

    Raises:
        IoError: there is none, or it is no image, or `reference` leads out of `folder` without
            `allow_outside`; the text names the frame.
    """
    path = inside(function, frame, folder, reference, allow_outside=allow_outside, remedy=TRUST)
    suffixes = (
        sorted(IMAGE_SUFFIXES, key=lambda s: s not in LINEAR_SUFFIXES)
        if color_space == "linear"
        else None
    )
    candidates = [path]
    if path.suffix.lower() not in IMAGE_SUFFIXES:
        candidates = [path.parent / (path.name + suffix) for suffix in suffixes or IMAGE_SUFFIXES]
    for candidate in candidates:
        if is_file(candidate):
            return Photograph(candidate, read_header(candidate))
    tried = ", ".join(candidate.name for candidate in candidates)
    got = f"none of {tried} in {path.parent}" if len(candidates) > 1 else f"no file {path}"
    raise IoError(message(function, frame, "an image file", got))


def is_file(path: Path) -> bool:
    """Whether `path` is an existing file; False also for names that no file can have."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def check_size(
    function: str, frame: str, photograph: Photograph, expected: tuple[int, int]
) -> None:
    """Refuse an image that is not of the (width, height) that its camera was calibrated for.

    Args:
        function: on whose behalf the error speaks.
        frame: what it calls the view.
        photograph: with the size of its file.
        expected: (width, height) of the camera.

    Raises:
        IoError: sizes differ.
    """
    header = photograph.header
    if (header.width, header.height) != expected:
        got = f"{header.width} x {header.height} in {photograph.file.name}"
        remedy = "intrinsics and images must be of one size; use `downscale` to reduce both"
        size = f"an image of {expected[0]} x {expected[1]}"
        raise IoError(message(function, frame, size, got, remedy))


def check_same_size(function: str, photographs: Sequence[tuple[str, Photograph]]) -> None:
    """Refuse images of different sizes in a format that has one size for all.

    Args:
        function: on whose behalf the error speaks.
        photographs: each with the name of its frame.

    Raises:
        IoError: names the first image that differs.
    """
    for frame, photograph in photographs:
        first = photographs[0][1].header
        check_size(function, frame, photograph, (first.width, first.height))


def make_camera(
    function: str,
    frame: str,
    size: tuple[int, int],
    pixels: tuple[float, float, float, float],
    pose: FloatArray,
) -> Camera:
    """Camera of (width, height) and (fx, fy, cx, cy) whose errors name the frame.

    Args:
        function: on whose behalf errors speak.
        frame: what they call the view.
        size: (width, height).
        pixels: (fx, fy, cx, cy).
        pose: (4, 4) world_from_camera.

    Raises:
        RangeError, SceneError, ShapeError: as `Camera` does.
    """
    try:
        return Camera(*size, *pixels, pose)
    except Error as error:
        raise type(error)(f"{function}: {frame}: {error}") from error


def _unused_images(photographs: Sequence[Photograph]) -> list[str]:
    """A sentence for the log if images lie beside the used ones that no pose belongs to.

    Another form of a used image, such as its radiance beside its PNG, does not count.
    """
    used = {photograph.file.with_suffix("") for photograph in photographs}
    folders = sorted({photograph.file.parent for photograph in photographs})
    left = [x for folder in folders for x in list_images(folder) if x.with_suffix("") not in used]
    if not left:
        return []
    names = ", ".join(path.name for path in left[:4]) + (", ..." if len(left) > 4 else "")
    return [f"{len(left)} images without a pose, not used: {names}"]


def undistortion_lines(views: Sequence[View]) -> list[str]:
    """A sentence for the log if lenses are undone: of how many, and how much the views hold.

    That is measured along the axes of the photograph in which the pinhole view cuts off most.
    """
    bent = [view for view in views if view.distortion is not None]
    if not bent:
        return []
    shares = np.array([_share_of_photograph(view) for view in bent]).min(axis=0)
    line = f"lens distortion removed on reading from {len(bent)} of {len(views)} images"
    if shares.min() < 0.95:
        width, height = (100 * shares).round().astype(int)
        line += f"; a pinhole view holds the middle {width} x {height} % of its photograph"
    return [line]


def _share_of_photograph(view: View) -> FloatArray:
    """(2,) of width and height of the photograph, what lies between the pinhole view's borders."""
    assert view.distortion is not None
    camera = view.camera
    size, focal = np.array([camera.width, camera.height]), np.array([camera.fx, camera.fy])
    left, top = -camera.cx / camera.fx, -camera.cy / camera.fy
    right, bottom = left + camera.width / camera.fx, top + camera.height / camera.fy
    borders = np.array([[left, 0.0], [0.0, top], [right, 0.0], [0.0, bottom]])
    with np.errstate(all="ignore"):
        shown = view.distortion.distort(borders) * focal
        shares = np.array([shown[2, 0] - shown[0, 0], shown[3, 1] - shown[1, 1]]) / size
    return np.where(np.isfinite(shares), shares, 1.0).clip(0.0, 1.0)


def list_images(folder: Path) -> list[Path]:
    """Image files of a folder in the order of their names."""
    entries = (entry for entry in folder.iterdir() if entry.is_file())
    return sorted(entry for entry in entries if entry.suffix.lower() in IMAGE_SUFFIXES)


@dataclass(frozen=True)
class ImageKind:
    """What all images of a capture are together, and sentences about it for the log."""

    color_space: ColorSpace
    has_alpha: bool
    lines: tuple[str, ...]


def kind_of_images(function: str, photographs: Sequence[Photograph]) -> ImageKind:
    """Color space and alpha of all images, and those that lie beside them unused.

    Args:
        function: on whose behalf errors speak.
        photographs: of the capture.

    Raises:
        IoError: no images at all.
        SceneError: EXR and 8-bit images mixed.
    """
    if not photographs:
        raise IoError(message(function, "images", "at least one", "an empty capture"))
    spaces = {photograph.header.color_space for photograph in photographs}
    if len(spaces) > 1:
        got = "EXR beside PNG or JPEG"
        raise SceneError(message(function, "images", "one color space for all", got))
    color_space = spaces.pop()
    with_alpha = sum(photograph.header.has_alpha for photograph in photographs)
    has_alpha = with_alpha == len(photographs)
    kind = "linear Rec. 709, premultiplied" if color_space == "linear" else "sRGB-encoded, straight"
    lines = [f"images: {kind} alpha assumed"]
    if with_alpha and not has_alpha:
        lines.append(f"{with_alpha} of {len(photographs)} images carry alpha: counted as without")
    if has_alpha:
        lines.append("background: white assumed, as the images carry alpha")
    return ImageKind(color_space, has_alpha, (*lines, *_unused_images(photographs)))


def make_capture(
    form: str,
    source: Path,
    split: Split,
    images: ImageKind,
    world_from_source: FloatArray,
    lines: Sequence[str],
) -> Capture:
    """A capture without points and bounds.

    Args:
        form: name of the file format.
        source: the folder or file.
        split: as `hold_out` returns it.
        images: of all views. With alpha the background is white, by the custom of evaluation.
        world_from_source: (4, 4), already contained in the poses of the views.
        lines: what else was converted, for the log.
    """
    train, test, split_line = split
    return Capture(
        train=train,
        test=test,
        format=form,
        source=source,
        color_space=images.color_space,
        has_alpha=images.has_alpha,
        background=(1.0, 1.0, 1.0) if images.has_alpha else None,
        world_from_source=world_from_source,
        conversions=(*lines, *images.lines, split_line),
    )


def box_from_source(world_from_source: FloatArray, box: FloatArray) -> FloatArray:
    """The axis-aligned (2, 3) box around a turned box.

    Exact for the quarter turn from +Z up to +Y up.

    Args:
        world_from_source: (4, 4) rigid.
        box: (2, 3) in the world of the file.
    """
    corners = transform_points(world_from_source, box_corners(box))
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


def box_corners(box: FloatArray) -> FloatArray:
    """The eight corners (8, 3) of a (2, 3) box, z fastest."""
    return np.stack(np.meshgrid(*box.T, indexing="ij"), axis=-1).reshape(8, 3)


def transform_points(world_from_source: FloatArray, points: FloatArray) -> FloatArray:
    """Points (N, 3) of the file's world in ours.

    Args:
        world_from_source: (4, 4) rigid.
        points: (N, 3).
    """
    return matmul(points, world_from_source[:3, :3].T) + world_from_source[:3, 3]

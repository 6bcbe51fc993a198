"""Photographs on disk: PNG, JPEG, EXR, Radiance .hdr and PFM in, one kind of array out.

8 and 16 bit files hold display-encoded values (sRGB is assumed) with straight alpha; they are
scaled to 0..1 and not decoded. EXR holds linear radiance with premultiplied alpha, as OpenEXR
prescribes, and is divided by it here, since photographs have straight alpha in this project and
renderings premultiplied alpha. Radiance .hdr and PFM hold linear radiance without alpha.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt
from photograd_course.input_files import read_file, require_file
from PIL import Image

from photograd._arrays import Arguments
from photograd._extras import import_extra
from photograd._typed import typed_call
from photograd.errors import IoError, message
from photograd.images import exr
from photograd.images.kind import (
    LINEAR_KINDS,
    LINEAR_SUFFIXES,
    allow_pixels,
    image_kind,
    require_pixels,
    too_many_pixels,
)
from photograd.images.pfm import read_pfm, read_pfm_header
from photograd.images.rgbe import read_rgbe, read_rgbe_header

ColorSpace: TypeAlias = Literal["display", "linear"]
ImageArray: TypeAlias = npt.NDArray[np.float32]

ALPHA_SLACK = 0.01
"""How far a lossy compression may push alpha out of 0..1."""

MAX_RADIANCE = 1e12
"""A thousand times the sun's disc; beyond it, squares of radiance leave the range of float."""

IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg", *LINEAR_SUFFIXES)

_DECODE_ERRORS = (
    OSError,
    SyntaxError,
    ValueError,
    EOFError,
    IndexError,
    KeyError,
    TypeError,
    RuntimeError,
    MemoryError,
    struct.error,
    zlib.error,
    Image.DecompressionBombError,
)
"""What Pillow raises for damaged files, by experience: its plugins do not share an exception."""

_MODES = {"1", "L", "LA", "P", "RGB", "RGBA", "I;16", "I;16B", "I;16L"}


@dataclass(frozen=True)
class ImageHeader:
    """Width and height in pixels, whether the file carries alpha, and its color space."""

    width: int
    height: int
    has_alpha: bool
    color_space: ColorSpace


def read_header(path: Path) -> ImageHeader:
    """Size and kind of an image file without decoding its pixels.

    Raises:
        IoError: missing, not an image, zero-size, or of a mode that is not supported.
    """
    _require_file("read_header", path)
    kind = image_kind("read_header", path)
    if kind == "EXR":
        width, height, has_alpha = exr.read_exr_header(path)
        return ImageHeader(width, height, has_alpha, "linear")
    if kind in LINEAR_KINDS:
        size = read_rgbe_header(path) if kind == "HDR" else read_pfm_header(path)
        return ImageHeader(*size, False, "linear")
    try:
        with Image.open(path, formats=(kind,)) as opened:
            _require_mode("read_header", path, opened)
            has_alpha = "A" in opened.getbands() or "transparency" in opened.info
            return ImageHeader(opened.width, opened.height, has_alpha, "display")
    except IoError:
        raise
    except _DECODE_ERRORS as error:
        raise _unreadable("read_header", path, error) from error


@typed_call
def read_image(path: str | Path) -> ImageArray:
    """Pixels of an image file as (H, W, 4) float32, straight alpha (1 where the file has none).

    Display-encoded k/255 (or k/65535) for PNG and JPEG, linear radiance for EXR, .hdr and PFM; the
    content says which it is, not the name. Gray is repeated in the three colors; a palette is
    looked up. The orientation tag of JPEG is not applied, since poses refer to pixels as stored.

    Args:
        path: of the file.

    Raises:
        IoError: missing, truncated, damaged, zero-size, non-finite, of an unsupported mode, or a
            color PNG of 16 bits without OpenCV (extra `png16`).

    Example:
        >>> photograd.read_image("view.png").shape
        (16, 16, 4)
    """
    path = Path(path)
    _require_file("read_image", path)
    kind = image_kind("read_image", path)
    if kind in LINEAR_KINDS:
        return _straight(_checked(path, _READERS[kind](path)))
    try:
        with Image.open(path, formats=(kind,)) as opened:
            _require_mode("read_image", path, opened)
            return _pixels(path, opened)
    except IoError:
        raise
    except _DECODE_ERRORS as error:
        raise _unreadable("read_image", path, error) from error


@typed_call
def read_radiance(path: Path) -> ImageArray:
    """Pixels of a linear image, EXR, Radiance .hdr or PFM, as (H, W, 3) float32, as stored.

    Alpha is left aside: colors are premultiplied by it.

    Raises:
        IoError: as `read_image`, or an image of another kind: 8 bits are clipped at white.
    """
    _require_file("read_radiance", path)
    kind = image_kind("read_radiance", path, LINEAR_KINDS)
    return np.ascontiguousarray(_READERS[kind](path)[..., :3])


def _opaque(color: ImageArray) -> ImageArray:
    return np.concatenate([color, np.ones_like(color[..., :1])], axis=2)


_READERS: dict[str, Callable[[Path], ImageArray]] = {
    "EXR": exr.read_exr,
    "HDR": lambda path: _opaque(read_rgbe(path)),
    "PFM": lambda path: _opaque(read_pfm(path)),
}


def _checked(path: Path, stored: ImageArray) -> ImageArray:
    """Refuse linear pixels that cannot be radiance with coverage; clamp what compression left."""
    alpha = stored[..., 3]
    if float(alpha.min()) < -ALPHA_SLACK or float(alpha.max()) > 1.0 + ALPHA_SLACK:
        got = f"{float(alpha.min()):.6g} to {float(alpha.max()):.6g}"
        raise IoError(message("read_image", str(path), "alpha in 0..1", got))
    largest = float(np.abs(stored[..., :3]).max())
    if largest > MAX_RADIANCE:
        raise IoError(message("read_image", str(path), "radiance below 1e12", f"{largest:.6g}"))
    stored[..., 3] = alpha.clip(0.0, 1.0)
    return stored


def _pixels(path: Path, opened: Image.Image) -> ImageArray:
    if opened.mode.startswith("I;16"):
        return _with_channels(np.asarray(opened)[..., None], 65535.0)
    if opened.format == "PNG" and read_file("read_image", path, 25)[24:] == b"\x10":
        return _with_channels(_sixteen_bits(path), 65535.0)
    if opened.mode in ("P", "1") or "transparency" in opened.info:
        opened = opened.convert("RGBA" if "transparency" in opened.info else "RGB")
    array = np.asarray(opened)
    return _with_channels(array if array.ndim == 3 else array[..., None], 255.0)


def _sixteen_bits(path: Path) -> npt.NDArray[np.uint16]:
    """Samples (H, W, 3 or 4) of a PNG with 16 bits a channel; Pillow drops half of the bits."""
    cv2 = import_extra("read_image", "cv2", "png16")
    encoded = np.frombuffer(read_file("read_image", path), np.uint8)
    try:
        samples = cv2.imdecode(encoded, cv2.IMREAD_UNCHANGED)
    except cv2.error as error:
        raise _unreadable("read_image", path, error) from error
    if samples is None or samples.dtype != np.uint16 or samples.ndim != 3:
        raise _unreadable("read_image", path, "no samples of 16 bits")
    return np.asarray(samples[..., [2, 1, 0, 3][: samples.shape[2]]])


def _with_channels(samples: npt.NDArray[Any], most: float) -> ImageArray:
    """1 (gray), 2 (gray, alpha), 3 or 4 channels of 0 to `most` to RGBA in 0..1."""
    channels = samples.shape[2]
    rgba = np.ones((*samples.shape[:2], 4), np.float32)
    color = samples[..., : 3 if channels >= 3 else 1]
    # Straight into the result: a picture of a hundred megapixels leaves no room for copies.
    np.divide(color, np.float32(most), out=rgba[..., :3], dtype=np.float32)
    if channels in (2, 4):
        np.divide(samples[..., -1], np.float32(most), out=rgba[..., 3], dtype=np.float32)
    return rgba


MIN_ALPHA = 1e-6
"""Below it a pixel counts as transparent: its color is left as it is, since division would only
magnify rounding errors, up to infinity."""


def _straight(premultiplied: ImageArray) -> ImageArray:
    """Divide color by alpha where alpha is not negligible."""
    result = premultiplied.copy()
    alpha = premultiplied[..., 3:]
    np.divide(result[..., :3], alpha, out=result[..., :3], where=alpha > MIN_ALPHA)
    return result


@typed_call
def downscale_image(
    image: ImageArray, factor: int, valid: npt.NDArray[np.bool_] | None = None
) -> tuple[ImageArray, npt.NDArray[np.bool_]]:
    """Box average over factor x factor pixels in premultiplied alpha, back to straight alpha.

    Args:
        image: (H, W, 4) straight alpha. Rows and columns that do not fill a box are cut off at the
            bottom and right.
        valid: (H, W) mask; a box is valid only if all of its pixels are.

    Returns:
        Image (H // factor, W // factor, 4) and its mask.

    Raises:
        RangeError: factor below 1 or larger than the image.
    """
    height, width = image.shape[:2]
    factor = Arguments("downscale_image").integer("factor", factor, low=1, high=min(height, width))
    mask = np.ones((height, width), dtype=np.bool_) if valid is None else valid
    if factor == 1:
        return image, mask
    rows, columns = height // factor, width // factor
    boxes = (rows, factor, columns, factor)
    buffer = image[: rows * factor, : columns * factor].astype(np.float64)
    buffer[..., :3] *= buffer[..., 3:]
    mean = buffer.reshape(*boxes, 4).mean(axis=(1, 3))
    whole = np.all(mask[: rows * factor, : columns * factor].reshape(boxes), axis=(1, 3))
    return _straight(mean.astype(np.float32)), np.asarray(whole)


def _require_file(function: str, path: Path) -> None:
    if require_file(function, path) == 0:
        raise IoError(message(function, repr(str(path)), "an image file", "an empty file"))
    allow_pixels()


def _require_mode(function: str, path: Path, opened: Image.Image) -> None:
    if opened.mode not in _MODES:
        got = f"mode {opened.mode}"
        raise IoError(message(function, str(path), "gray, RGB or RGBA", got, "convert it first"))
    if opened.width < 1 or opened.height < 1:
        raise IoError(message(function, str(path), "at least one pixel", opened.size))
    require_pixels(function, str(path), opened.width, opened.height)


def _unreadable(function: str, path: Path, error: object) -> IoError:
    if isinstance(error, Image.DecompressionBombError):
        return too_many_pixels(function, str(path), error)
    text = " ".join(str(error).split()) or type(error).__name__
    return IoError(message(function, str(path), "a readable image", f"damaged data: {text}"))

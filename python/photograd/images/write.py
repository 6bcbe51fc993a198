"""Writing photographs: PNG with 8 or 16 bits, JPEG, EXR, Radiance .hdr and PFM, atomically."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt
from photograd_course.atomic_io import atomic_write
from PIL import Image

from photograd._arrays import Arguments
from photograd._extras import import_extra
from photograd._typed import typed_call
from photograd.errors import IoError, RangeError, message
from photograd.images import exr
from photograd.images.pfm import encode_pfm
from photograd.images.read import ImageArray
from photograd.images.rgbe import encode_rgbe


@typed_call
def write_png(path: Path, image: ImageArray, *, bits: Literal[8, 16] = 8) -> None:
    """Write display-encoded (H, W, 3 or 4) values in 0..1, straight alpha, as PNG; atomic.

    Raises:
        ShapeError, RangeError: wrong channels, empty, non-finite or outside 0..1 (clip first).
        IoError: the file cannot be written, or 16 bits without OpenCV (extra `png16`).
    """
    samples = _quantized("write_png", image, bits)
    if bits == 16:
        atomic_write(path, _encode_png16(samples))
        return
    picture = Image.fromarray(samples.astype(np.uint8))
    atomic_write(path, lambda stream: picture.save(stream, format="PNG"))


@typed_call
def write_jpeg(path: Path, image: ImageArray, *, quality: int = 95) -> None:
    """Write display-encoded (H, W, 3) values in 0..1 as JPEG without chroma subsampling; atomic.

    Raises:
        ShapeError, RangeError: not three channels, empty, non-finite or outside 0..1.
        IoError: the file cannot be written.
    """
    samples = _quantized("write_jpeg", image, 8, channels=(3,))
    picture = Image.fromarray(samples.astype(np.uint8))
    atomic_write(
        path, lambda stream: picture.save(stream, format="JPEG", quality=quality, subsampling=0)
    )


@typed_call
def write_exr(path: Path, image: ImageArray, *, half: bool = False) -> None:
    """Write linear (H, W, 3) or premultiplied (H, W, 4) radiance as float or half EXR; atomic.

    Raises:
        ShapeError, RangeError: wrong channels, empty, non-finite, beyond 65504 in half.
        IoError: the file cannot be written.
    """
    atomic_write(path, exr.encode_exr(_pixels("write_exr", image), half=half))


@typed_call
def write_radiance(path: Path, image: ImageArray) -> None:
    """Write linear (H, W, 3) radiance as the name's end says: .exr, .hdr or .pfm; atomic.

    .exr and .pfm keep float32; .hdr rounds, by 1/256 of a pixel's largest channel at most.

    Raises:
        ShapeError, RangeError: wrong channels, empty, non-finite, below 0 in .hdr.
        IoError: another end of the name, or the file cannot be written.
    """
    encoders: dict[str, Callable[[ImageArray], bytes]] = {
        ".exr": lambda pixels: exr.encode_exr(pixels, half=False),
        ".hdr": encode_rgbe,
        ".pfm": encode_pfm,
    }
    suffix = path.suffix.lower()
    if suffix not in encoders:
        expected = f"a name that ends in {' or '.join(encoders)}"
        raise IoError(message("write_radiance", "path", expected, path.name))
    atomic_write(path, encoders[suffix](_pixels("write_radiance", image)))


def _pixels(function: str, image: ImageArray, channels: tuple[int, ...] = (3, 4)) -> ImageArray:
    shapes = [("H", "W", count) for count in channels]
    return Arguments(function).array("image", image, *shapes, min_length=1)


def _quantized(
    function: str, image: ImageArray, bits: int, channels: tuple[int, ...] = (3, 4)
) -> npt.NDArray[np.uint16]:
    image = _pixels(function, image, channels)
    low, high = float(image.min()), float(image.max())
    if low < 0.0 or high > 1.0:
        got = f"{low:.6g} to {high:.6g}"
        raise RangeError(message(function, "image", "values in 0..1", got, "clip first"))
    levels: npt.NDArray[np.uint16] = np.rint(image.astype(np.float64) * (2**bits - 1)).astype(
        np.uint16
    )
    return levels


def _encode_png16(samples: npt.NDArray[np.uint16]) -> bytes:
    cv2 = import_extra("write_png", "cv2", "png16")
    return bytes(cv2.imencode(".png", samples[..., [2, 1, 0, 3][: samples.shape[2]]])[1])

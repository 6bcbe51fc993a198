"""Frames of a camera path as an animated GIF, or as numbered PNG files."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ..atomic_io import atomic_write
from ..checks import require_number
from ..errors import Error, IoError, ShapeError, message
from .checks import check_images

PALETTE_FRAMES = 8  # frames that the common palette is made from


def write_gif(
    frames: Sequence[NDArray[np.floating]],
    path: Path,
    *,
    frames_per_second: float = 20.0,
    loop: bool = True,
) -> Path:
    """Write an animated GIF with one palette for all frames, so that still parts do not flicker.

    Args:
        frames: display-encoded images (H, W, 3) in [0, 1], float32 or float64; all of one size.
        path: the file to write, whole or not at all; the same frames give the same bytes.
        frames_per_second: 1 to 50. GIF counts in hundredths of a second, so the rate is rounded
            to the nearest it can express.
        loop: start again at the end.

    Raises:
        DtypeError, ShapeError, RangeError: an argument is not as described.
        IoError: the file cannot be written.
        Error: Pillow is not installed.
    """
    images = _same_size("write_gif", frames)
    rate = require_number("write_gif", "frames_per_second", frames_per_second, least=1, most=50)
    pil = _pillow("write_gif")
    pictures = [pil.fromarray(to_bytes(image)) for image in images]
    palette = _common_palette(pil, images)
    # Dithering by Floyd and Steinberg hides the steps of 256 colors in smooth shading.
    indexed = [
        picture.quantize(palette=palette, dither=pil.Dither.FLOYDSTEINBERG) for picture in pictures
    ]
    buffer = io.BytesIO()
    indexed[0].save(
        buffer,
        format="GIF",
        save_all=True,
        append_images=indexed[1:],
        duration=10 * round(100.0 / rate),  # milliseconds, a multiple of 10
        optimize=False,
        disposal=1,  # a frame stays until the next one is drawn over it
        **({"loop": 0} if loop else {}),
    )
    return atomic_write(Path(path), buffer.getvalue())


def write_frames(
    frames: Sequence[NDArray[np.floating]], folder: Path, *, prefix: str = "frame"
) -> list[Path]:
    """Write ``folder/prefix_0000.png`` and so on; the folder is made when it is missing.

    Args:
        frames: display-encoded images (H, W, 3) in [0, 1], float32 or float64; all of one size.
        folder: where to write.
        prefix: the first part of each file name.

    Raises:
        DtypeError, ShapeError, RangeError: an argument is not as described.
        IoError: the folder or a file cannot be written.
        Error: Pillow is not installed.
    """
    images = _same_size("write_frames", frames)
    pil = _pillow("write_frames")
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        got = f"{folder}: {error.strerror}"
        raise IoError(message("write_frames", "folder", "a folder to write in", got)) from error
    paths = []
    for number, image in enumerate(images):
        buffer = io.BytesIO()
        pil.fromarray(to_bytes(image)).save(buffer, format="PNG")
        paths.append(atomic_write(folder / f"{prefix}_{number:04d}.png", buffer.getvalue()))
    return paths


def to_bytes(image: NDArray[np.floating]) -> NDArray[np.uint8]:
    """[0, 1] to 0..255, rounded to the nearest (0.5 up)."""
    return np.floor(image.astype(np.float64) * 255.0 + 0.5).astype(np.uint8)


def _same_size(function: str, frames: Sequence[NDArray[np.floating]]) -> list[NDArray[np.floating]]:
    images = check_images(function, "frames", frames)
    for index, image in enumerate(images):
        if image.shape != images[0].shape:
            expected = f"shape {images[0].shape} as frames[0] has"
            raise ShapeError(message(function, f"frames[{index}]", expected, image.shape))
    return images


def _common_palette(pil: ModuleType, images: list[NDArray[np.floating]]) -> object:
    """A palette image of 256 colors from frames spread evenly over the path."""
    chosen = np.linspace(0, len(images) - 1, min(PALETTE_FRAMES, len(images))).round().astype(int)
    strip = np.concatenate([to_bytes(images[i]) for i in chosen], axis=0)
    return pil.fromarray(strip).quantize(colors=256, method=pil.Quantize.MEDIANCUT)


def _pillow(function: str) -> ModuleType:
    try:
        from PIL import Image
    except ImportError as error:
        raise Error(
            message(function, "Pillow", "the package Pillow", "none", "pip install pillow")
        ) from error
    return Image

"""Videos of rendered frames: .mp4 (H.264) and .webm (VP9), through imageio-ffmpeg.

Its wheel brings the program ffmpeg, which runs beside this one.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.atomic_io import atomic_write

from photograd._arrays import Arguments
from photograd._extras import import_extra
from photograd.errors import IoError, RangeError, message
from photograd.types import Array

_NAME = "write_video"
VIDEOS = (".mp4", ".webm")
_CODECS = {
    ".mp4": ["libx264", "-crf", "18", "-preset", "medium", "-movflags", "+faststart"],
    ".webm": ["libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "0"],
}
_COLORS = "scale=out_color_matrix=bt709:out_range=tv"
_TAGS = ["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1"]
_SAME_BITS = [
    "-threads",
    "1",
    "-fflags",
    "+bitexact",
    "-flags:v",
    "+bitexact",
    "-map_metadata",
    "-1",
]


def write_video(path: Path, frames: Iterable[Array], *, frames_per_second: float = 30.0) -> int:
    """Write frames as they come to an .mp4 or .webm file, whole or not at all; how many there were.

    The colors are those of BT.709 with the sRGB curve, in limited range, one for each 2 x 2 pixels,
    which every browser plays. The same frames give the same bytes.

    Args:
        path: ends in .mp4 or .webm.
        frames: display-encoded images (H, W, 3) in [0, 1], all of one size, H and W even.
        frames_per_second: 1 to 240.

    Raises:
        ShapeError, RangeError: no frames, frames of different or odd sizes, values outside 0..1.
        IoError: another end of the name, a file that cannot be written, or imageio-ffmpeg is not
            installed (extra `video`).
    """
    suffix = path.suffix.lower()
    if suffix not in VIDEOS:
        expected = f"a name that ends in {' or '.join(VIDEOS)}"
        raise IoError(message(_NAME, "path", expected, path.name))
    rate = Arguments(_NAME).number("frames_per_second", frames_per_second, low=1, high=240)
    require_video_writer(_NAME)
    with TemporaryDirectory() as folder:
        encoded = Path(folder) / f"video{suffix}"
        count = _encode(encoded, _bytes_of(frames), rate)
        with encoded.open("rb") as source:
            atomic_write(path, lambda target: shutil.copyfileobj(source, target))
    return count


def require_video_writer(function: str) -> Any:
    """The module imageio_ffmpeg, with the program that it brings.

    Args:
        function: on whose behalf the error speaks.

    Raises:
        IoError: it is not installed, or lacks the program; names the extra that brings it.
    """
    writer = import_extra(function, "imageio_ffmpeg", "video")
    try:
        writer.get_ffmpeg_exe()
    except RuntimeError as failure:
        remedy = "pip install 'photograd[video]'"
        raise IoError(
            message(function, "imageio_ffmpeg", "the program ffmpeg", "none", remedy)
        ) from failure
    return writer


def require_even(function: str, argument: str, width: int, height: int) -> None:
    """Refuse sizes that a video cannot have.

    Args:
        function, argument: on whose behalf, and for what, the error speaks.
        width, height: of the frames, in pixels.

    Raises:
        RangeError: one of them is odd.
    """
    if width % 2 or height % 2:
        expected = "an even width and height, since a video has one color for 2 x 2 pixels"
        raise RangeError(message(function, argument, expected, f"{width} x {height}"))


def _bytes_of(frames: Iterable[Array]) -> Iterator[NDArray[np.uint8]]:
    call = Arguments(_NAME)  # which holds all frames to the size of the first
    for number, frame in enumerate(frames):
        name = f"frames[{number}]"
        image = call.array(
            name, frame, ("H", "W", 3), dtype=np.float64, low=0, high=1, min_length=1
        )
        require_even(_NAME, name, image.shape[1], image.shape[0])
        yield np.floor(image * 255.0 + 0.5).astype(np.uint8)


def _encode(path: Path, frames: Iterator[NDArray[np.uint8]], rate: float) -> int:
    first = next(frames, None)
    if first is None:
        raise RangeError(message(_NAME, "frames", "at least one frame", "none"))
    codec, *options = _CODECS[path.suffix]
    encoder = require_video_writer(_NAME).write_frames(
        path,
        (first.shape[1], first.shape[0]),
        fps=Fraction(rate).limit_denominator(1001),
        codec=codec,
        quality=None,
        macro_block_size=1,
        ffmpeg_log_level="error",
        output_params=[*options, "-vf", _COLORS, *_TAGS, *_SAME_BITS],
    )
    try:
        encoder.send(None)
        encoder.send(first)
        count = 1
        for frame in frames:
            encoder.send(frame)
            count += 1
    except OSError as failure:  # its text is the log of ffmpeg
        raise IoError(message(_NAME, "ffmpeg", "an encoded video", failure)) from failure
    finally:
        encoder.close()
    if not path.is_file() or not path.stat().st_size:
        raise IoError(message(_NAME, "ffmpeg", "an encoded video", "no file"))
    return count

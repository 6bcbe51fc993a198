"""What kind of image a file is, as its first bytes say, and how many pixels it may have.

Only these kinds are ever opened. Pillow knows many more, and hands some, such as PostScript, to
other programs.
"""

from __future__ import annotations

from pathlib import Path

from photograd_course.input_files import read_file
from photograd_course.limits import PIXELS
from PIL import Image

from photograd.errors import IoError, message

_READ = {
    b"\x89PNG\r\n\x1a\n": "PNG",
    b"\xff\xd8\xff": "JPEG",
    b"v/1\x01": "EXR",
    b"#?": "HDR",
    b"PF": "PFM",
    b"Pf": "PFM",
}
_OTHERS = {
    b"GIF8": "GIF",
    b"II*\0": "TIFF",
    b"MM\0*": "TIFF",
    b"BM": "BMP",
    b"%!PS": "PostScript",
    b"\xc5\xd0\xd3\xc6": "PostScript",
    b"%PDF": "PDF",
    b"RIFF": "WebP",
    b"\0\0\0\x0cjP": "JPEG 2000",
    b"P5": "PGM",
    b"P6": "PPM",
    b"<svg": "SVG",
    b"8BPS": "Photoshop",
}
PILLOW_KINDS = ("PNG", "JPEG")
LINEAR_KINDS = ("EXR", "HDR", "PFM")
LINEAR_SUFFIXES = (".exr", ".hdr", ".pfm")
KINDS = (*PILLOW_KINDS, *LINEAR_KINDS)


def image_kind(function: str, path: Path, kinds: tuple[str, ...] = KINDS) -> str:
    """Which of `kinds` a file is.

    Args:
        function: reader on whose behalf errors speak.
        path: the file.
        kinds: of `KINDS`: "PNG", "JPEG", "EXR", "HDR" (Radiance) or "PFM".

    Raises:
        IoError: no file, or none of these; names what it is instead, if that is known.
    """
    head = read_file(function, path, 16)
    for known, read in ((_READ, True), (_OTHERS, False)):
        for start, kind in known.items():
            if head.startswith(start):
                if read and kind in kinds:
                    return kind
                raise _refusal(function, path, kinds, f"{kind} data")
    if head[4:8] == b"ftyp":
        raise _refusal(function, path, kinds, "HEIC, AVIF or video data")
    raise _refusal(function, path, kinds, f"data that begins with {head[:8]!r}")


def _refusal(function: str, path: Path, kinds: tuple[str, ...], got: str) -> IoError:
    expected = f"a readable image ({', '.join(kinds)})"
    return IoError(message(function, f"{path}", expected, got, "convert it first"))


# How many pixels an image may have, asked of its header: a few kB can decode to gigabytes.


MAX_SIDE = 1 << 16


def require_size(function: str, where: str, width: int, height: int, channels: int = 4) -> None:
    """Refuse an image whose header states sides or pixels beyond reason, before it is decoded.

    Args:
        function: reader on whose behalf errors speak.
        where: the file.
        width, height: as the header states them.
        channels: as `require_pixels` counts them.

    Raises:
        IoError: a side below 1 or above 65536 pixels, or more than `require_pixels` allows.
    """
    if not (0 < width <= MAX_SIDE and 0 < height <= MAX_SIDE):
        got = f"{width} x {height}"
        raise IoError(message(function, where, f"1 to {MAX_SIDE} pixels a side", got))
    require_pixels(function, where, width, height, channels)


def require_pixels(function: str, where: str, width: int, height: int, channels: int = 4) -> None:
    """Refuse an image with more pixels than `PHOTOGRAD_MAX_PIXELS`, by default 2^27.

    Args:
        function: reader on whose behalf errors speak.
        where: the file.
        width, height: as the header states them.
        channels: beyond four, they count as more pixels.

    Raises:
        IoError: it has more.
    """
    if width * height * max(channels, 4) > 4 * PIXELS.value():
        more = f" of {channels} channels" if channels > 4 else ""
        raise too_many_pixels(function, where, f"{width} x {height} = {width * height:,}{more}")


def too_many_pixels(function: str, where: str, got: object) -> IoError:
    """The error of an image beyond the limit; `got` may be Pillow's own, which names the size."""
    return IoError(message(function, where, PIXELS.expected(), got, PIXELS.remedy()))


def allow_pixels() -> None:
    """Let Pillow open what `require_pixels` allows; call it before `Image.open`.

    Pillow has a limit of its own, one for the process: it warns from 89 million pixels on and
    refuses twice as many. It is raised to ours and never lowered.
    """
    own = Image.MAX_IMAGE_PIXELS
    if own is not None:
        Image.MAX_IMAGE_PIXELS = max(own, PIXELS.value())

"""How many pixels an image may have, asked of its header: a few kB can decode to gigabytes."""

from __future__ import annotations

from photograd_course.limits import PIXELS
from PIL import Image

from photograd.errors import IoError, message

LARGEST_SIDE = 1 << 16


def require_size(function: str, place: str, width: int, height: int, channels: int = 4) -> None:
    """Refuse an image whose header states sides or pixels beyond reason, before it is decoded.

    Args:
        function: reader on whose behalf errors speak.
        place: the file.
        width, height: as the header states them.
        channels: as `require_pixels` counts them.

    Raises:
        IoError: a side below 1 or above 65536 pixels, or more than `require_pixels` allows.
    """
    if not (0 < width <= LARGEST_SIDE and 0 < height <= LARGEST_SIDE):
        got = f"{width} x {height}"
        raise IoError(message(function, place, f"1 to {LARGEST_SIDE} pixels a side", got))
    require_pixels(function, place, width, height, channels)


def require_pixels(function: str, place: str, width: int, height: int, channels: int = 4) -> None:
    """Refuse an image with more pixels than `PHOTOGRAD_MAX_PIXELS`, by default 2^27.

    Args:
        function: reader on whose behalf errors speak.
        place: the file.
        width, height: as the header states them.
        channels: beyond four, they count as more pixels.

    Raises:
        IoError: it has more.
    """
    if width * height * max(channels, 4) > 4 * PIXELS.value():
        more = f" of {channels} channels" if channels > 4 else ""
        raise too_many_pixels(function, place, f"{width} x {height} = {width * height:,}{more}")


def too_many_pixels(function: str, place: str, got: object) -> IoError:
    """The error of an image beyond the limit; `got` may be Pillow's own, which names the size."""
    return IoError(message(function, place, PIXELS.expected(), got, PIXELS.remedy()))


def allow_pixels() -> None:
    """Let Pillow open what `require_pixels` allows; call it before `Image.open`.

    Pillow has a limit of its own, one for the process: it warns from 89 million pixels on and
    refuses twice as many. It is raised to ours and never lowered.
    """
    own = Image.MAX_IMAGE_PIXELS
    if own is not None:
        Image.MAX_IMAGE_PIXELS = max(own, PIXELS.value())

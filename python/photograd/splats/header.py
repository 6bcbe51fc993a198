"""How a file's Gaussians are meant to be shown, as comments in the header of a .ply file.

    comment photograd: up -y
    comment photograd: background 0.25 0.5 0.75
    comment photograd: antialiased no

Other programs leave such lines unread. The background is in display values, as the colors are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.color import srgb_encode

from photograd.errors import IoError, message
from photograd.splats.frames import UP_AXES
from photograd.types import Array

MARK = "photograd:"
_SAID = {"yes": True, "no": False}


@dataclass(frozen=True)
class Presentation:
    """What a file says of showing its Gaussians; None where it says nothing.

    Attributes:
        up: the axis of its frame that points up, of `UP_AXES`.
        background: red, green and blue behind everything, display values in 0..1.
        antialiased: whether they were fitted with `SplatOptions.antialiased`.
    """

    up: str | None = None
    background: tuple[float, float, float] | None = None
    antialiased: bool | None = None

    @classmethod
    def of_fit(cls, up: str, background: Array | None, *, antialiased: bool) -> Presentation:
        """Of fitted Gaussians: `background` (3,) is linear, as it was learned, or None."""
        if background is None:
            return cls(up, None, antialiased)
        red, green, blue = srgb_encode(np.asarray(background, np.float64)).clip(0.0, 1.0).tolist()
        return cls(up, (red, green, blue), antialiased)

    def comments(self) -> list[str]:
        """The lines of a .ply header, without the word "comment"; read back, the same numbers."""
        lines = []
        if self.up is not None:
            lines.append(f"up {self.up}")
        if self.background is not None:
            lines.append("background " + " ".join(repr(float(x)) for x in self.background))
        if self.antialiased is not None:
            lines.append(f"antialiased {'yes' if self.antialiased else 'no'}")
        return [f"{MARK} {line}" for line in lines]

    def sentences(self) -> list[str]:
        """The same for the log."""
        lines = [] if self.up is None else [f"{self.up} is up"]
        if self.background is not None:
            lines.append(f"background {_shown(self.background)}")
        return lines


UNSTATED = Presentation()


def read_presentation(function: str, path: Path, head: bytes) -> Presentation:
    """What the comments in the header of a .ply file say.

    Args:
        function, path: for the error.
        head: the file's start, its header included.

    Raises:
        IoError: a comment of ours with a value that is none.
    """
    told: dict[str, Any] = {}
    for line in head.partition(b"end_header")[0].decode("latin-1").splitlines():
        words = line.split()
        if words[:2] != ["comment", MARK] or len(words) < 3 or words[2] not in _VALUES:
            continue  # another program's, or of a later version
        name, (read, expected) = words[2], _VALUES[words[2]]
        told[name] = read(words[3:])
        if told[name] is None:
            expected = f"'{MARK} {name}' with {expected}"
            raise IoError(message(function, f"{path}", expected, repr(line.strip())))
    return Presentation(**told)


def dropped(suffix: str, presentation: Presentation) -> list[str]:
    """Sentences on what a file whose name ends in `suffix` has no place for.

    Up is none of it: files of other formats have one axis up.
    """
    if suffix == ".ply":
        return []
    lines = []
    if presentation.background is not None:
        lines.append(f"the background {_shown(presentation.background)} (display values)")
    antialiased = presentation.antialiased
    if antialiased is not None and not (antialiased and suffix == ".spz"):
        lines.append(f"that they were fitted with{'' if antialiased else 'out'} antialiasing")
    return [f"{line} is dropped: {suffix} files have no place for it" for line in lines]


def _axis(words: list[str]) -> str | None:
    return words[0] if len(words) == 1 and words[0] in UP_AXES else None


def _color(words: list[str]) -> tuple[float, float, float] | None:
    try:
        red, green, blue = (float(word) for word in words)
    except ValueError:
        return None
    inside = all(np.isfinite(x) and 0.0 <= x <= 1.0 for x in (red, green, blue))
    return (red, green, blue) if inside else None


_VALUES: dict[str, tuple[Callable[[list[str]], object], str]] = {
    "up": (_axis, f"one of {', '.join(UP_AXES)}"),
    "background": (_color, "three numbers in 0..1"),
    "antialiased": (lambda words: _SAID.get(" ".join(words)), "yes or no"),
}


def _shown(color: tuple[float, float, float]) -> str:
    return " ".join(f"{x:.3f}" for x in color)

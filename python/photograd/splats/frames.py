"""Which axis of a file of Gaussians points up, and how its header says that they are shown.

The world of this project has +Y up. Files of Gaussians usually have -y up: their frame is that of
structure from motion, y down and z forward, half a turn about x away.

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

from photograd import sh
from photograd.capture.frames import rotation_from_quaternion
from photograd.errors import IoError, RangeError, message
from photograd.splats.splatting import Gaussians
from photograd.types import Array

UP_AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
USUAL_UP = "-y"
WORLD_UP = "+y"


def file_from_upright(up: str) -> Array:
    """(3, 3) rotation from a frame with +Y up to one in which `up`, such as "-y", points up.

    About x where that is possible: for "-y" it is the half turn, for "+y" the identity.

    Raises:
        RangeError: no axis of that name.
    """
    y = _axis("file_from_upright", up)
    if y[0] == 0.0:
        x = np.eye(3)[0]
        return np.stack([x, y, np.cross(x, y)], axis=1)
    z = np.eye(3)[2]
    return np.stack([np.cross(y, z), y, z], axis=1)


def half_turn(gaussians: Gaussians) -> Gaussians:
    """The Gaussians after half a turn about x, which is its own inverse, to the bit.

    Their axes turn too and are then reversed in y and z, which changes no Gaussian: the quaternion
    (w, x, y, z) becomes (w, x, -y, -z). A harmonic keeps its sign or changes it.

    Args:
        gaussians: in any frame.
    """
    flips = np.array([1, -1, -1], gaussians.means.dtype)
    turn = sh.rotation(np.diag([1.0, -1.0, -1.0]), gaussians.degree)
    signs = np.rint(np.diag(turn)).astype(flips.dtype)
    return Gaussians(
        means=gaussians.means * flips,
        log_scales=gaussians.log_scales,
        quats=gaussians.quats * np.array([1, 1, -1, -1], flips.dtype),
        opacity_logits=gaussians.opacity_logits,
        sh=gaussians.sh * signs[:, None],
    )


def with_usual_up(gaussians: Gaussians, up: str) -> Gaussians:
    """Gaussians in whose frame `up` points up, rotated as a whole so that -y does.

    Args:
        gaussians: in any frame.
        up: the axis, such as "+y".

    Raises:
        RangeError: no axis of that name.
    """
    source, target = _axis("with_usual_up", up), _axis("with_usual_up", USUAL_UP)
    if source @ target < 0.0:
        return half_turn(gaussians)
    # From one direction to another the shorter way; of length one where they agree.
    turn = np.array([1.0 + source @ target, *np.cross(source, target)])
    return _rotated(gaussians, turn / np.linalg.norm(turn))


def _rotated(gaussians: Gaussians, turn: Array) -> Gaussians:
    """The Gaussians turned by a unit quaternion (4,): means, axes and harmonics."""
    rotation = rotation_from_quaternion(turn)
    w, x, y, z = turn
    product = np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])
    of_harmonics = sh.rotation(rotation, gaussians.degree)
    dtype = gaussians.means.dtype
    return Gaussians(
        means=(gaussians.means @ rotation.T).astype(dtype),
        log_scales=gaussians.log_scales,
        quats=(gaussians.quats @ product.T).astype(dtype),
        opacity_logits=gaussians.opacity_logits,
        sh=np.einsum("jk,nkc->njc", of_harmonics, gaussians.sh).astype(dtype),
    )


def _axis(function: str, up: str) -> Array:
    if up not in UP_AXES:
        raise RangeError(message(function, "up", f"one of {', '.join(UP_AXES)}", up))
    sign = 1.0 if up[0] == "+" else -1.0
    return np.asarray(sign * np.eye(3)["xyz".index(up[1])])


# How a file's Gaussians are meant to be shown, as comments in the header of a .ply file.


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
        """Of fitted Gaussians: `background` (3,) is linear, as it was learned, or None.

        Args:
            up: the axis that points up, such as "+y".
            background: (3,), or None.
            antialiased: whether the low-pass keeps the light of each Gaussian.
        """
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

    Args:
        suffix: of the file's name.
        presentation: of the Gaussians.
    """
    if suffix == ".ply":
        return []
    lines = []
    if presentation.background is not None:
        lines.append(f"the background {_shown(presentation.background)} (display values)")
    antialiased = presentation.antialiased
    if antialiased is not None and not (antialiased and suffix in (".spz", ".sog")):
        lines.append(f"that they were fitted with{'' if antialiased else 'out'} antialiasing")
    return [f"{line} is dropped: {suffix} files have no place for it" for line in lines]


def _up_axis(words: list[str]) -> str | None:
    return words[0] if len(words) == 1 and words[0] in UP_AXES else None


def _color(words: list[str]) -> tuple[float, float, float] | None:
    try:
        red, green, blue = (float(word) for word in words)
    except ValueError:
        return None
    inside = all(np.isfinite(x) and 0.0 <= x <= 1.0 for x in (red, green, blue))
    return (red, green, blue) if inside else None


_VALUES: dict[str, tuple[Callable[[list[str]], object], str]] = {
    "up": (_up_axis, f"one of {', '.join(UP_AXES)}"),
    "background": (_color, "three numbers in 0..1"),
    "antialiased": (lambda words: _SAID.get(" ".join(words)), "yes or no"),
}


def _shown(color: tuple[float, float, float]) -> str:
    return " ".join(f"{x:.3f}" for x in color)

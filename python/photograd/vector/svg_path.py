"""The language of SVG's path data, and of its transforms [SVG 1.1, Sect. 8.3 and 7.6]."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np

from photograd.errors import IoError, message
from photograd.types import FloatArray
from photograd.vector.shapes import Subpath

_NUMBER = re.compile(r"[\s,]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)")
_FLAG = re.compile(r"[\s,]*([01])")
_COMMAND = re.compile(r"[\s,]*([MmLlHhVvCcSsQqTtAaZz])")
_TRANSFORM = re.compile(r"[\s,]*(\w+)\s*\(([^()]*)\)")
_ARGUMENTS = {"m": 2, "l": 2, "h": 1, "v": 1, "c": 6, "s": 4, "q": 4, "t": 2, "a": 7, "z": 0}
IDENTITY = np.array([[1.0, 0, 0], [0, 1, 0]])
"""(2, 3) of x' = M (x, y, 1)."""

Point = tuple[float, float]


def path_subpaths(text: str) -> list[Subpath]:
    """The subpaths of an attribute `d`; arcs become cubic curves.

    Args:
        text: the attribute.

    Raises:
        IoError: what is no path data.
        RangeError: coordinates beyond a million.
    """
    reader = _PathReader(text)
    reader.read()
    return reader.finished


def numbers(text: str, what: str) -> list[float]:
    """Numbers between commas and spaces.

    Args:
        text: with numbers.
        what: it is, for errors.

    Raises:
        IoError: something else among them.
    """
    found, at = [], 0
    while match := _NUMBER.match(text, at):
        found.append(float(match[1]))
        at = match.end()
    if text[at:].strip(" \t\r\n,"):
        raise refused(what, "numbers", text[at : at + 20])
    return found


def refused(where: str, expected: str, got: object) -> IoError:
    """The error for a file that is not read.

    Args:
        where: in the file.
        expected: what is read.
        got: what stands there.
    """
    return IoError(message("read_svg", where, expected, repr(got)))


def transform(text: str) -> FloatArray:
    """The (2, 3) matrix of an attribute `transform`.

    Args:
        text: the attribute.

    Raises:
        IoError: what is no list of transforms.
    """
    matrix, at = IDENTITY, 0
    while match := _TRANSFORM.match(text, at):
        matrix = compose(matrix, _one_transform(match[1], numbers(match[2], "transform")))
        at = match.end()
    if text[at:].strip(" \t\r\n,"):
        raise refused("transform", "transforms", text[at : at + 20])
    return matrix


def compose(outer: FloatArray, inner: FloatArray) -> FloatArray:
    """The (2, 3) matrix of `outer` after `inner`."""
    rows: FloatArray = np.einsum("ij,jk->ik", outer[:, :2], inner)
    rows[:, 2] += outer[:, 2]
    return rows


def applied(matrix: FloatArray, points: FloatArray) -> FloatArray:
    """(N, 2) `points` moved by a (2, 3) `matrix`."""
    moved: FloatArray = np.einsum("ij,nj->ni", matrix[:, :2], points) + matrix[:, 2]
    return moved


def _one_transform(name: str, v: list[float]) -> FloatArray:
    count = len(v)
    if name == "matrix" and count == 6:
        return np.array(v).reshape(3, 2).T
    if name == "translate" and count in (1, 2):
        return np.array([[1.0, 0, v[0]], [0, 1, v[1] if count == 2 else 0]])
    if name == "scale" and count in (1, 2):
        return np.array([[v[0], 0, 0], [0, v[-1], 0]])
    if name == "rotate" and count in (1, 3):
        c, s = math.cos(math.radians(v[0])), math.sin(math.radians(v[0]))
        about = np.array(v[1:] or [0.0, 0.0])
        turn = np.array([[c, -s], [s, c]])
        return np.concatenate([turn, (about - np.einsum("ij,j->i", turn, about))[:, None]], axis=1)
    if name in ("skewX", "skewY") and count == 1:
        slant = math.tan(math.radians(v[0]))
        return np.array([[1.0, slant if name == "skewX" else 0, 0], [0, 1, 0]]) + (
            np.array([[0, 0, 0], [slant, 0, 0]]) if name == "skewY" else 0
        )
    raise refused("transform", "a transform of SVG", f"{name} of {count} numbers")


class _PathReader:
    """Reads commands one after the other; keeps the point that was reached."""

    def __init__(self, text: str) -> None:
        self.text, self.at = text.strip(" \t\r\n,"), 0
        self.finished: list[Subpath] = []
        self.points: list[Point] = []
        self.degrees: list[int] = []
        self.start: Point = (0.0, 0.0)
        self.here: Point = (0.0, 0.0)
        self.control: Point | None = None  # the last one of a curve, for S and T
        self.before = ""

    def read(self) -> None:
        command = ""
        while self.at < len(self.text):
            match = _COMMAND.match(self.text, self.at)
            if match:
                command, self.at = match[1], match.end()
            elif not command or command in "Zz":
                raise refused("d", "a command of path data", self.text[self.at : self.at + 20])
            if not self.before and command not in "Mm":
                raise refused("d", "a path that begins with M", command)
            self._run(command)
            self.before = command.lower()
            command = {"M": "L", "m": "l"}.get(command, command)
        self._end(closed=False)

    def _run(self, command: str) -> None:
        kind = command.lower()
        v = [self._argument(kind, k) for k in range(_ARGUMENTS[kind])]
        if command.islower():
            v = self._absolute(kind, v)
        if kind == "m":
            self._end(closed=False)
            self.start = self.here = (v[0], v[1])
        elif kind == "z":
            self._end(closed=True)
            self.here = self.start
        else:
            if not self.points:
                self.points = [self.here]
            _CURVES[kind](self, v)

    def _argument(self, kind: str, k: int) -> float:
        match = (_FLAG if kind == "a" and k in (3, 4) else _NUMBER).match(self.text, self.at)
        if not match:
            raise refused(
                "d", f"{_ARGUMENTS[kind]} numbers after {kind}", self.text[self.at :][:20]
            )
        self.at = match.end()
        return float(match[1])

    def _absolute(self, kind: str, v: list[float]) -> list[float]:
        x, y = self.here
        if kind == "h":
            return [v[0] + x]
        if kind == "v":
            return [v[0] + y]
        if kind == "a":
            return [*v[:5], v[5] + x, v[6] + y]
        return [each + (x, y)[k % 2] for k, each in enumerate(v)]

    def curve(self, *points: Point) -> None:
        """Add a curve from where the path is; the last point is reached."""
        self.points.extend(points)
        self.degrees.append(len(points))
        self.here = points[-1]

    def reflected(self, kinds: str) -> Point:
        """The last control point, mirrored at the point reached, after curves of these kinds."""
        if self.control is None or self.before not in kinds:
            return self.here
        return 2 * self.here[0] - self.control[0], 2 * self.here[1] - self.control[1]

    def _end(self, *, closed: bool) -> None:
        if not self.points:
            return
        if closed and self.here != self.start:
            self.curve(self.start)
        points = np.array(self.points)
        self.finished.append(
            Subpath(points[:-1] if closed else points, tuple(self.degrees), closed)
        )
        self.points, self.degrees = [], []


def _cubic(path: _PathReader, v: list[float]) -> None:
    path.control = (v[2], v[3])
    path.curve((v[0], v[1]), (v[2], v[3]), (v[4], v[5]))


def _smooth_cubic(path: _PathReader, v: list[float]) -> None:
    _cubic(path, [*path.reflected("cs"), *v])


def _quadratic(path: _PathReader, v: list[float]) -> None:
    path.control = (v[0], v[1])
    path.curve((v[0], v[1]), (v[2], v[3]))


def _smooth_quadratic(path: _PathReader, v: list[float]) -> None:
    _quadratic(path, [*path.reflected("qt"), *v])


def _arc(path: _PathReader, v: list[float]) -> None:
    """From end points to a center and angles [SVG 1.1, F.6.5], then a cubic a quarter."""
    (x0, y0), (x1, y1) = path.here, v[5:]
    rx, ry = abs(v[0]), abs(v[1])
    if (x0, y0) == (x1, y1):
        return
    if rx == 0 or ry == 0:
        path.curve((x1, y1))
        return
    turn = math.radians(v[2])
    c, s = math.cos(turn), math.sin(turn)
    dx, dy = (x0 - x1) / 2, (y0 - y1) / 2
    u, w = (c * dx + s * dy) / rx, (c * dy - s * dx) / ry  # on the unit circle
    square = u * u + w * w
    if square > 1:  # too small to reach the end: just large enough
        root = math.sqrt(square)
        rx, ry, u, w, square = rx * root, ry * root, u / root, w / root, 1.0
    lift = math.sqrt(max(1 / square - 1, 0)) * (-1 if bool(v[3]) == bool(v[4]) else 1)
    cu, cw = lift * w, -lift * u
    first, last = math.atan2(w - cw, u - cu), math.atan2(-w - cw, -u - cu)
    sweep = last - first
    sweep += 2 * math.pi if v[4] and sweep < 0 else -2 * math.pi if not v[4] and sweep > 0 else 0
    pieces = max(1, math.ceil(abs(sweep) / (math.pi / 2) - 1e-9))
    reach = 4 / 3 * math.tan(sweep / pieces / 4)

    def point(u: float, w: float) -> Point:
        a, b = rx * (u + cu), ry * (w + cw)
        return c * a - s * b + (x0 + x1) / 2, s * a + c * b + (y0 + y1) / 2

    for k in range(pieces):
        a, b = first + sweep * k / pieces, first + sweep * (k + 1) / pieces
        ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
        end = (x1, y1) if k == pieces - 1 else point(cb, sb)
        leaves, arrives = (ca - reach * sa, sa + reach * ca), (cb + reach * sb, sb - reach * cb)
        path.curve(point(*leaves), point(*arrives), end)


_CURVES: dict[str, Callable[[_PathReader, list[float]], None]] = {
    "l": lambda path, v: path.curve((v[0], v[1])),
    "h": lambda path, v: path.curve((v[0], path.here[1])),
    "v": lambda path, v: path.curve((path.here[0], v[0])),
    "c": _cubic,
    "s": _smooth_cubic,
    "q": _quadratic,
    "t": _smooth_quadratic,
    "a": _arc,
}

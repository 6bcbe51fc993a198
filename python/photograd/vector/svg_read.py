"""SVG files to drawings: a stated part of SVG 1.1, and clear refusals of the rest.

Read are svg, g, path, rect, circle, ellipse, line, polyline, polygon, linear and radial gradients,
presentation attributes and `style`, transforms, viewBox. Text, images, use, clips, masks, filters,
style sheets, dashes, patterns, and opacity of groups are refused, since leaving them out would draw
something else. Titles, descriptions, metadata and elements of other namespaces are skipped.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import numpy as np
from photograd_course.color import srgb_decode
from photograd_course.limits import EXPANSION
from PIL import ImageColor

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import FloatArray
from photograd.vector.drawing import Drawing
from photograd.vector.flatten import bernstein
from photograd.vector.shapes import (
    CAPS,
    JOINS,
    LARGEST,
    RULES,
    Cap,
    FillRule,
    Join,
    LinearGradient,
    Paint,
    RadialGradient,
    Shape,
    Solid,
    Stroke,
    Subpath,
)
from photograd.vector.svg_path import (
    IDENTITY,
    applied,
    compose,
    numbers,
    path_subpaths,
    refused,
    transform,
)
from photograd.vector.svg_tree import Element, read_tree

SKIPPED = {"title", "desc", "metadata", "defs", "linearGradient", "radialGradient"}
INHERITED = {
    "fill": "black",
    "fill-rule": "nonzero",
    "fill-opacity": "1",
    "stroke": "none",
    "stroke-width": "1",
    "stroke-opacity": "1",
    "stroke-linecap": "butt",
    "stroke-linejoin": "miter",
    "stroke-miterlimit": "4",
    "stroke-dasharray": "none",
    "color": "black",
    "visibility": "visible",
}
REFUSED = ("clip-path", "mask", "filter")
BYTES_OF_A_PIXEL = 32
"""Of the picture that a drawing of the file's size makes."""
BOX_SEGMENTS, BOX_CURVES = 256, 1024
"""Of a curve, to find its box; of curves that are looked at together."""
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(px|%)?\s*")


@typed_call
@dataclass(frozen=True, eq=False)
class SvgFile:
    """What a file holds.

    Attributes:
        drawing: in pixels of its own size.
        size: (height, width) in pixels, rounded up.
    """

    drawing: Drawing
    size: tuple[int, int]


@typed_call
def read_svg(source: str | Path | bytes, *, linear: bool = True) -> SvgFile:
    """Read an SVG file.

    Args:
        source: path of the file, or its bytes.
        linear: decode colors to linear values; False keeps sRGB values, which viewers of SVG
            composite, so that pictures agree with theirs.

    Raises:
        IoError: not there, damaged, too large, with entities or references to other files, or with
            something that is not read; names it.
        RangeError: numbers out of range.
    """
    root = read_tree(source)
    width, height, to_pixels = _viewport(root)
    reader = _Reader(root, linear=linear)
    reader.walk(root, to_pixels, INHERITED)
    return SvgFile(Drawing.of(reader.shapes), (math.ceil(height), math.ceil(width)))


def _viewport(root: Element) -> tuple[float, float, FloatArray]:
    box = root.attributes.get("viewBox")
    view = numbers(box, "viewBox") if box is not None else None
    if view is not None and (len(view) != 4 or min(view[2:]) <= 0):
        raise refused("viewBox", "four numbers, a width and a height above 0", box)
    sizes = []
    for k, name in enumerate(("width", "height")):
        text = root.attributes.get(name, "100%")
        if text.strip().endswith("%"):
            if view is None:
                raise refused(name, "a width and a height in pixels, or a viewBox", text)
            sizes.append(view[2 + k])
        else:
            sizes.append(_length(text, name))
    call = Arguments("read_svg")
    width, height = (call.number("size", each, above=0, high=LARGEST) for each in sizes)
    _require_expansion("width times height", BYTES_OF_A_PIXEL * width * height)
    if view is None:
        return width, height, IDENTITY
    scale = min(width / view[2], height / view[3])
    shift = [(size - scale * v) / 2 for size, v in ((width, view[2]), (height, view[3]))]
    matrix = np.array(
        [[scale, 0, shift[0] - scale * view[0]], [0, scale, shift[1] - scale * view[1]]]
    )
    return width, height, matrix


def _require_expansion(what: str, size: float) -> None:
    """Raise RangeError for what takes more memory than a file may ask for without holding it."""
    if size > EXPANSION.value():
        got = f"{size:,.0f}"
        raise RangeError(message("read_svg", what, EXPANSION.expected(), got, EXPANSION.remedy()))


def _length(text: str, what: str) -> float:
    match = _LENGTH.fullmatch(text)
    if not match or match[2] == "%":
        raise refused(what, "a number of pixels", text)
    return float(match[1])


class _Reader:
    """Collects shapes of elements, the first at the bottom."""

    def __init__(self, root: Element, *, linear: bool) -> None:
        self.shapes: list[Shape] = []
        self._linear = linear
        self._by_id: dict[str, Element] = {}
        self._stops_of: dict[int, tuple[FloatArray, FloatArray]] = {}
        self._stop_bytes = 0
        waiting = [root]
        while waiting:
            element = waiting.pop()
            self._by_id.setdefault(element.attributes.get("id", ""), element)
            waiting += element.children

    def walk(self, element: Element, outer: FloatArray, inherited: dict[str, str]) -> None:
        """The shapes of an element and of those in it."""
        tag, own = element.tag, element.attributes
        if tag in SKIPPED or " " in tag or own.get("display") == "none":
            return
        for name in REFUSED:
            if own.get(name, "none") != "none":
                raise refused(tag, f"an element without {name}", own[name][:40])
        style = {k: own.get(k, v) if own.get(k) != "inherit" else v for k, v in inherited.items()}
        matrix = compose(outer, transform(own.get("transform", "")))
        if tag in ("svg", "g"):
            if _share(own.get("opacity", "1"), "opacity") != 1:
                raise refused(tag, "a group without opacity", own["opacity"])
            for child in element.children:
                if child.tag == "svg":
                    raise refused("svg", "one element svg", "another in it")
                self.walk(child, matrix, style)
            return
        paths = _outline(element)
        if style["visibility"] == "visible" and paths:
            self._add(tag, paths, matrix, style, _share(own.get("opacity", "1"), "opacity"))

    def _add(
        self,
        tag: str,
        paths: list[Subpath],
        matrix: FloatArray,
        style: dict[str, str],
        opacity: float,
    ) -> None:
        if style["stroke-dasharray"] != "none":
            raise refused(tag, "strokes without dashes", style["stroke-dasharray"])
        width = _length(style["stroke-width"], "stroke-width")
        parts = [style["fill"] != "none", style["stroke"] != "none" and width > 0]
        if all(parts) and opacity != 1:
            raise refused(tag, "opacity of a fill or a stroke, not of both", opacity)
        moved = [replace(path, points=applied(matrix, path.points)) for path in paths]
        if parts[0]:
            rule = _choice(style["fill-rule"], RULES, "fill-rule")
            paint = self._paint(style, "fill", paths, matrix)
            alpha = opacity * _share(style["fill-opacity"], "fill-opacity")
            self.shapes.append(Shape(tuple(moved), paint, alpha, cast(FillRule, rule)))
        if parts[1]:
            limit = _length(style["stroke-miterlimit"], "stroke-miterlimit")
            stroke = Stroke(
                width * _scale(matrix, "stroke"),
                cast(Cap, _choice(style["stroke-linecap"], CAPS, "stroke-linecap")),
                cast(Join, _choice(style["stroke-linejoin"], JOINS, "stroke-linejoin")),
                limit,
            )
            paint = self._paint(style, "stroke", paths, matrix)
            alpha = opacity * _share(style["stroke-opacity"], "stroke-opacity")
            self.shapes.append(Shape(tuple(moved), paint, alpha, stroke=stroke))

    def _paint(
        self, style: dict[str, str], name: str, paths: list[Subpath], matrix: FloatArray
    ) -> Paint:
        text = style[name]
        if not text.startswith("url("):
            rgb = self._color(style["color"] if text == "currentColor" else text, name)
            return Solid(rgb)
        target = self._by_id.get(text[4:].split(")")[0].strip(" '\"#"))
        if target is None or target.tag not in ("linearGradient", "radialGradient"):
            raise refused(name, "a gradient of this file", text)
        return self._gradient(target, paths, matrix)

    def _gradient(self, element: Element, paths: list[Subpath], matrix: FloatArray) -> Paint:
        own = element.attributes
        if own.get("spreadMethod", "pad") != "pad":
            raise refused(element.tag, "spreadMethod pad", own["spreadMethod"])
        if any(name.endswith("href") for name in own):
            raise refused(element.tag, "a gradient with stops of its own", "a reference")
        boxed = own.get("gradientUnits", "objectBoundingBox") == "objectBoundingBox"
        unit = _bounding_box(paths) if boxed else IDENTITY
        matrix = compose(compose(matrix, unit), transform(own.get("gradientTransform", "")))
        offsets, colors = self._stops(element)

        def number(name: str, share: str) -> float:
            text = own.get(name, share if boxed else "")
            if boxed and text.strip().endswith("%"):
                return _length(text.strip()[:-1], name) / 100
            if not text:
                raise refused(element.tag, f"{name} in pixels", "none")
            return _length(text, name)

        if element.tag == "linearGradient":
            ends = [
                [number("x1", "0%"), number("y1", "0%")],
                [number("x2", "100%"), number("y2", "0%")],
            ]
            return LinearGradient(*_moved_line(matrix, np.array(ends)), offsets, colors)
        center = np.array([[number("cx", "50%"), number("cy", "50%")]])
        for name, k in (("fx", 0), ("fy", 1)):
            if name in own and number(name, "50%") != center[0, k]:
                raise refused(element.tag, "a focus at the center", own[name])
        radius = number("r", "50%") * _scale(matrix, "gradient")
        return RadialGradient(applied(matrix, center)[0], radius, offsets, colors)

    def _stops(self, element: Element) -> tuple[FloatArray, FloatArray]:
        """Offsets and colors; shapes may share a gradient, which is read once."""
        if id(element) not in self._stops_of:
            self._stops_of[id(element)] = self._read_stops(element)
        offsets, colors = self._stops_of[id(element)]
        self._stop_bytes += offsets.nbytes + colors.nbytes
        _require_expansion("stops of all shapes", self._stop_bytes)
        return offsets, colors

    def _read_stops(self, element: Element) -> tuple[FloatArray, FloatArray]:
        offsets: list[float] = []
        colors = []
        highest = 0.0
        for stop in element.children:
            if stop.tag != "stop":
                continue
            own = stop.attributes
            offset = _share(own.get("offset", "0"), "offset")
            highest = max(highest, offset)
            offsets.append(highest)
            rgb = self._color(own.get("stop-color", "black"), "stop-color")
            colors.append([*rgb, _share(own.get("stop-opacity", "1"), "stop-opacity")])
        if not offsets:
            raise refused(element.tag, "stops", "none")
        return np.array(offsets), np.array(colors)

    def _color(self, text: str, what: str) -> FloatArray:
        try:
            rgb = ImageColor.getcolor(text.strip(), "RGB")
        except ValueError as failure:
            raise refused(what, "a color", text[:40]) from failure
        coded: FloatArray = np.array(rgb, np.float64) / 255
        return srgb_decode(coded) if self._linear else coded


def _choice(text: str, choices: tuple[str, ...], what: str) -> str:
    if text not in choices:
        raise refused(what, " or ".join(choices), text)
    return text


def _share(text: str, what: str) -> float:
    text = text.strip()
    value = _length(text[:-1], what) / 100 if text.endswith("%") else _length(text, what)
    return min(max(value, 0.0), 1.0)


def _scale(matrix: FloatArray, what: str) -> float:
    """By how much a matrix enlarges; refuses one that changes angles."""
    (a, c, _), (b, d, _) = matrix.tolist()
    square = a * a + b * b
    even = abs(c * c + d * d - square) <= 1e-6 * square and abs(a * c + b * d) <= 1e-6 * square
    if not even:
        raise refused("transform", f"one that keeps angles, for a {what}", matrix[:, :2].tolist())
    return math.sqrt(square)


def _moved_line(matrix: FloatArray, ends: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Start and end of a linear gradient that a matrix M moves.

    t = <p - a, d> / <d, d> becomes <p' - a', g> with g = M^-T d / <d, d>: a gradient along g, of
    length 1 / |g|, which is not where M takes the end unless M keeps angles.
    """
    start, direction = applied(matrix, ends[:1])[0], ends[1] - ends[0]
    (a, c, _), (b, d, _) = matrix.tolist()
    determinant, square = a * d - b * c, float(np.square(direction).sum())
    if determinant == 0 or square == 0:
        return start, start
    x, y = direction / (square * determinant)
    along = np.array([d * x - b * y, a * y - c * x])
    return start, start + along / np.square(along).sum()


def _bounding_box(paths: list[Subpath]) -> FloatArray:
    """The (2, 3) matrix from the unit square to the box of the curves, in close approximation."""
    drawing = Drawing.of([Shape(tuple(paths))])
    layout, points = drawing.layout, drawing.parameters.points
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for degree in range(1, 4):
        weight = bernstein(np.full(BOX_SEGMENTS + 1, degree), np.linspace(0, 1, BOX_SEGMENTS + 1))
        control = layout.control[layout.degree == degree]
        for first in range(0, len(control), BOX_CURVES):
            rows = points[control[first : first + BOX_CURVES]]
            at = np.einsum("tk,nki->nti", weight, rows)
            low = np.minimum(low, at.min(axis=(0, 1)))
            high = np.maximum(high, at.max(axis=(0, 1)))
    size = high - low
    if not size.all():
        raise refused("gradientUnits", "a shape with a width and a height", size.tolist())
    return np.array([[size[0], 0, low[0]], [0, size[1], low[1]]])


def _outline(element: Element) -> list[Subpath]:
    tag, own = element.tag, element.attributes

    def value(name: str, default: str = "0") -> float:
        return _length(own.get(name, default), name)

    if tag == "path":
        return path_subpaths(own.get("d", ""))
    if tag in ("polyline", "polygon"):
        points = numbers(own.get("points", ""), "points")
        rows = np.array(points[: len(points) // 2 * 2]).reshape(-1, 2)
        return [Subpath.lines(rows, closed=tag == "polygon")] if len(rows) > 1 else []
    if tag == "line":
        ends = [[value("x1"), value("y1")], [value("x2"), value("y2")]]
        return [Subpath.lines(np.array(ends))]
    if tag == "rect":
        if value("rx") or value("ry"):
            raise refused("rect", "corners that are not rounded", own.get("rx", own.get("ry")))
        x, y, w, h = (value(name) for name in ("x", "y", "width", "height"))
        corners = np.array([[x, y], [x + w, y], [x + w, y + h], [x, y + h]])
        return [Subpath.lines(corners, closed=True)] if w > 0 and h > 0 else []
    if tag in ("circle", "ellipse"):
        radii = [value("r")] * 2 if tag == "circle" else [value("rx"), value("ry")]
        unit = Subpath.circle((0.0, 0.0), 1.0)
        moved = unit.points * radii + [value("cx"), value("cy")]
        return [replace(unit, points=moved)] if min(radii) > 0 else []
    raise refused("element", "shapes, paths, groups and gradients", tag)

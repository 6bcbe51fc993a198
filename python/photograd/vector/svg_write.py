"""Drawings as plain SVG 1.1: paths with fills and strokes, gradients in pixels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write
from photograd_course.color import srgb_encode

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.types import Array, FloatArray
from photograd.vector.drawing import Drawing
from photograd.vector.shapes import LinearGradient, Paint, Shape, Solid, Subpath

_LETTERS = {1: "L", 2: "Q", 3: "C"}


@typed_call
def svg_text(
    drawing: Drawing, size: tuple[int, int], *, linear: bool = True, background: Array | None = None
) -> str:
    """A drawing as SVG.

    Args:
        drawing: its coordinates become user units, its opacities and alphas are cut off at 0 and 1.
        size: (height, width) of the picture in pixels.
        linear: colors are linear values, and are encoded; False writes them as they are. Viewers
            composite encoded values: where shapes cover part of a pixel or are not opaque, they
            show a linear drawing differently.
        background: (3,) an opaque color behind all; None leaves it out.

    Raises:
        DtypeError, ShapeError, RangeError: a background that is no color.
    """
    height, width = size
    defs: list[str] = []
    body = []
    if background is not None:
        color = Arguments("svg_text", np.float64).array("background", background, (3,))
        body.append(f'<rect width="{width}" height="{height}" fill="{_hex(color, linear)}"/>')
    for shape in drawing.shapes:
        paint = _paint(shape.paint, defs, linear)
        body.append(_element(shape, paint))
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}"'
    lines = [f'{head} viewBox="0 0 {width} {height}">']
    lines += ["<defs>", *defs, "</defs>"] if defs else []
    return "\n".join([*lines, *body, "</svg>", ""])


@typed_call
def write_svg(
    path: str | Path,
    drawing: Drawing,
    size: tuple[int, int],
    *,
    linear: bool = True,
    background: Array | None = None,
) -> None:
    """Write `svg_text` to a file, atomically.

    Args:
        path: of the file.
        drawing, size, linear, background: as for `svg_text`.

    Raises:
        DtypeError, ShapeError, RangeError: as of `svg_text`.
        IoError: the file cannot be written.
    """
    text = svg_text(drawing, size, linear=linear, background=background)
    atomic_write(Path(path), text.encode())


def _element(shape: Shape, paint: str) -> str:
    data = " ".join(_data(path) for path in shape.subpaths if path.degrees)
    alpha = shape.opacity * (shape.paint.alpha if isinstance(shape.paint, Solid) else 1.0)
    opacity = "" if alpha == 1 else f' opacity="{_number(alpha)}"'
    stroke = shape.stroke
    if stroke is None:
        rule = "" if shape.rule == "nonzero" else ' fill-rule="evenodd"'
        return f'<path d="{data}" fill="{paint}"{rule}{opacity}/>'
    return (
        f'<path d="{data}" fill="none" stroke="{paint}" stroke-width="{_number(stroke.width)}"'
        f' stroke-linecap="{stroke.cap}" stroke-linejoin="{stroke.join}"'
        f' stroke-miterlimit="{_number(stroke.miter_limit)}"{opacity}/>'
    )


def _data(path: Subpath) -> str:
    points = np.concatenate([path.points, path.points[:1]]) if path.closed else path.points
    parts, at = [f"M{_pairs(points[:1])}"], 1
    for degree in path.degrees:
        parts.append(_LETTERS[degree] + _pairs(points[at : at + degree]))
        at += degree
    return "".join(parts) + ("Z" if path.closed else "")


def _paint(paint: Paint, defs: list[str], linear: bool) -> str:
    if isinstance(paint, Solid):
        return _hex(paint.color, linear)
    name = f"paint{len(defs)}"
    units = f'id="{name}" gradientUnits="userSpaceOnUse"'
    stops = _stops(paint.offsets, paint.colors, linear)
    if isinstance(paint, LinearGradient):
        (x1, y1), (x2, y2) = ([_number(v) for v in end] for end in (paint.start, paint.end))
        ends = f'x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}"'
        defs.append(f"<linearGradient {units} {ends}>{stops}</linearGradient>")
    else:
        x, y, r = (_number(v) for v in (*paint.center, paint.radius))
        defs.append(f'<radialGradient {units} cx="{x}" cy="{y}" r="{r}">{stops}</radialGradient>')
    return f"url(#{name})"


def _stops(offsets: FloatArray, colors: FloatArray, linear: bool) -> str:
    return "".join(
        f'<stop offset="{_number(offset)}" stop-color="{_hex(color[:3], linear)}"'
        f' stop-opacity="{_number(color[3])}"/>'
        for offset, color in zip(offsets, colors, strict=True)
    )


def _hex(color: Array, linear: bool) -> str:
    coded = np.clip(srgb_encode(np.clip(color, 0, 1)) if linear else color, 0, 1)
    return "#" + "".join(f"{round(255 * float(each)):02x}" for each in coded)


def _number(value: float) -> str:
    return f"{float(value):.6g}"


def _pairs(points: FloatArray) -> str:
    return " ".join(f"{_number(x)},{_number(y)}" for x, y in points)

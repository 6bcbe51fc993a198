"""Differentiable vector graphics: paths and strokes to pictures, and gradients back.

    circle = Shape((Subpath.circle((32, 32), 20),), Solid(np.array([0.9, 0.2, 0.1])))
    line = Shape((Subpath.lines([[5, 5], [60, 50]]),), stroke=Stroke(3.0, cap="round"))
    rendering = Rendering(Drawing.of([circle, line]), (64, 64), background=(1, 1, 1, 1))
    rendering.picture  # (64, 64, 4), premultiplied
    gradients = rendering.backward(d_picture).parameters  # points, widths, colors, ...

A pixel holds the exact area that each shape covers of it; nothing is sampled. All of it calculates
in float64 and gives the same bits on any number of threads.
"""

from __future__ import annotations

from photograd.vector.distance import curve_distance, curve_distance_backward, distance_stroke
from photograd.vector.drawing import Drawing, DrawingLayout, DrawingParameters
from photograd.vector.fit import (
    FittedDrawing,
    VectorFitOptions,
    fit_curves,
    fit_drawing,
    random_curves,
)
from photograd.vector.flatten import Flattening
from photograd.vector.picture import Rendering, RenderingGradients, render
from photograd.vector.shapes import (
    LinearGradient,
    Paint,
    RadialGradient,
    Shape,
    Solid,
    Stroke,
    Subpath,
)
from photograd.vector.svg_read import SvgFile, read_svg
from photograd.vector.svg_write import svg_text, write_svg

__all__ = [
    "Drawing",
    "DrawingLayout",
    "DrawingParameters",
    "FittedDrawing",
    "Flattening",
    "LinearGradient",
    "Paint",
    "RadialGradient",
    "Rendering",
    "RenderingGradients",
    "Shape",
    "Solid",
    "Stroke",
    "Subpath",
    "SvgFile",
    "VectorFitOptions",
    "curve_distance",
    "curve_distance_backward",
    "distance_stroke",
    "fit_curves",
    "fit_drawing",
    "random_curves",
    "read_svg",
    "render",
    "svg_text",
    "write_svg",
]

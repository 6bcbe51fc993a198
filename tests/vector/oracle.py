"""Slow, obvious counterparts of the drawn, and drawings to prove things on."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.vector import (
    Drawing,
    DrawingParameters,
    Flattening,
    LinearGradient,
    RadialGradient,
    Rendering,
    Shape,
    Solid,
    Stroke,
    Subpath,
)

SIZE = (26, 31)
FLATTENING = Flattening(segments=6, arc=5)
BEHIND = (0.3, 0.2, 0.1, 0.6)


def windings(polygon: Any, points: Any) -> Any:
    """(N,) how often a closed polygon winds around points: crossings of the ray to the left."""
    found = np.zeros(len(points), int)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        side = (b[0] - a[0]) * (points[:, 1] - a[1]) - (b[1] - a[1]) * (points[:, 0] - a[0])
        found -= (a[1] <= points[:, 1]) & (b[1] > points[:, 1]) & (side < 0)
        found += (b[1] <= points[:, 1]) & (a[1] > points[:, 1]) & (side > 0)
    return found


def sampled(inside: Any, size: tuple[int, int], samples: int) -> Any:
    """(H, W) share of samples x samples points of each pixel that `inside` (N, 2) takes."""
    height, width = size
    y, x = (np.mgrid[: height * samples, : width * samples] + 0.5) / samples
    flags = inside(np.stack([x.ravel(), y.ravel()], axis=1))
    return flags.reshape(height, samples, width, samples).mean(axis=(1, 3))


def segment_distance(points: Any, a: Any, b: Any) -> Any:
    """(N,) from points to the segment from a to b."""
    along = b - a
    t = np.clip((points - a) @ along / (along @ along), 0, 1)
    return np.linalg.norm(points - a - t[:, None] * along, axis=1)


def polygon(points: Any, **shape: Any) -> Shape:
    return Shape((Subpath.lines(np.asarray(points, float), closed=True),), **shape)


def gradient_stops() -> tuple[Any, Any]:
    colors = [[0.9, 0.1, 0.2, 0.8], [0.2, 0.7, 0.1, 1.0], [0.1, 0.3, 0.9, 0.5]]
    return np.array([0.1, 0.45, 0.9]), np.array(colors)


def everything() -> Drawing:
    """One of each: degrees, rules, caps, joins, paints; overlaps and a figure that crosses itself.

    Nothing lies at a kink: no edge on another or on the border of pixels.
    """
    offsets, colors = gradient_stops()
    star = [[13.1, 2.3], [19.7, 22.4], [2.2, 9.6], [24.3, 9.1], [6.4, 22.8]]
    wave = Subpath([[3.2, 4.1], [12.4, 28.3], [16.1, -6.2], [27.3, 19.4]], (3,))
    bend = Subpath([[4.4, 20.3], [9.1, 3.2], [17.7, 12.6], [25.2, 15.1], [22.4, 6.7]], (2, 1, 1))
    ring = Subpath(
        [[8.3, 8.2], [14.6, 6.1], [20.3, 9.4], [18.1, 17.2], [9.4, 15.3]], (2, 2, 1), True
    )
    wide = Subpath.circle((22.4, 19.3), 9.7)
    return Drawing.of(
        [
            Shape((wide,), RadialGradient((21.3, 18.2), 8.4, offsets, colors), 0.8),
            polygon(star, paint=Solid((0.2, 0.6, 0.9), 0.7), rule="evenodd", opacity=0.9),
            polygon(np.add(star, 2.7), paint=LinearGradient((5, 4), (20, 18), offsets, colors)),
            Shape((wave,), Solid((0.9, 0.4, 0.1), 0.9), 0.7, stroke=Stroke(2.3, "round", "miter")),
            Shape((bend,), Solid((0.1, 0.8, 0.4)), 0.6, stroke=Stroke(1.7, "square", "round")),
            Shape((ring,), Solid((0.5, 0.1, 0.6)), 0.5, stroke=Stroke(3.1, "butt", "bevel")),
            Shape((bend, wave), Solid((0.7, 0.7, 0.2)), 0.3, stroke=Stroke(0.6, "butt", "miter")),
        ]
    )


class Drawn:
    """A drawing as a function of its groups of numbers, with the gradient."""

    def __init__(self, drawing: Drawing, size: tuple[int, int] = SIZE) -> None:
        self.drawing, self.size = drawing, size
        self.place = {**drawing.parameters.arrays(), "background": np.array(BEHIND)}

    def rendering(self, groups: dict[str, Any]) -> Rendering:
        numbers = {name: groups[name] for name in self.drawing.parameters.arrays()}
        moved = self.drawing.with_parameters(DrawingParameters(**numbers))
        background = groups["background"]
        return Rendering(moved, self.size, flattening=FLATTENING, background=background)

    def forward(self, groups: dict[str, Any]) -> Any:
        return self.rendering(groups).picture

    def backward(self, groups: dict[str, Any], d: Any) -> dict[str, Any]:
        found = self.rendering(groups).backward(d)
        return {**found.parameters.arrays(), "background": found.background}

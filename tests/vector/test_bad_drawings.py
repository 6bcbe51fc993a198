"""What is no drawing is refused, and the error names what was called."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, RangeError, ShapeError
from photograd.vector import (
    Drawing,
    Flattening,
    LinearGradient,
    RadialGradient,
    Rendering,
    Shape,
    Solid,
    Stroke,
    Subpath,
    curve_distance,
    distance_stroke,
    render,
)

SQUARE = np.array([[1.0, 1], [5, 1], [5, 5], [1, 5]])
DRAWING = Drawing.of([Shape((Subpath.lines(SQUARE, closed=True),))])
STOPS = np.array([0.0, 1.0]), np.ones((2, 4))


def moved(**changes: Any) -> Drawing:
    return DRAWING.with_parameters(replace(DRAWING.parameters, **changes))


CASES: list[tuple[str, Callable[[], Any]]] = [
    (r"Subpath: points: expected finite numbers", lambda: Subpath.lines(SQUARE * np.nan)),
    (r"Subpath: points: .*1e\+06", lambda: Subpath.lines(SQUARE * 1e7)),
    (r"Subpath: points: expected 3 points", lambda: Subpath(SQUARE, (2,))),
    (r"Subpath: degrees", lambda: Subpath(SQUARE, (4,), closed=True)),
    (r"Stroke: width", lambda: Stroke(-1.0)),
    (r"Stroke: width", lambda: Stroke(float("nan"))),
    (r"Stroke: miter_limit", lambda: Stroke(1.0, miter_limit=0.5)),
    (r"Stroke: cap: expected 'butt'", lambda: Stroke(1.0, "flat")),  # type: ignore[arg-type]
    (r"Stroke: join", lambda: Stroke(1.0, join="arcs")),  # type: ignore[arg-type]
    (r"Shape: rule", lambda: Shape((), rule="odd")),  # type: ignore[arg-type]
    (r"Shape: opacity", lambda: Shape((), opacity=1.5)),
    (r"Solid: color", lambda: Solid(np.ones(4))),
    (r"Solid: alpha", lambda: Solid(np.ones(3), -0.1)),
    (r"LinearGradient: offsets", lambda: LinearGradient((0, 0), (1, 1), STOPS[0][::-1], STOPS[1])),
    (r"LinearGradient: colors", lambda: LinearGradient((0, 0), (1, 1), STOPS[0], np.ones((3, 4)))),
    (r"RadialGradient: radius", lambda: RadialGradient((0, 0), -1.0, *STOPS)),
    (r"RadialGradient: alpha", lambda: RadialGradient((0, 0), 1.0, STOPS[0], 2 * STOPS[1])),
    (r"Flattening: segments", lambda: Flattening(segments=0)),
    (r"Flattening: tolerance", lambda: Flattening(tolerance=0.0)),
    (r"Drawing.with_parameters: points", lambda: moved(points=SQUARE * np.inf)),
    (r"Drawing.with_parameters: widths", lambda: moved(widths=np.array([-1.0]))),
    (r"Drawing.with_parameters: colors", lambda: moved(colors=np.ones((2, 4)))),
    (r"Rendering: size", lambda: render(DRAWING, (0, 4))),
    (r"Rendering: width, height", lambda: render(DRAWING, (1 << 20, 1 << 20))),
    (r"Rendering: background", lambda: render(DRAWING, (4, 4), background=(1, 1, 1))),
    (
        r"Rendering.backward: d_picture",
        lambda: Rendering(DRAWING, (4, 4)).backward(np.ones((4, 4))),
    ),
    (r"Rendering.coverage: shape", lambda: Rendering(DRAWING, (4, 4)).coverage(1)),
    (r"Rendering.coverage: drawing", lambda: Rendering(Drawing.of([]), (4, 4)).coverage(0)),
    (r"curve_distance: control", lambda: curve_distance(np.ones((5, 2)), SQUARE)),
    (r"distance_stroke: width", lambda: distance_stroke(SQUARE, 0.5, (4, 4))),
]


@pytest.mark.parametrize(("text", "call"), CASES, ids=[str(n) for n in range(len(CASES))])
def test_bad_input_is_named(text: str, call: Callable[[], Any]) -> None:
    with pytest.raises(Error, match=text):
        call()


def test_an_outline_that_leaves_the_plane_is_refused() -> None:
    path = Subpath.lines([[9e5, 9e5], [9.9e5, 9e5]])
    with pytest.raises(RangeError, match="Rendering: vertices"):
        render(Drawing.of([Shape((path,), stroke=Stroke(9e5))]), (4, 4))


def test_a_drawing_that_would_not_fit_into_memory_is_refused() -> None:
    full = Shape((Subpath.lines(SQUARE * 1e4 - 2e4, closed=True),))
    with pytest.raises(RangeError, match=r"Rendering: drawing: .* more than 2"):
        render(Drawing.of([full] * 5), (1 << 13, 1 << 13))


def test_axes_are_checked() -> None:
    with pytest.raises(ShapeError, match=r"Subpath: points: expected shape \(K, 2\)"):
        Subpath(np.zeros((3, 3)), (1, 1))


@pytest.mark.parametrize("seed", range(40))
def test_strange_drawings_leave_numbers(seed: int) -> None:
    """Points at one place, on borders, far outside; widths beyond the picture."""
    rng = np.random.default_rng(seed)
    pool = rng.choice([0.0, 1.0, 2.5, 4.0, -3.0, 1e5, -1e5, 1e-9], (12, 2))
    path = Subpath(pool[:7], (3, 2, 1)), Subpath(pool[7:], (1, 1, 2, 1), closed=True)
    width = float(rng.choice([0.0, 1e-9, 1.0, 3.0, 1e5]))
    cap, join = rng.choice(["butt", "round", "square"]), rng.choice(["miter", "round", "bevel"])
    drawing = Drawing.of(
        [
            Shape(path, rule=rng.choice(["nonzero", "evenodd"])),
            Shape(path, stroke=Stroke(width, cap, join), opacity=0.5),
        ]
    )
    rendering = Rendering(drawing, (5, 6), flattening=Flattening(segments=5, arc=4))
    assert np.isfinite(rendering.picture).all()
    assert (rendering.picture >= 0).all()
    assert (rendering.picture <= 1 + 1e-12).all()
    found = rendering.backward(rng.uniform(-1, 1, (5, 6, 4))).parameters
    assert all(np.isfinite(array).all() for array in found.arrays().values())

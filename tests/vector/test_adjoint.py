"""Gradients of pictures against central differences, each group of numbers; wrong ones are seen."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.vector import Drawing, flatten, picture
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.vector.oracle import SIZE, Drawn, everything

DRAWN = Drawn(everything())


def test_every_group_agrees_with_central_differences() -> None:
    report = check_gradient(DRAWN.forward, DRAWN.backward, DRAWN.place, seed=1)
    assert report, str(report)


@pytest.mark.parametrize("shape", range(7))
def test_each_shape_alone_agrees(shape: int) -> None:
    alone = Drawn(Drawing.of([DRAWN.drawing.shapes[shape]]))
    report = check_gradient(
        alone.forward,
        alone.backward,
        alone.place,
        seed=2,
        coordinates=8,
        may_be_zero=("widths", "geometry", "offsets"),
    )
    assert report, str(report)


def test_wrong_gradients_are_noticed() -> None:
    small = Drawn(Drawing.of(DRAWN.drawing.shapes[:4:3]))
    cotangent = np.random.default_rng(2).uniform(-1, 1, (*SIZE, 4))
    report = check_gradient_mutants(
        small.forward, small.backward, small.place, cotangent, seed=1, coordinates=8, directions=4
    )
    assert report, str(report)


def wrong_weights(self: Any, d_vertices: Any, points: int) -> Any:
    """As if a vertex belonged to the first control point of its curve alone."""
    rows = self.control[:, 0]
    return np.stack([np.bincount(rows, d, points) for d in d_vertices.T], axis=1)


def lost_ends(self: Any, d_vertices: Any, points: int) -> Any:
    """Without the vertices at the ends of curves."""
    inner = np.where(self.corner[:, None], 0, d_vertices)
    return RIGHT_WEIGHTS(self, inner, points)


def whole_width(self: Any, d_vertices: Any) -> Any:
    """d_width = d_half."""
    points, widths = RIGHT_PATHS(self, d_vertices)
    return points, 2 * widths


def lost_strokes(self: Any, d_vertices: Any) -> Any:
    """Outlines that do not move with their path."""
    points, widths = RIGHT_PATHS(self, d_vertices)
    return points, np.zeros_like(widths)


RIGHT_WEIGHTS = flatten.Polylines.backward
RIGHT_PATHS = picture.Rendering._paths_backward


@pytest.mark.parametrize(
    ("owner", "name", "wrong"),
    [
        (flatten.Polylines, "backward", wrong_weights),
        (flatten.Polylines, "backward", lost_ends),
        (picture.Rendering, "_paths_backward", whole_width),
        (picture.Rendering, "_paths_backward", lost_strokes),
    ],
)
def test_wrong_formulas_die(owner: Any, name: str, wrong: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr(owner, name, wrong)
    assert not check_gradient(
        DRAWN.forward, DRAWN.backward, DRAWN.place, seed=1, coordinates=8, directions=2
    )


def test_the_gradient_of_a_sum_is_the_sum_of_gradients() -> None:
    rng = np.random.default_rng(3)
    rendering = DRAWN.rendering(DRAWN.place)
    a, b = rng.uniform(-1, 1, (2, *SIZE, 4))
    parts = [rendering.backward(d).parameters.arrays() for d in (a, b, a + b)]
    for name, whole in parts[2].items():
        np.testing.assert_allclose(parts[0][name] + parts[1][name], whole, atol=1e-10)


def test_coverage_is_held_under_what_lies_over_it() -> None:
    rendering = DRAWN.rendering(DRAWN.place)
    first = Drawn(Drawing.of(DRAWN.drawing.shapes[:1]))
    np.testing.assert_array_equal(rendering.coverage(0), first.rendering(first.place).coverage(0))

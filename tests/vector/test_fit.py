"""Fits: a digit, the boldness of a glyph, checkpoints; what is held stays."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.vector import (
    Drawing,
    Rendering,
    Shape,
    Solid,
    Stroke,
    Subpath,
    VectorFitOptions,
    fit_curves,
    fit_drawing,
)

WHITE = (1.0, 1.0, 1.0, 1.0)
SIZE = (64, 64)


def digit(width: float = 6.0) -> Drawing:
    """A 2, drawn with a round pen."""
    arch = [[15.0, 20], [15, 6], [46, 6], [46, 22], [46, 36], [20, 42], [16, 54]]
    paths = Subpath(np.array(arch), (3, 3)), Subpath.lines(np.array([[16.0, 54], [48, 54]]))
    return Drawing.of([Shape(paths, Solid(np.zeros(3)), stroke=Stroke(width, "round", "round"))])


def picture_of(drawing: Drawing) -> Any:
    return Rendering(drawing, SIZE, background=WHITE).picture[..., :3]


@pytest.mark.parametrize("kind", ["stroke", "fill"])
def test_eight_curves_learn_a_digit(kind: Any) -> None:
    began = time.perf_counter()
    options = VectorFitOptions(steps=300)
    found = fit_curves(picture_of(digit()), 8, options, kind=kind, background=WHITE[:3])
    assert found.finished
    assert found.loss < 0.05 * found.losses[0]
    assert time.perf_counter() - began < 60


@pytest.mark.parametrize("start", [2.5, 11.0])
def test_the_boldness_of_a_glyph_is_recovered(start: float) -> None:
    options = VectorFitOptions(steps=120, width_rate=0.2)
    target = picture_of(digit(6.0))
    found = fit_drawing(digit(start), target, options, groups=("widths",))
    assert found.drawing.parameters.widths[0] == pytest.approx(6.0, rel=0.02)
    np.testing.assert_array_equal(
        found.drawing.parameters.points, digit().parameters.points, "held"
    )


def test_boldness_is_recovered_while_all_else_moves() -> None:
    rng = np.random.default_rng(1)
    start = digit(4.0)
    points = start.parameters.points + rng.uniform(-1, 1, start.parameters.points.shape)
    colors = np.array([[0.3, 0.2, 0.4, 0.9]])
    start = start.with_parameters(replace(start.parameters, points=points, colors=colors))
    options = VectorFitOptions(steps=250, point_rate=0.2)
    found = fit_drawing(start, picture_of(digit(6.0)), options)
    assert found.drawing.parameters.widths[0] == pytest.approx(6.0, rel=0.02)


def test_a_stopped_fit_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    target, options = picture_of(digit()), VectorFitOptions(steps=12)
    whole = fit_curves(target, 5, options)
    left = iter(range(5))
    stopped = fit_curves(
        target, 5, options, folder=tmp_path, should_stop=lambda: next(left, None) is None
    )
    assert not stopped.finished
    assert len(stopped.losses) == 5
    resumed = fit_curves(target, 5, options, folder=tmp_path, resume=True)
    np.testing.assert_array_equal(resumed.losses, whole.losses)
    for name, array in whole.drawing.parameters.arrays().items():
        np.testing.assert_array_equal(resumed.drawing.parameters.arrays()[name], array, name)
    with pytest.raises(RangeError, match="resume"):
        fit_curves(target, 6, options, folder=tmp_path, resume=True)


def test_bad_fits_are_named() -> None:
    target = picture_of(digit())
    with pytest.raises(RangeError, match="fit_curves: count"):
        fit_curves(target, 0)
    with pytest.raises(RangeError, match="fit_curves: kind"):
        fit_curves(target, 1, kind="dots")  # type: ignore[arg-type]
    with pytest.raises(RangeError, match="fit_drawing: groups"):
        fit_drawing(digit(), target, groups=("caps",))
    with pytest.raises(RangeError, match="VectorFitOptions"):
        VectorFitOptions(point_rate=0.0)

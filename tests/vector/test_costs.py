"""What SVG files cost: a multiple of their size, or a refusal that names the limit."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from photograd.errors import IoError, RangeError
from photograd.vector import (
    Drawing,
    Rendering,
    Shape,
    Solid,
    Subpath,
    flatten,
    picture,
    read_svg,
    render,
)
from photograd_course.random import uniform

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="20" height="20">'


def svg(body: str) -> bytes:
    return f"{HEAD}{body}</svg>".encode()


def scattered(count: int) -> str:
    """Points all over the picture, as an attribute has them."""
    at = 20 * np.array([uniform(1, pixel=np.arange(count), dimension=d) for d in range(2)]).T
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in at)


def stops(count: int) -> str:
    each = "".join(f'<stop offset="{k / count:.5f}" stop-color="#123"/>' for k in range(count))
    fill = '<rect width="20" height="20" fill="url(#g)"/>'
    return f'<linearGradient id="g">{each}</linearGradient>{fill}'


def shared_stops(count: int) -> str:
    return stops(40) + '<rect width="9" height="9" fill="url(#g)"/>' * count


def nested(count: int) -> str:
    return ("<g>" * 40 + '<rect width="3" height="3"/>' + "</g>" * 40) * (count // 40)


def commands(count: int) -> str:
    return f'<path d="{"M1 1h3v3z" * count}"/>'


def dots(count: int) -> str:
    return f'<path d="{"M0 0z" * count}"/>'


def transforms(count: int) -> str:
    return f'<g transform="{"translate(1) " * count}"><rect width="3" height="3"/></g>'


def boxed(count: int) -> str:
    curves = "".join(f"C{k % 7} 1 2 {k % 5} {k % 11} 3" for k in range(count))
    return stops(3) + f'<path d="M0 0{curves}" fill="none" stroke="url(#g)" stroke-width=".01"/>'


def huge_curves(count: int) -> str:
    far = "".join(f"C{k - 900000} 900000 900000 {k - 900000} 10 10" for k in range(count))
    return f'<path d="M0 0{far}"/>'


def columns(count: int) -> str:
    return f'<path d="{"".join(f"M{k % 20} 0v20h.5v-20z" for k in range(count))}"/>'


def wide_stroke(count: int) -> str:
    line = f'points="{scattered(count)}" fill="none" stroke="red"'
    return f'<polyline {line} stroke-width="8"/>'


def tangle(count: int) -> str:
    return f'<polygon points="{scattered(count)}"/>'


def seconds(make: Callable[[int], str], count: int) -> float:
    """Processor time to read and draw; none for a file that is refused."""
    data = svg(make(count))
    began = time.process_time()
    with suppress(RangeError):  # edges that cross too often are a test of their own
        file = read_svg(data)
        render(file.drawing, file.size)
    return time.process_time() - began


@pytest.mark.parametrize(
    ("make", "count"),
    [
        (stops, 4000),
        (shared_stops, 500),
        (nested, 2000),
        (dots, 8000),
        (transforms, 2000),
        (boxed, 200),
        (huge_curves, 200),
    ],
)
def test_time_grows_with_the_size(make: Callable[[int], str], count: int) -> None:
    small, large = seconds(make, count), seconds(make, 4 * count)
    # Four times as much; 16 times would be the square. A fixed share hides what is too quick.
    assert large < 9 * small + 0.05


@pytest.mark.parametrize("make", [wide_stroke, tangle, columns, commands])
def test_what_crosses_too_often_is_refused_before_it_is_drawn(
    make: Callable[[int], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def drawn(*_: Any) -> None:
        raise AssertionError("it was drawn")

    monkeypatch.setattr(picture._core, "VectorShapes", drawn)
    for count in (20000, 40000):
        file = read_svg(svg(make(count)))
        with pytest.raises(RangeError, match=r"^Rendering: drawing: .*PHOTOGRAD_MAX_CROSSINGS"):
            render(file.drawing, file.size)
    monkeypatch.undo()
    monkeypatch.setenv("PHOTOGRAD_MAX_CROSSINGS", "1")
    file = read_svg(svg(make(20)))
    assert render(file.drawing, file.size).any()  # few edges are never too many


def test_what_is_drawn_over_itself_is_drawn() -> None:
    """Forty copies of a scribble cross where one does."""
    line = " ".join(f"{k % 7 + 5},{k * 3 % 11 + 4}" for k in range(3000))
    file = read_svg(svg(f'<polyline points="{line}" fill="none" stroke="red" stroke-width="8"/>'))
    assert render(file.drawing, file.size).any()


@pytest.mark.parametrize("make", [dots, commands, huge_curves, stops])
def test_memory_is_a_multiple_of_the_size(make: Callable[[int], str]) -> None:
    data = svg(make(3000))
    tracemalloc.start()
    try:
        file = read_svg(data)
        _, peak = tracemalloc.get_traced_memory()
        assert peak < 250 * len(data) + (1 << 20)
        tracemalloc.reset_peak()
        with suppress(RangeError):  # the huge curves all cross each other
            Rendering(file.drawing, file.size)
        _, peak = tracemalloc.get_traced_memory()
        # Of huge curves, the vertices that are looked at together come on top.
        assert peak < 1000 * len(data) + 400 * flatten.CHUNK
    finally:
        tracemalloc.stop()


def test_many_bytes_and_a_large_picture_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(IoError, match=r"at most 8,388,608 bytes of SVG.*PHOTOGRAD_MAX_SVG_BYTES"):
        read_svg(svg(" " * (8 << 20)))
    monkeypatch.setenv("PHOTOGRAD_MAX_SVG_BYTES", "10")
    with pytest.raises(IoError, match="at most 10 bytes"):
        read_svg(svg(""))
    monkeypatch.undo()
    large = svg("").replace(b'"20"', b'"4000"')
    with pytest.raises(RangeError, match=r"width times height.*PHOTOGRAD_MAX_EXPANSION"):
        read_svg(large)
    monkeypatch.setenv("PHOTOGRAD_MAX_EXPANSION", f"{1 << 30}")
    assert read_svg(large).size == (4000, 4000)


def test_shapes_that_share_many_stops_are_counted() -> None:
    body = stops(3000) + '<rect width="9" height="9" fill="url(#g)"/>' * 3000
    with pytest.raises(RangeError, match=r"stops of all shapes.*PHOTOGRAD_MAX_EXPANSION"):
        read_svg(svg(body))


VISIBLE = flatten.VisibleArea(20, 20, np.array([1.0]))


def curve(points: Any) -> Drawing:
    path = Subpath(np.array(points, float), (3,), closed=False)
    return Drawing.of([Shape((path,), Solid(np.ones(3)))])


@pytest.mark.parametrize("seed", range(12))
def test_what_is_left_out_of_a_curve_cannot_be_seen(seed: int) -> None:
    """A curve that goes around and through the picture, with and without what lies beyond it."""
    rng = np.random.default_rng(seed)
    drawing = curve(rng.uniform(-1, 1, (4, 2)) * 10 ** rng.uniform(1, 4, (4, 1)) + 10)
    layout, points = drawing.layout, drawing.parameters.points
    rule = flatten.Flattening(tolerance=1e-4)
    whole = flatten.Polylines.of(layout, points, rule)
    visible = flatten.Polylines.of(layout, points, rule, VISIBLE)
    assert len(visible.corner) <= len(whole.corner)
    assert visible.corner.sum() == whole.corner.sum() == 2
    pictures = []
    for lines in (whole, visible):
        path = Subpath.lines(lines.vertices(points), closed=True)
        shape = Shape((path,), Solid(np.ones(3)))
        pictures.append(render(Drawing.of([shape]), (20, 20)))
    np.testing.assert_allclose(pictures[1], pictures[0], atol=1e-9)


def test_of_a_huge_curve_little_is_kept() -> None:
    drawing = curve([[0, 0], [9e5, 9e5], [-9e5, 9e5], [10, 10]])
    layout, points = drawing.layout, drawing.parameters.points
    visible = flatten.Polylines.of(layout, points, flatten.Flattening(), VISIBLE)
    assert len(visible.corner) < 20

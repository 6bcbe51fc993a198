"""A graph of passes as a picture: who writes which buffer, and who reads it."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from photograd_course.viz import style

from photograd.frame.graph import PassGraph

ROW, LEFT, COLUMN, RIGHT = 0.3, 1.75, 0.43, 0.35  # inches
BOX = 1.45


def draw_graph(graph: PassGraph, milliseconds: Mapping[str, float] | None = None) -> Figure:
    """A row for each pass, from top to bottom, and a column for each buffer.

    A dot is where a buffer is written or given; the line goes down to its last reader, and a ring
    is a pass that reads it.

    Args:
        graph: of the passes.
        milliseconds: that each took, by name; None leaves them out.
    """
    buffers = graph.buffers
    rows = {each.name: k + 1 for k, each in enumerate(graph.passes)}
    width = LEFT + COLUMN * len(buffers) + RIGHT
    top = 1.05
    height = top + ROW * (len(rows) + 1) + 0.15
    with style.house_style():
        figure = style.new_figure(width, height)
        axes = figure.add_axes((0.0, 0.0, 1.0, (height - top) / height))
        axes.set(xlim=(0, width), ylim=(height - top, -0.15))
        axes.axis("off")
        for each in graph.passes:
            took = None if milliseconds is None else milliseconds.get(each.name)
            _box(axes, rows[each.name], each.name, took, width)
        for column, name in enumerate(buffers):
            _line(axes, graph, rows, LEFT + COLUMN * (column + 0.5), name)
    return figure


def _box(axes: Axes, row: int, name: str, took: float | None, width: float) -> None:
    y = ROW * row
    axes.plot([LEFT - 0.1, width - RIGHT], [y, y], color="#e4e7ea", lw=0.7, zorder=0)
    shape = FancyBboxPatch(
        (0.12, y - 0.1), BOX, 0.2, boxstyle="round,pad=0.01", fc="#eef2f6", ec=style.FRAME, lw=0.7
    )
    axes.add_patch(shape)
    axes.text(0.18, y, name, va="center", fontsize=style.SMALL_SIZE)
    if took is not None:
        text = f"{took:.1f} ms" if took < 100 else f"{took:.0f} ms"
        axes.text(0.08 + BOX, y, text, va="center", ha="right", fontsize=6.5, color=style.GUIDE)


def _line(axes: Axes, graph: PassGraph, rows: Mapping[str, int], x: float, name: str) -> None:
    written = next((rows[p.name] for p in graph.passes if name in p.writes), 0)
    readers = [rows[p.name] for p in graph.passes if name in p.reads]
    color = style.ORANGE if written == 0 else style.BLUE
    last = max(readers, default=written)
    axes.plot([x, x], [ROW * written, ROW * last], color=color, lw=1.2, zorder=1)
    axes.plot([x], [ROW * written], "o", color=color, ms=5.5, zorder=3)
    axes.plot([x] * len(readers), [ROW * r for r in readers], "o", mfc="white", mec=color, ms=4.5)
    axes.text(
        x - 0.05,
        -0.18 if written else -0.14,
        name,
        rotation=50,
        ha="left",
        va="bottom",
        fontsize=style.SMALL_SIZE,
        clip_on=False,
    )

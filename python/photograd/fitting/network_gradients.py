"""The gradient inside a field of networks: by level of its hash grid, by layer of its networks.

A level is shown on a plane: at each point stands the derivative with respect to the first feature
there, interpolated as the feature itself is. Rows that distant corners share show as a pattern that
repeats where there is nothing: what one corner asks, the others are given, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from photograd_course.viz import style
from photograd_course.viz.scale import nice_limit

from photograd.network import HashEncoding, Perceptron
from photograd.types import Array

PIXELS = 192  # of a panel, along an edge
MOST = 5  # panels in a row
PANEL, GAP, LEFT, TOP, BELOW = 1.9, 0.2, 0.75, 0.75, 0.3  # inches
SIGNS = "blue: more lowers the loss, red: less does. Each panel has a scale of its own, named below"
OF_LEVELS = (
    "Derivative of the loss with respect to the first feature of a level, on a plane through the "
    f"middle; {SIGNS}, with the share of the level's rows that anything asks of. Levels with more "
    "corners than rows share rows among corners: their pattern repeats in empty space."
)
OF_LAYERS = (
    "Derivative of the loss with respect to the weights of a layer: what it gives from top to "
    f"bottom, what it takes from left to right; {SIGNS}."
)


def level_planes(encoding: HashEncoding, d_table: Array, pixels: int = PIXELS) -> list[Array]:
    """Derivatives with respect to the first feature of each level on a plane, (pixels, pixels).

    Args:
        encoding: in two or three dimensions; in three, the plane is z = 1/2 of the box.
        d_table: (rows, features), derivatives with respect to its table.
        pixels: along an edge; the first row has the lowest y.
    """
    center = (np.arange(pixels) + 0.5) / pixels
    y, x = np.meshgrid(center, center, indexing="ij")
    axes = [x.ravel(), y.ravel(), np.full(x.size, 0.5)][: encoding.dimensions]
    found = encoding.encode(np.asarray(d_table, np.float64), np.stack(axes, axis=-1))
    first = found[:, :: encoding.features]
    return [plane.reshape(pixels, pixels) for plane in first.T]


def draw_level_gradients(rows: Mapping[int, Array], encoding: HashEncoding) -> Figure:
    """A row of panels for each step, a panel for each of up to five levels.

    Args:
        rows: {step: derivatives with respect to the table (rows, features)}.
        encoding: that the table belongs to.
    """
    count = min(MOST, len(encoding.levels))
    chosen = np.linspace(0, len(encoding.levels) - 1, count).round().astype(int)
    titles = [_level_title(encoding, level) for level in chosen]
    figure = _sheet(list(rows), titles, "What the loss asks of each level", OF_LEVELS)
    panels = iter(figure.axes)
    for d_table in rows.values():
        planes = level_planes(encoding, d_table)
        for level in chosen:
            n = encoding.levels[level]
            asked = np.any(d_table[n.first : n.first + n.rows] != 0, axis=1).mean()
            origin = "upper" if encoding.dimensions == 2 else "lower"
            _signed(next(panels), planes[level], f"{asked:.0%} of rows", origin)
    return figure


def draw_layer_gradients(
    rows: Mapping[int, Mapping[str, Array]], networks: Mapping[str, Perceptron]
) -> Figure:
    """A row of panels for each step, a panel for each layer of the networks.

    Args:
        rows: {step: {network: derivatives with respect to its parameters}}.
        networks: by name.
    """
    titles = [
        f"{name}, layer {number}\n{W.shape[0]} x {W.shape[1]}"
        for name, number, W in _weights(next(iter(rows.values())), networks)
    ]
    figure = _sheet(list(rows), titles, "What the loss asks of each layer", OF_LAYERS)
    panels = iter(figure.axes)
    for gradients in rows.values():
        for _, _, W in _weights(gradients, networks):
            _signed(next(panels), W, "", "upper")
    return figure


def _weights(
    gradients: Mapping[str, Array], networks: Mapping[str, Perceptron]
) -> Iterator[tuple[str, int, Array]]:
    for name, network in networks.items():
        for number, (W, _) in enumerate(network.layers(np.asarray(gradients[name], np.float64))):
            yield name, number, W


def _level_title(encoding: HashEncoding, number: int) -> str:
    level = encoding.levels[number]
    corners = (level.resolution + 1) ** encoding.dimensions
    share = corners / level.rows
    shared = "" if level.dense else f"\n{share:.{0 if share > 10 else 1}f} corners a row"
    return f"level {number}: {level.resolution} cells{shared}"


def _sheet(steps: list[int], titles: list[str], title: str, caption: str) -> Figure:
    """Axes row by row, a row for each step."""
    width = LEFT + max(len(titles) * (PANEL + GAP), 3 * PANEL)
    bottom = 0.1 + style.caption_height(caption, width - LEFT - 0.1)
    with style.house_style():
        figure = style.new_figure(width, TOP + len(steps) * (PANEL + GAP + BELOW) + bottom)
        for k, step in enumerate(steps):
            for n, name in enumerate(titles):
                corner = LEFT + n * (PANEL + GAP), TOP + k * (PANEL + GAP + BELOW)
                axes = style.place_axes(figure, *corner, PANEL, PANEL)
                axes.set(xticks=[], yticks=[])
                if k == 0:
                    axes.set_title(name, fontsize="small")
                if n == 0:
                    axes.set_ylabel(f"step {step}")
        style.write_title(figure, title, left=LEFT)
        style.write_caption(figure, caption, left=LEFT, right=0.1)
    return figure


def _signed(axes: Axes, values: Array, note: str, origin: str) -> None:
    """Values with a symmetric scale of their own; a gradient of zeros is white."""
    largest = float(np.quantile(np.abs(values), 0.995)) or float(np.abs(values).max())
    limit = nice_limit(largest) if largest > 0 else 1.0
    axes.imshow(
        values,
        norm=style.symmetric_scale(limit),
        cmap=style.signed_color_map(),
        interpolation="nearest",
        origin="lower" if origin == "lower" else "upper",
        aspect="auto",
    )
    text = f"\N{PLUS-MINUS SIGN} {style.power_text(limit)}" if largest > 0 else "all zero"
    axes.set_xlabel(f"{text}   {note}".strip(), fontsize="small")

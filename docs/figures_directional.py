"""What a function of direction costs as a table and as harmonics.

`python docs/figures_directional.py` writes docs/images/directional_grid.png and prints the rows of
the table in docs/results.md.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from photograd import sh
from photograd.lights.probes import (
    Functions,
    best_harmonics,
    best_table,
    grid_bytes,
    rows_for,
    table_numbers,
)
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).resolve().parent / "images"
PANEL = 2.35  # inches
ROWS = range(1, 11)
DEGREES = range(5)
SHAPE = (128, 128, 128)


def axes_of_symmetry() -> Array:
    """(6, 3) unit vectors in no particular direction: tables depend on how a function lies."""
    axes = np.random.default_rng(1).normal(size=(6, 3))
    unit: Array = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    return unit


def highlight(sharpness: float) -> Functions:
    """0.2 + exp(sharpness (cos - 1)) about each axis."""
    return lambda d: 0.2 + np.exp(sharpness * (d @ axes_of_symmetry().T - 1))


def edge(directions: Array) -> Array:
    """Dark below a plane, bright above: a light that something hides."""
    return np.where(directions @ axes_of_symmetry().T > 0.3, 1.2, 0.2)


FUNCTIONS: dict[str, Functions] = {
    "broad highlight (exponent 4)": highlight(4),
    "sharp highlight (exponent 64)": highlight(64),
    "edge": edge,
}


def draw(axes: Axes, functions: Functions) -> None:
    """Error against numbers a channel."""
    harmonics = [best_harmonics(functions, degree) for degree in DEGREES]
    tables = [best_table(functions, rows) for rows in ROWS]
    axes.loglog(
        [table_numbers(rows) for rows in ROWS],
        tables,
        "s-",
        color=style.GRAY,
        markersize=3,
        label="table",
    )
    axes.loglog(
        [sh.count(degree) for degree in DEGREES],
        harmonics,
        "o-",
        color=style.BLUE,
        markersize=3,
        label="harmonics",
    )
    axes.set(
        ylim=(0.01, 1), xlabel="numbers a channel", xticks=[1, 4, 16, 64], yticks=[0.01, 0.1, 1]
    )
    axes.set_xticklabels(["1", "4", "16", "64"])
    axes.set_yticklabels(["1 %", "10 %", "100 %"])
    axes.minorticks_off()
    axes.grid(visible=True)


def draw_all() -> None:
    """Write the picture."""
    with style.house_style():
        figure = style.new_figure(3 * PANEL + 2.0, PANEL + 1.5)
        for k, (name, functions) in enumerate(FUNCTIONS.items()):
            axes = style.place_axes(figure, 0.65 + k * (PANEL + 0.6), 0.4, PANEL, PANEL)
            draw(axes, functions)
            axes.set_title(name)
            if k == 0:
                axes.legend(loc="lower left")
        style.write_caption(
            figure,
            "Error of the best table (1 to 10 rows, twice as many columns, blended) and of the "
            "best harmonics (degree 0 to 4): root mean square over the sphere, in shares of the "
            "function's. Both are slow with what is sharp.",
            left=0.15,
            right=0.15,
        )
        save_figure(figure, IMAGES / "directional_grid.png")


def rows_of_results() -> list[str]:
    """Numbers and storage at equal error, a line of Markdown each."""
    lines = []
    for name, functions in FUNCTIONS.items():
        for degree in (2, 3, 4):
            error = best_harmonics(functions, degree)
            rows = rows_for(functions, error)
            if rows is None:
                raise SystemExit(f"{name}: no table of 12 rows reaches {error}")
            sizes = sh.count(degree), table_numbers(rows)
            mib = [grid_bytes(SHAPE, numbers) / 2**20 for numbers in sizes]
            lines.append(
                f"| {name} | {100 * error:.1f} % | degree {degree}: {sizes[0]} | {mib[0]:.0f} "
                f"| {rows} x {2 * rows}: {sizes[1]} | {mib[1]:.0f} | {mib[1] / mib[0]:.1f} |"
            )
    return lines


if __name__ == "__main__":
    draw_all()
    sys.stdout.write("\n".join(rows_of_results()) + "\n")

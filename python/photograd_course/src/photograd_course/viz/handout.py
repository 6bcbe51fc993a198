"""The figures of a handout: a function for each, which returns the picture and what it shows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .style import HANDOUT_DPI, house_style, save_figure

Array = np.ndarray[Any, np.dtype[Any]]


@dataclass(frozen=True)
class Fact:
    """One thing that a caption claims.

    Attributes:
        value: true or false; or a number, which lies from ``low`` to ``high``.
        low, high: of a number; NaN lies nowhere.
        red: a mutant of the assignment under which it does not hold; empty where the figure as a
            whole names one.
        held: why no mutant changes it.
    """

    value: Any
    low: float | None = None
    high: float | None = None
    red: str = ""
    held: str = ""

    @property
    def holds(self) -> bool:
        """Whether it is true."""
        if self.low is None or self.high is None:
            return bool(self.value)
        return bool(self.low <= float(self.value) <= self.high)


Facts = dict[str, Fact]
"""What a caption claims, by claim."""

Maker = Callable[[Any], tuple[Figure, Facts]]
"""Draws a figure from an assignment's module, the solution or a mutant of it."""


def figures_of(*makers: Maker) -> dict[str, Maker]:
    """Name to function of each figure, drawn in the house style."""
    return {make.__name__: house_style()(make) for make in makers}


def subplots(width: float, height: float, *shape: int, **options: Any) -> tuple[Figure, Any]:
    """A figure of ``width`` x ``height`` inches, and its axes.

    Args:
        width, height: in inches.
        shape: rows and columns of axes; nothing for one.
        options: of `Figure.subplots`, such as ``width_ratios``.
    """
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(*shape, **options)


def note(
    axes: Axes, text: str, point: tuple[Any, Any], offset: tuple[float, float], **options: Any
) -> None:
    """Write ``text`` beside a point of the data, ``offset`` points (1/72 inch) away from it."""
    axes.annotate(text, point, offset, textcoords="offset points", **options)


def save_figures(
    figures: Mapping[str, Maker], module: Any, folder: Path, dpi: int = HANDOUT_DPI
) -> list[Path]:
    """Draw all figures of a handout into a folder, as PNG files of their names.

    Raises:
        IoError: the folder does not exist or the disk is full.
    """
    return [
        save_figure(make(module)[0], folder / f"{name}.png", dpi) for name, make in figures.items()
    ]

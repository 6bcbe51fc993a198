"""Pictures of an exploration: files beside it, and in a notebook below the cell."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from .environment import kernel
from .stopwatch import Stopwatch

TRUTH = {"True", "False"}  # NumPy's own truth values too


def keep_picture(figure: Any, name: str, dpi: int = 100) -> None:
    """Write a Matplotlib figure, with the same bytes every time, and show it in a notebook.

    Args:
        figure: a ``matplotlib.figure.Figure``.
        name: of the file, ``.png``; its folder is made.
        dpi: pixels per inch.
    """
    from ..viz.style import save_figure

    Path(name).parent.mkdir(parents=True, exist_ok=True)
    show_file(save_figure(figure, name, dpi))


def figure_1(draw: Callable[[ModuleType], tuple[Any, dict[str, Any]]], module: ModuleType) -> None:
    """Make Figure 1 of the handout with the student's functions, and say what its caption claims.

    Args:
        draw: of the kit's `data/figure_1.py`, with which the handout's figure is drawn as well.
        module: the student's.
    """
    from ..viz.style import HANDOUT_DPI, house_style

    watch = Stopwatch()
    figure, found = house_style()(draw)(module)
    for claim, value in found.items():
        shown = bool(value) if isinstance(value, bool) or str(value) in TRUTH else f"{value:.5g}"
        sys.stdout.write(f"Figure 1: {claim}: {shown}\n")
    sys.stdout.write(f"Figure 1: figure_1.png, {watch}\n")
    keep_picture(figure, "figure_1.png", HANDOUT_DPI)


def show_file(name: str | Path) -> None:
    """Show a written PNG or GIF below the cell; nothing where no notebook runs.

    Args:
        name: of the file.
    """
    if kernel() is None:
        return
    display = importlib.import_module("IPython.display")
    display.display(display.Image(filename=str(name)))

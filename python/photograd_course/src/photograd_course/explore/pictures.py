"""Pictures of an exploration: files beside it, and in a notebook below the cell."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from .environment import kernel


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


def show_file(name: str | Path) -> None:
    """Show a written PNG or GIF below the cell; nothing where no notebook runs.

    Args:
        name: of the file.
    """
    if kernel() is None:
        return
    display = importlib.import_module("IPython.display")
    display.display(display.Image(filename=str(name)))

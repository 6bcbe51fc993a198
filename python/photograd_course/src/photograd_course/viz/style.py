"""How every figure of the course looks: colors, type, layout in inches, files of fixed bytes.

Figures are built from ``matplotlib.figure.Figure`` on an Agg canvas, so that nothing depends on a
display, on pyplot's current figure or on the reader's own matplotlibrc.

Colors: the signed map is ColorBrewer's RdBu, which readers with a red-green weakness can tell
apart, with its gray center replaced by white so that zero is exactly the color of paper;
magnitudes use viridis. [Harrower2003]
"""

from __future__ import annotations

import io
import math
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from ..atomic_io import atomic_write

DPI = 160
HANDOUT_DPI = 110  # 7 inches wide gives 770 pixels
INK = "#22262b"  # text
FRAME = "#8a9097"  # axes frames, ticks
GUIDE = "#5b6168"  # thin lines drawn over a picture
BLUE, RED, ORANGE, GRAY = "#2166ac", "#b2182b", "#d9730d", "#9aa0a6"
MAGNITUDE_MAP = "viridis"
MISSING = "#cfd3d7"  # pixels that a photograph does not have, voxels that do not exist

GRADIENT = r"$\partial L\,/\,\partial\sigma_t$"  # dL/dsigma_t, what signed pictures usually show

TITLE_SIZE, LABEL_SIZE, SMALL_SIZE = 9.5, 8.5, 7.5  # points

_HOUSE_RC: dict[str, Any] = {
    "font.family": ["DejaVu Sans"],  # ships inside Matplotlib: the same outlines everywhere
    "mathtext.fontset": "dejavusans",
    "font.size": LABEL_SIZE,
    "text.color": INK,
    "axes.titlesize": TITLE_SIZE,
    "axes.titlepad": 5.0,
    "axes.labelsize": LABEL_SIZE,
    "axes.labelcolor": INK,
    "axes.labelpad": 3.0,
    "axes.edgecolor": FRAME,
    "axes.linewidth": 0.7,
    "xtick.color": FRAME,
    "ytick.color": FRAME,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": SMALL_SIZE,
    "ytick.labelsize": SMALL_SIZE,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "grid.color": "#e4e7ea",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.5,
    "legend.fontsize": SMALL_SIZE,
    "legend.frameon": False,
}
# What belongs to the running process rather than to the look of a figure.
_NOT_STYLE = ("backend", "interactive", "toolbar", "webagg.", "tk.", "macosx.", "keymap.")


@contextmanager
def house_style() -> Iterator[None]:
    """Matplotlib's own defaults plus the house settings, undone on leaving."""
    settings: dict[Any, Any] = {
        name: value
        for name, value in mpl.rcParamsDefault.items()
        if not name.startswith(_NOT_STYLE)
    }
    with mpl.rc_context(rc=settings | _HOUSE_RC):
        yield


def signed_color_map() -> LinearSegmentedColormap:
    """Blue for negative, white for exactly zero, red for positive.

    The table has an odd number of entries, so that zero owns the middle one.
    """
    anchors = list(mpl.colormaps["RdBu_r"](range(0, 256, 51)))  # 6 steps: 3 blue, 3 red
    colors = [*anchors[:3], (1.0, 1.0, 1.0, 1.0), *anchors[3:]]
    positions = [0.0, 0.18, 0.36, 0.5, 0.64, 0.82, 1.0]
    table = list(zip(positions, colors, strict=True))
    return LinearSegmentedColormap.from_list("photograd_signed", table, N=511)


def symmetric_scale(limit: float) -> Normalize:
    """The color scale ``[-limit, limit]``."""
    return Normalize(vmin=-limit, vmax=limit)


def new_figure(width: float, height: float) -> Figure:
    """An empty white figure of ``width`` x ``height`` inches on an Agg canvas."""
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def place_axes(figure: Figure, left: float, top: float, width: float, height: float) -> Axes:
    """Axes at ``left``, ``top`` (inches from the upper left corner) of the given size in inches."""
    total_width, total_height = figure.get_size_inches()
    return figure.add_axes(
        (
            left / total_width,
            1.0 - (top + height) / total_height,
            width / total_width,
            height / total_height,
        )
    )


def color_bar(
    figure: Figure,
    box: tuple[float, float, float, float],
    mappable: ScalarMappable,
    label: str,
    *,
    unit: str = "",
    extend: str = "neither",
) -> Colorbar:
    """A vertical color bar at ``box`` = (left, top, width, height) inches.

    A power of ten is taken out of the tick labels and written once, in the label. ``extend`` says
    which ends of the scale are clipped (``neither | min | max | both``).
    """
    axes = place_axes(figure, *box)
    bar = figure.colorbar(mappable, cax=axes, extend=extend, extendfrac=0.035)
    low, high = mappable.get_clim()
    exponent = math.floor(math.log10(max(abs(low), abs(high))) + 1e-9)
    if -2 <= exponent <= 2:
        exponent = 0
    ticks = [low + (high - low) * i / 4 for i in range(5)]
    bar.set_ticks(ticks, labels=[_tick_text(tick / 10.0**exponent) for tick in ticks])
    factor = "" if exponent == 0 else rf"$\times 10^{{{exponent}}}$"
    inside = " ".join(part for part in (factor, unit) if part)
    bar.set_label(f"{label}  [{inside}]" if inside else label)
    bar.outline.set_linewidth(0.7)
    bar.outline.set_edgecolor(FRAME)
    return bar


def power_text(value: float) -> str:
    """``value`` in mathtext, with a power of ten where that is shorter."""
    exponent = math.floor(math.log10(abs(value)) + 1e-9)
    if -2 <= exponent <= 2:
        return _tick_text(value)
    return rf"${value / 10.0**exponent:.3g} \times 10^{{{exponent}}}$"


def _tick_text(value: float) -> str:
    """Up to three significant digits, a true minus sign, and a plain 0."""
    text = f"{value:.3g}"
    return "0" if text in {"0", "-0"} else text.replace("-", "\N{MINUS SIGN}")


def caption_lines(text: str, width: float) -> list[str]:
    """``text`` broken into lines that fit ``width`` inches at the caption's size."""
    # DejaVu Sans averages 0.56 em a character in running English text.
    columns = max(20, int(width * 72.0 / (0.56 * SMALL_SIZE)))
    return [line for part in text.splitlines() for line in textwrap.wrap(part, columns)]


def caption_height(text: str | None, width: float) -> float:
    """Inches that :func:`write_caption` needs, including the gap above it."""
    return 0.0 if not text else 0.16 + 0.155 * len(caption_lines(text, width))


def write_title(figure: Figure, text: str | None, *, left: float) -> None:
    """Write ``text`` at the upper edge of the figure, ``left`` inches from its side."""
    if not text:
        return
    total_width, total_height = figure.get_size_inches()
    figure.text(
        left / total_width,
        1.0 - 0.12 / total_height,
        text,
        fontsize=TITLE_SIZE + 1.5,
        fontweight="bold",
        color=INK,
        va="top",
        ha="left",
    )


def write_caption(figure: Figure, text: str | None, *, left: float, right: float) -> None:
    """Write ``text`` at the lower edge of the figure, between margins given in inches."""
    if not text:
        return
    total_width, total_height = figure.get_size_inches()
    lines = caption_lines(text, total_width - left - right)
    figure.text(
        left / total_width,
        0.1 / total_height,
        "\n".join(lines),
        fontsize=SMALL_SIZE,
        color=INK,
        va="bottom",
        ha="left",
        linespacing=1.35,
    )


def plain_axes(axes: Axes) -> None:
    """A grid, and no frame above and at the right."""
    axes.grid(visible=True)
    axes.spines[["top", "right"]].set_visible(False)


def png_bytes(figure: Figure, dpi: int = DPI) -> bytes:
    """``figure`` as the bytes of a PNG file, the same every time."""
    buffer = io.BytesIO()
    with house_style():
        # Without the Software entry the bytes carry neither a version nor a date.
        figure.savefig(buffer, format="png", dpi=dpi, metadata={"Software": None})
    return buffer.getvalue()


def save_figure(figure: Figure, path: str | Path, dpi: int = DPI) -> Path:
    """Write ``figure`` as PNG, whole or not at all, with the same bytes every time.

    Args:
        figure: to be written.
        path: of the file.
        dpi: pixels per inch.

    Raises:
        IoError: the folder does not exist or the disk is full; an older file stays as it was.
    """
    return atomic_write(Path(path), png_bytes(figure, dpi))

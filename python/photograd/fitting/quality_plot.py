"""One figure of a comparison: quality against bytes, a panel for each capture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from photograd_course.viz import style

from photograd.fitting.compare import Score

PANEL, GAP, LEFT, TOP = 2.5, 0.6, 0.6, 0.75  # inches
ROW = 0.145  # of a legend's line
COLORS = (style.BLUE, style.ORANGE, style.RED, "#1b7837", "#762a83", style.GRAY)
_ROUND = [digit * 10.0**power for power in range(-3, 5) for digit in (1, 2, 5)]
MARKERS = ("o", "s", "^", "D", "v", "P", "X")


def quality_plot(scores: Sequence[Score]) -> Figure:
    """PSNR on held-out views over the bytes of the parameters, for every capture and candidate.

    Up is better, left is smaller; beside each mark stand its training seconds. Candidates of one
    representation share a color.

    Args:
        scores: of candidates on one or more captures.
    """
    captures = list(dict.fromkeys(score.capture for score in scores))
    labels = list(dict.fromkeys(score.candidate for score in scores))
    kinds = list(dict.fromkeys(label.split(":")[0] for label in labels))
    looks = {
        label: (COLORS[kinds.index(label.split(":")[0]) % len(COLORS)], MARKERS[k % len(MARKERS)])
        for k, label in enumerate(labels)
    }
    caption = "Held-out PSNR over bytes of parameters; the numbers are seconds of training."
    bottom = 0.5 + ROW * -(-len(labels) // 3) + style.caption_height(caption, 5.0)
    width = LEFT + len(captures) * (PANEL + GAP)
    with style.house_style():
        figure = style.new_figure(max(width, 5.2), TOP + PANEL + bottom)
        for k, capture in enumerate(captures):
            axes = style.place_axes(figure, LEFT + k * (PANEL + GAP), TOP, PANEL, PANEL)
            _panel(axes, [score for score in scores if score.capture == capture], looks)
            axes.set_title(capture)
            axes.set_xlabel("parameters [MB]")
            if k == 0:
                axes.set_ylabel("PSNR [dB]")
        handles = [
            figure.axes[0].plot([], [], mark, color=color, label=label, linestyle="none")[0]
            for label, (color, mark) in looks.items()
        ]
        height = figure.get_size_inches()[1]
        anchor = (LEFT / figure.get_size_inches()[0], 1 - (TOP + PANEL + 0.4) / height)
        figure.legend(handles=handles, loc="upper left", bbox_to_anchor=anchor, ncols=3)
        style.write_title(figure, "Quality against size", left=LEFT)
        style.write_caption(figure, caption, left=LEFT, right=0.1)
    return figure


def _panel(axes: Axes, scores: Sequence[Score], looks: dict[str, tuple[str, str]]) -> None:
    """One capture's marks, each with its seconds."""
    axes.set_xscale("log")
    for score in scores:
        color, mark = looks[score.candidate]
        x = score.parameter_bytes / 1e6
        axes.plot([x], [score.psnr], mark, color=color)
        left = _crowded(score, scores)
        axes.annotate(
            f"{score.train_seconds:.0f} s",
            (x, score.psnr),
            xytext=(-5, -10) if left else (5, 3),
            ha="right" if left else "left",
            textcoords="offset points",
            fontsize=style.SMALL_SIZE,
        )
    low, high = axes.get_xlim()
    marks = [mark for mark in _ROUND if 0.5 * low < mark < 2 * high]
    axes.set_xticks(marks, labels=[f"{mark:g}" for mark in marks])
    axes.minorticks_off()
    axes.set_xlim(low / 1.4, high * 2)
    axes.grid(visible=True)
    axes.set_axisbelow(True)
    axes.margins(y=0.2)


def _crowded(score: Score, scores: Sequence[Score]) -> bool:
    """Whether another mark stands where the seconds of this one would."""
    wide = np.ptp([np.log(other.parameter_bytes) for other in scores])
    high = np.ptp([other.psnr for other in scores])
    return any(
        0 <= np.log(other.parameter_bytes / score.parameter_bytes) < 0.3 * wide
        and abs(other.psnr - score.psnr) < 0.15 * high
        for other in scores
        if other is not score
    )

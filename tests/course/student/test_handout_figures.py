"""What the figures of handouts share: facts, the house style, files."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
import pytest
from photograd_course.viz.handout import Fact, figures_of, note, save_figures, subplots
from PIL import Image


@pytest.mark.parametrize(
    ("fact", "holds"),
    [
        (Fact(True), True),
        (Fact(np.bool_(False)), False),
        (Fact(0.5, 0.0, 1.0), True),
        (Fact(np.float64(1.0), 0, 1), True),
        (Fact(1.5, 0.0, 1.0), False),
        (Fact(math.nan, 0.0, 1.0), False),
        (Fact(0.0, 0, 0, red="some_mutant"), True),
    ],
)
def test_a_fact_holds_or_does_not(fact: Fact, holds: bool) -> None:
    assert fact.holds is holds


def fig1_line(module):
    """A line of the module's slope."""
    figure, (left, right) = subplots(3.0, 1.5, 1, 2, width_ratios=(2, 1))
    left.plot([0, 1], [0, module.slope])
    note(right, "here", (0.5, 0.5), (4, 2))
    assert mpl.rcParams["axes.linewidth"] == 0.7
    return figure, {"it rises": Fact(module.slope, 0.5, 2.0)}


def test_figures_are_drawn_in_the_house_style_and_saved(tmp_path: Path) -> None:
    figures = figures_of(fig1_line)
    assert list(figures) == ["fig1_line"]
    before = mpl.rcParams["axes.linewidth"]
    figure, facts = figures["fig1_line"](SimpleNamespace(slope=1.0))
    assert mpl.rcParams["axes.linewidth"] == before
    assert facts["it rises"].holds
    assert [text.get_text() for text in figure.axes[1].texts] == ["here"]
    (path,) = save_figures(figures, SimpleNamespace(slope=1.0), tmp_path, dpi=50)
    assert path == tmp_path / "fig1_line.png"
    with Image.open(path) as image:
        assert image.size == (150, 75)

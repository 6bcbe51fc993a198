"""The figure of assignment 00, and the facts its caption claims."""

from __future__ import annotations

from types import ModuleType

from matplotlib.figure import Figure
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.handout import Fact, figures_of

FIGURE_1 = kit_module("00_setup", "figure_1")


def fig1_gradient(module: ModuleType) -> tuple[Figure, dict[str, bool]]:
    """An image, the photograph, and the derivative of the loss with respect to each pixel."""
    figure, found = FIGURE_1.draw(module)
    facts = {
        "positive where the picture is too bright": Fact(
            found["positive where the picture is too bright"]
        ),
        "negative where it is too dark": Fact(found["negative where it is too dark"]),
        "zero where both agree": Fact(found["zero where both agree"]),
    }
    return figure, facts


FIGURES = figures_of(fig1_gradient)
RED = {"fig1_gradient": "sign"}

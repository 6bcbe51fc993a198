"""The drawing in docs/architecture.md: `python docs/figures_architecture.py`.

The layers of Python are read from pyproject.toml, where import-linter reads them; the modules of
C++ are the folders of cpp/photograd, in the order of docs/architecture.md.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from photograd_course.viz import save_figure

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
PICTURE = DOCS / "images" / "architecture.png"
PYTHON, CPP, COURSE, LINK = "#dbe7f3", "#e6efdc", "#f6e8d2", "#eeeeee"
FORWARD, BACKWARD = "#2b5f8f", "#b04a2f"
WIDTH, GAP = 6.0, 0.1


def python_layers() -> list[list[str]]:
    """Public packages of photograd, a list for each layer, the highest first."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = table["tool"]["importlinter"]["contracts"]
    layers = next(each["layers"] for each in contracts if each["type"] == "layers")
    names = [[name for name in layer.split(" | ") if name[0] != "_"] for layer in layers]
    return [layer for layer in names if layer]


def cpp_layers() -> list[list[str]]:
    """Modules of the C++ core that exist, a list for each layer, the highest first."""
    text = (DOCS / "architecture.md").read_text(encoding="utf-8")
    order = re.search(r"^core → .*?Python$", text, re.MULTILINE | re.DOTALL)
    assert order is not None
    layers = [re.findall(r"\w+", part) for part in order[0].split("→")[:-2]]
    folders = {path.name for path in (ROOT / "cpp/photograd").iterdir()}
    return [[name for name in layer if name in folders] for layer in reversed(layers)]


def row(axes: Axes, x: float, y: float, names: list[str], color: str, width: float = WIDTH) -> None:
    """Boxes beside each other."""
    each = (width - GAP * (len(names) - 1)) / len(names)
    for i, name in enumerate(names):
        left = x + i * (each + GAP)
        box = FancyBboxPatch(
            (left, y), each, 0.7, "round,pad=0,rounding_size=0.12", fc=color, ec="#555555", lw=0.7
        )
        axes.add_patch(box)
        axes.text(left + each / 2, y + 0.34, name, ha="center", va="center", fontsize=8)


def stack(axes: Axes, x: float, top: float, layers: list[list[str]], color: str) -> float:
    """Rows of boxes below each other; where they end."""
    for i, names in enumerate(layers):
        row(axes, x, top - 0.85 * (i + 1), names, color)
    return top - 0.85 * len(layers)


def arrow(axes: Axes, x: float, start: float, end: float, color: str, text: str) -> None:
    """A vertical arrow with its meaning beside it."""
    axes.annotate(
        "", (x, end), (x, start), arrowprops={"arrowstyle": "-|>", "color": color, "lw": 2}
    )
    side = 0.18 if color == BACKWARD else -0.18
    at = (start + end) / 2
    axes.text(x + side, at, text, color=color, fontsize=8, rotation=90, ha="center", va="center")


def main() -> None:
    """Draw."""
    figure = Figure(figsize=(7.6, 7.8))
    axes = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    axes.text(0, 0.15, "photograd (Python)", fontsize=10, weight="bold")
    end = stack(axes, 0, 0, python_layers(), PYTHON)
    row(axes, 0, end - 0.95, ["_core: pybind11 bindings, no mathematics"], LINK)
    axes.text(0, end - 1.4, "C++ core", fontsize=10, weight="bold", va="center")
    bottom = stack(axes, 0, end - 1.6, cpp_layers(), CPP)
    row(axes, 0, bottom - 0.95, ["Embree", "OpenVDB", "TBB", "GLM"], LINK)
    lowest = bottom - 0.95
    axes.text(8.0, 0.15, "photograd_course", fontsize=10, weight="bold")
    course = ["gradcheck, losses,\noptimizers, pictures", "assignment, student", "worker, grading"]
    for i, name in enumerate([*course, "build", "assignments/"]):
        row(axes, 8.0, -0.85 * (i + 1), [name], COURSE, 3.0)
    arrow(axes, 6.55, -3.4, lowest + 1.0, FORWARD, "render: parameters to pixels")
    arrow(axes, 7.05, lowest + 1.0, -3.4, BACKWARD, "adjoint: cotangents to derivatives")
    axes.text(
        8.0,
        lowest + 1.6,
        "On the left, each box\nimports or includes only\nwhat stands below it.\n\n"
        "photograd imports\nphotograd_course,\nnever the other way.",
        fontsize=8,
        va="bottom",
    )
    axes.set(xlim=(-0.2, 11.2), ylim=(lowest - 0.2, 0.6))
    axes.axis("off")
    save_figure(figure, PICTURE)


if __name__ == "__main__":
    main()

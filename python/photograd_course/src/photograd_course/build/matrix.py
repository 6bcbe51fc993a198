"""Which checks kill which mutants, from a run: a table and a picture for instructors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..viz.style import BLUE, FRAME, ORANGE, house_style, new_figure, place_axes, png_bytes
from .assignment_build import AssignmentBuild

CELL = 0.15  # inches
TEXT_FILE, PICTURE_FILE = "kills.txt", "kills.png"


def kills(build: AssignmentBuild) -> dict[str, tuple[str, ...]]:
    """Names of the mutants that each check kills, by the check's id."""
    verdicts = build.mutant_verdicts
    return {
        check.id: tuple(name for name, verdict in verdicts.items() if check.id in verdict.lost)
        for check in build.checks
    }


def matrix_files(build: AssignmentBuild) -> dict[str, bytes]:
    """The table and the picture, by file name; none where there are no mutants."""
    by_check = kills(build)
    names = list(build.mutant_verdicts)
    if not names:
        return {}
    with house_style():
        picture = png_bytes(draw_kills(build.folder.name, names, by_check))
    return {TEXT_FILE: kill_table(names, by_check).encode(), PICTURE_FILE: picture}


def kill_table(names: Sequence[str], by_check: Mapping[str, Sequence[str]]) -> str:
    """A line for each check with what it kills, then the matrix: a row for each mutant.

    Args:
        names: of the mutants, in the order of the rows.
        by_check: from `kills`.
    """
    width = max(map(len, [*names, *by_check]))
    lines = [f"{'check':{width}}    #  kills"]
    for number, (check, dead) in enumerate(by_check.items(), start=1):
        lines.append(f"{check:{width}}  {number:3}  {len(dead)}")
    lines += ["", f"{'mutant':{width}}  " + "".join(f"{k:3}" for k in range(1, len(by_check) + 1))]
    for name in names:
        cells = "".join("  x" if name in dead else "  ." for dead in by_check.values())
        lines.append(f"{name:{width}}  {cells}")
    return "\n".join(lines) + "\n"


def cells(names: Sequence[str], by_check: Mapping[str, Sequence[str]]) -> NDArray[np.int64]:
    """(mutants, checks): 1 where the check kills the mutant, 2 where it is the only one, else 0."""
    dead = np.array([[int(name in found) for found in by_check.values()] for name in names])
    return np.where(dead.sum(axis=1, keepdims=True) == 1, 2 * dead, dead)


def draw_kills(title: str, names: Sequence[str], by_check: Mapping[str, Sequence[str]]) -> Figure:
    """The matrix mutant x check as a picture.

    A cell is filled where the check kills the mutant, in orange where no other check does.
    """
    shown = cells(names, by_check)
    rows, columns = shown.shape
    left, top = 0.2 + 0.07 * max(map(len, names)), 0.45 + 0.07 * max(map(len, by_check))
    figure = new_figure(left + CELL * columns + 0.15, top + CELL * rows + 0.15)
    axes = place_axes(figure, left, top, CELL * columns, CELL * rows)
    axes.imshow(shown, cmap=ListedColormap(["white", BLUE, ORANGE]), vmin=0, vmax=2, aspect="auto")
    axes.set_xticks(range(columns), list(by_check), rotation=90, fontsize=6)
    axes.set_yticks(range(rows), list(names), fontsize=6)
    axes.xaxis.tick_top()
    axes.set_xticks(np.arange(columns + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(rows + 1) - 0.5, minor=True)
    axes.grid(which="minor", color=FRAME, linewidth=0.2)
    axes.tick_params(which="both", length=0)
    figure.suptitle(f"{title}: checks that kill a mutant; orange: the only one", fontsize=7)
    return figure

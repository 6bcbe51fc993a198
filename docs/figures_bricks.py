"""The picture of bricks and hash levels: `python docs/figures_bricks.py` writes it.

The same gradient as in figures_octree.py, as two other sparse structures would hold it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from figures_octree import (
    BOX,
    IMAGES,
    PANEL,
    RESOLUTION,
    model_without_the_last_ball,
    outline_balls,
    photographs,
    squares,
)
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.fitting.voxel_gradients import density_gradient
from photograd.grids.sparse import SparseGrid
from photograd.grids.voxel_hash import VoxelHash
from photograd_course.viz import save_figure, style
from photograd_course.viz.scale import signed_scale

Array = NDArray[Any]
BRICK = 8
LEVELS = (8, 16, 32)  # cells a side of the box


def blocks(dense: Array, cells: int) -> Array:
    """Sums over cubes, (cells, cells, cells): what a parameter that all their voxels share gets."""
    side = len(dense) // cells
    return dense.reshape(cells, side, cells, side, cells, side).sum(axis=(1, 3, 5))


def active_bricks(full: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The bricks that a sparse grid keeps for the full voxels and one voxel around them."""
    grid = SparseGrid.from_dense(full.astype(np.float32))
    grid.dilate(1)
    origins, _ = grid.core.leaves()
    kept = np.zeros((RESOLUTION // BRICK,) * 3, np.bool_)
    inside = ((origins >= 0) & (origins < RESOLUTION)).all(axis=1)
    kept[tuple((origins[inside] // BRICK).T)] = True
    return kept


def hash_levels(d_sigma_t: Array, limit: float) -> list[tuple[Array, Array]]:
    """For each level the cells (M, 3) that its table holds, and their gradient a voxel (M,).

    The coarsest level holds all cells. A cell of the next is entered where a voxel of its parent
    asks for more than half of `limit`.
    """
    levels: list[tuple[Array, Array]] = []
    wish = np.abs(d_sigma_t) > 0.5 * limit
    for number, cells in enumerate(LEVELS):
        wanted = np.ones((cells,) * 3, np.bool_)
        if number:
            parents = blocks(wish, LEVELS[number - 1]) > 0
            wanted = parents.repeat(2, axis=0).repeat(2, axis=1).repeat(2, axis=2)
        table = VoxelHash(np.argwhere(wanted).astype(np.int32))
        voxels, rows = table.items()
        gradient = np.zeros(len(table))
        mean = blocks(d_sigma_t, cells) / (RESOLUTION // cells) ** 3
        gradient[rows] = mean[tuple(voxels.T)]
        ordered = np.empty((len(table), 3), np.int32)
        ordered[rows] = voxels
        levels.append((ordered, gradient))
    return levels


def draw_cells(axes: Axes, cells: Array, gradient: Array, count: int, limit: float) -> None:
    """The cells of a level with `count` cells a side that the middle layer meets."""
    met = cells[:, 2] == count // 2
    side = 2.0 / count
    axes.add_collection(
        PatchCollection(
            squares(cells[met, :2] * side - 1.0, np.full(int(met.sum()), side)),
            facecolors=style.signed_color_map()(style.symmetric_scale(limit)(gradient[met])),
            edgecolors=style.FRAME,
            linewidths=0.35,
        )
    )


def bricks_figure() -> Figure:
    """One gradient as the bricks of a sparse grid, and three levels of a hash table, hold it."""
    field, full = model_without_the_last_ball()
    d_sigma_t = density_gradient(field, photographs(96), seed=0, rays=1 << 18).d_sigma_t
    middle = d_sigma_t[:, :, RESOLUTION // 2 : RESOLUTION // 2 + 1]
    limit = signed_scale("bricks_figure", [middle], None, quantile=0.98).limit
    kept = np.argwhere(active_bricks(full))
    mean = blocks(d_sigma_t, RESOLUTION // BRICK)[tuple(kept.T)] / BRICK**3
    panels = [("active bricks", kept, mean, RESOLUTION // BRICK)]
    for (cells, gradient), count in zip(hash_levels(d_sigma_t, limit), LEVELS, strict=True):
        panels.append((f"hash level, {count} a side", cells, gradient, count))
    with style.house_style():
        figure = style.new_figure(4 * PANEL + 1.6, PANEL + 1.05)
        for k, (words, cells, gradient, count) in enumerate(panels):
            axes = style.place_axes(figure, 0.15 + k * (PANEL + 0.15), 0.35, PANEL, PANEL)
            axes.set_facecolor("#f1f1f1")  # gray: what the structure does not hold
            draw_cells(axes, cells, gradient, count, limit)
            outline_balls(axes, (RESOLUTION // 2 + 0.5) * 2.0 / RESOLUTION - 1.0)
            axes.set(xlim=BOX[:, 0], ylim=BOX[:, 1], xticks=[], yticks=[], aspect="equal")
            axes.set_title(f"{words}: {len(cells):,} cells")
        mappable = ScalarMappable(style.symmetric_scale(limit), style.signed_color_map())
        style.color_bar(
            figure,
            (4 * PANEL + 0.77, 0.35, 0.12, PANEL),
            mappable,
            style.GRADIENT + " a voxel",
            extend="both",
        )
        style.write_caption(
            figure,
            "The same slice of the same gradient: blue wants matter, red wants less of it, gray is "
            "not stored. The bricks of a sparse grid surround what the model has (solid), so the "
            "wish for the ball that it lacks (dashed) reaches no parameter and is lost. A hash "
            "table with levels covers everything coarsely, and holds finer cells only where voxels "
            "ask for them: the wish is heard first and located later.",
            left=0.15,
            right=0.15,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(bricks_figure(), IMAGES / "bricks_gradient.png")


if __name__ == "__main__":
    main()

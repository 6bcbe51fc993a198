"""The pictures of quadtrees and octrees: `python docs/figures_octree.py` writes both."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.capture.view import View
from photograd.fields import DenseGrid
from photograd.fitting.data import TrainingPixels
from photograd.fitting.voxel_gradients import density_gradient
from photograd.grids.octree import Octree, Quadtree
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style
from photograd_course.viz.scale import signed_scale

Array = NDArray[Any]
IMAGES = Path(__file__).resolve().parent / "images"
FULL, EMPTY = "#7d9cc0", "#ffffff"
PANEL = 2.55  # inches

BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
RESOLUTION = 64
BALLS = (  # center, radius, linear color; the last one is in the photographs and not in the model
    ((-0.42, 0.2, 0.0), 0.33, (0.8, 0.25, 0.1)),
    ((0.15, -0.42, 0.05), 0.28, (0.15, 0.5, 0.2)),
    ((0.45, 0.38, -0.05), 0.22, (0.15, 0.25, 0.8)),
)


def cat(x: Array, y: Array) -> Array:
    """Whether points of the unit square lie in the head of a cat that looks at us."""
    face = ((x - 0.5) / 0.36) ** 2 + ((y - 0.43) / 0.31) ** 2 < 1.0
    ears = np.zeros_like(face)
    for side in (-1.0, 1.0):
        u = (x - 0.5) * side
        ears |= (u > 0.07) & (u < 0.345) & (y > 0.45) & (y < 0.62 + 1.15 * (u - 0.07))
        ears &= ~((u > 0.07) & (y > 0.93 - 4.5 * (u - 0.27)) & (u > 0.27))
    eyes = np.zeros_like(face)
    for side in (-1.0, 1.0):
        eyes |= (((x - 0.5) * side - 0.14) / 0.065) ** 2 + ((y - 0.5) / 0.045) ** 2 < 1.0
    nose = (np.abs(x - 0.5) < 0.6 * (y - 0.33)) & (y < 0.385)
    whole: Array = (face | ears) & ~eyes & ~nose
    return whole


def cat_tree(depth: int) -> Quadtree:
    """The drawing sampled in the middle of 4^depth cells."""
    at = (np.arange(1 << depth) + 0.5) / (1 << depth)
    x, y = np.meshgrid(at, at, indexing="ij")
    return Quadtree.from_dense(cat(x, y)[..., None], [[0.0, 0.0], [1.0, 1.0]])


def squares(lower: Array, side: Array) -> list[Rectangle]:
    """One rectangle a leaf; lower (L, 2) and side (L,) in the units of the axes."""
    return [Rectangle(tuple(at), s, s) for at, s in zip(lower.tolist(), side.tolist(), strict=True)]


def draw_quadtree(axes: Axes, depth: int) -> None:
    """Leaves of the drawing at 2^depth cells a side."""
    tree = cat_tree(depth)
    lower, side = tree.leaf_boxes()
    cell = 1.0 / (1 << depth)
    colors = np.where(tree.values[:, 0], FULL, EMPTY)
    axes.add_collection(
        PatchCollection(
            squares(lower * cell, side * cell),
            facecolors=colors,
            edgecolors=style.GUIDE,
            linewidths=0.8 if depth < 6 else 0.4,
        )
    )
    axes.set(xlim=(0, 1), ylim=(0, 1), xticks=[], yticks=[], aspect="equal")
    axes.set_title(f"{1 << depth} × {1 << depth} cells: {len(side)} leaves")


def draw_growth(axes: Axes) -> None:
    """Leaves against cells: the outline is a line, the cells fill the plane."""
    depths = np.arange(3, 12)
    n = 2.0**depths
    leaves = np.array([len(cat_tree(int(depth)).values) for depth in depths])
    axes.loglog(n, n**2, "o-", color=style.GRAY, markersize=3, label="cells of the array")
    axes.loglog(n, leaves, "o-", color=style.BLUE, markersize=3, label="leaves of the quadtree")
    slope = np.log2(leaves[-1] / leaves[-4]) / 3
    axes.text(n[-2], leaves[-2] / 4, f"slope {slope:.2f}", color=style.BLUE, ha="center")
    axes.text(n[-4], n[-4] ** 2 * 2.2, "slope 2", color=style.GUIDE, ha="right")
    axes.set(xlabel="cells a side", xticks=[8, 32, 128, 512, 2048])
    axes.set_xticklabels(["8", "32", "128", "512", "2048"])
    axes.minorticks_off()
    axes.grid(visible=True)
    axes.legend(loc="upper left")
    axes.set_title("what it costs")


def quadtree_figure() -> Figure:
    """A drawing as a quadtree, coarse and fine, and what both cost."""
    with style.house_style():
        figure = style.new_figure(3 * PANEL + 1.5, PANEL + 1.25)
        for k, depth in enumerate((4, 7)):
            left = 0.15 + k * (PANEL + 0.2)
            draw_quadtree(style.place_axes(figure, left, 0.35, PANEL, PANEL), depth)
        draw_growth(style.place_axes(figure, 2 * PANEL + 1.15, 0.35, PANEL, PANEL))
        style.write_caption(
            figure,
            "A square is cut into four until it is empty (white) or full (blue), or one cell. "
            "Small squares are needed along the outline alone: twice the resolution takes twice "
            "as many leaves, but four times as many cells.",
            left=0.15,
            right=0.15,
        )
    return figure


def photograph(camera: Camera) -> Array:
    """(H, W, 4) of all balls, opaque and evenly colored, exact for the ray of each pixel."""
    origins, directions = camera.rays()
    nearest = np.full(len(origins), np.inf)
    rgba = np.zeros((len(origins), 4), np.float32)
    for center, radius, color in BALLS:
        offset = np.array(center) - origins
        along = (offset * directions).sum(axis=1)
        gap = radius**2 - ((offset**2).sum(axis=1) - along**2)
        t = np.where(gap > 0, along - np.sqrt(np.maximum(gap, 0.0)), np.inf)
        front = t < nearest
        nearest[front] = t[front]
        rgba[front] = (*srgb_encode(np.array(color)), 1.0)
    return rgba.reshape(camera.height, camera.width, 4)


def model_without_the_last_ball() -> tuple[DenseGrid, NDArray[np.bool_]]:
    """What a fit knows so far, and which voxels it holds to be full."""
    field = DenseGrid.empty(BOX, RESOLUTION, sigma_t=0.1)
    at = -1.0 + (np.arange(RESOLUTION) + 0.5) * 2.0 / RESOLUTION
    position = np.stack(np.meshgrid(at, at, at, indexing="ij"), axis=-1)
    full = np.zeros(position.shape[:3], np.bool_)
    for center, radius, color in BALLS[:-1]:
        inside = ((position - center) ** 2).sum(axis=-1) < radius**2
        full |= inside
        field.color[inside] = np.log(color) - np.log1p(-np.array(color))
        # softplus(raw) is raw + log(1 + exp(-raw)); 60/m leaves one part in e^2 behind a voxel.
        field.density[inside] = np.log(np.expm1(60.0 / field.policy.density_scale))
    return field, full


def draw_slice(axes: Axes, tree: Octree, gradient: Array, limit: float, layer: int) -> None:
    """Leaves of `tree` that the layer of cells meets, colored by `gradient` (L,)."""
    lower, side = tree.leaf_boxes()
    met = (lower[:, 2] <= layer) & (layer < lower[:, 2] + side)
    cell = float(tree.cell_size[0])
    collection = PatchCollection(
        squares(lower[met, :2] * cell - 1.0, side[met] * cell),
        facecolors=style.signed_color_map()(style.symmetric_scale(limit)(gradient[met])),
        edgecolors=style.FRAME,
        linewidths=0.35,
    )
    axes.add_collection(collection)


def outline_balls(axes: Axes, z: float, color: str = style.INK, *, all_known: bool = False) -> None:
    """Where the slice cuts the balls: solid what the model has, dashed what it lacks."""
    for number, (center, radius, _) in enumerate(BALLS):
        cut = np.sqrt(max(radius**2 - (z - center[2]) ** 2, 0.0))
        lacking = number == len(BALLS) - 1 and not all_known
        axes.add_patch(
            Circle(
                center[:2],
                cut,
                fill=False,
                edgecolor=color,
                linewidth=1.1,
                linestyle="--" if lacking else "-",
            )
        )


def photographs(size: int) -> TrainingPixels:
    """24 views from all around."""
    cameras = [
        camera
        for elevation in (-30.0, 5.0, 40.0)
        for camera in orbit_cameras(BOX, 8, size=size, elevation=elevation)
    ]
    views = [View(f"view_{k}", c, photograph(c)) for k, c in enumerate(cameras)]
    return TrainingPixels(views, "display")


def octree_figure() -> Figure:
    """The gradient of one step by voxel, by leaf, and by leaf after one refinement."""
    field, full = model_without_the_last_ball()
    d_sigma_t = density_gradient(field, photographs(96), seed=0, rays=1 << 18).d_sigma_t[..., None]
    layer = RESOLUTION // 2
    limit = signed_scale("octree_figure", [d_sigma_t[:, :, layer]], None, quantile=0.98).limit
    known = Octree.from_dense(full[..., None], BOX)
    # Cut where the wish is strong in single voxels: their average over a large leaf hides it.
    strong = np.abs(d_sigma_t) > 0.5 * limit
    refined = Octree.from_dense((full[..., None] * 2.0 + strong).astype(np.float32), BOX)
    with style.house_style():
        figure = style.new_figure(3 * PANEL + 1.45, PANEL + 1.05)
        panels = [
            style.place_axes(figure, 0.15 + k * (PANEL + 0.15), 0.35, PANEL, PANEL)
            for k in range(3)
        ]
        panels[0].imshow(
            d_sigma_t[:, :, layer, 0].T,
            origin="lower",
            extent=(-1, 1, -1, 1),
            cmap=style.signed_color_map(),
            norm=style.symmetric_scale(limit),
        )
        panels[0].set_title(f"by voxel: {RESOLUTION**3:,} numbers")
        for axes, tree, words in (
            (panels[1], known, "leaves of the model"),
            (panels[2], refined, "cut where voxels ask"),
        ):
            _, side = tree.leaf_boxes()
            mean = tree.expand_backward(d_sigma_t)[:, 0] / side.astype(np.float64) ** 3
            draw_slice(axes, tree, mean, limit, layer)
            axes.set_title(f"{words}: {len(side):,} numbers")
        for axes in panels:
            outline_balls(axes, (layer + 0.5) * 2.0 / RESOLUTION - 1.0)
            axes.set(xlim=(-1, 1), ylim=(-1, 1), xticks=[], yticks=[], aspect="equal")
        mappable = ScalarMappable(style.symmetric_scale(limit), style.signed_color_map())
        style.color_bar(
            figure,
            (3 * PANEL + 0.62, 0.35, 0.12, PANEL),
            mappable,
            style.GRADIENT + " a voxel",
            extend="both",
        )
        style.write_caption(
            figure,
            "A slice through the gradient of a loss: blue wants matter, red wants less of it. The "
            "model knows two balls (solid) and lacks one that the photographs show (dashed). Its "
            "octree has only large, empty leaves there; the gradient of a leaf is the sum over its "
            "voxels, in which wishes of both signs cancel. Where topology is fixed, it takes the "
            "voxels' own gradient to see where to cut.",
            left=0.15,
            right=0.15,
        )
    return figure


def main() -> None:
    """Write both pictures; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(quadtree_figure(), IMAGES / "quadtree.png")
    save_figure(octree_figure(), IMAGES / "octree_gradient.png")


if __name__ == "__main__":
    main()

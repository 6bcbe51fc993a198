"""The picture of a gradient that depends on direction: `python docs/figures_sh.py` writes it.

Two balls are photographed that look brighter from one side than from the other. The model knows
their shape, and one color for all directions; the gradient of its harmonics says what it lacks.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from figures_octree import BOX, IMAGES, PANEL
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray
from photograd import sh
from photograd.capture.orbit import orbit_cameras
from photograd.fields import OctreeSh
from photograd.grids.octree import Octree
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
CELLS = 16
BALLS = (  # center, radius, color towards the direction, and how much brighter it is from there
    ((-0.45, 0.0, 0.0), 0.4, 0.5, (1.0, 0.0, 0.0), 0.35),
    ((0.5, 0.05, 0.0), 0.3, 0.4, (0.0, 1.0, 0.0), 0.0),
)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 73)
LEAST = 0.15  # of the largest wish; smaller ones are not drawn


@dataclass(frozen=True)
class Wishes:
    """dL/dcolor of cells by the viewer's direction in the plane of the slice."""

    center: Array  # (M, 2)
    value: Array  # (M, angles), in units of the loss
    ball: Array  # (M,) which ball the cell is in


def model() -> tuple[OctreeSh, NDArray[np.int64]]:
    """Opaque cells inside of the balls, each of its ball's mean gray; and the ball of each row."""
    at = -1.0 + (np.arange(CELLS) + 0.5) * 2.0 / CELLS
    position = np.stack(np.meshgrid(at, at, at, indexing="ij"), axis=-1)
    label = np.zeros(position.shape[:3])
    for number, (center, radius, *_) in enumerate(BALLS):
        label[((position - center) ** 2).sum(axis=-1) < radius**2] = number + 1
    # Single cells: every one has harmonics of its own.
    tree = Octree.from_function(
        lambda cell, size: None if size > 1 else [label[cell]], CELLS.bit_length() - 1, BOX
    )
    held = tree.values[:, 0].astype(np.int64)
    row = np.where(held > 0, np.cumsum(held > 0) - 1, -1).astype(np.int32)
    ball = held[held > 0] - 1
    gray = np.array([BALLS[b][2] for b in ball])
    coefficients = np.zeros((len(ball), 4, 3))
    constant = float(sh.basis(np.array([[0.0, 0.0, 1.0]]), 0)[0, 0])
    coefficients[:, 0] = (np.log(gray / (1.0 - gray)) / constant)[:, None]
    return OctreeSh(tree, row, np.full(len(ball), 40.0), coefficients), ball


def photographs(field: OctreeSh, ball: NDArray[np.int64]) -> tuple[RayBatch, Array]:
    """Rays of 24 cameras, and what they see: the model's own shape with a color by direction."""
    cameras = [
        camera
        for elevation in (-35.0, 0.0, 35.0)
        for camera in orbit_cameras(BOX, 8, size=64, elevation=elevation)
    ]
    pairs = [camera.rays() for camera in cameras]
    origins, directions = (np.concatenate(part) for part in zip(*pairs, strict=True))
    batch = RayBatch(origins, directions, np.arange(len(origins), dtype=np.uint32))
    color = np.zeros((len(origins), 3))
    gray = field.params["sh"].copy()
    for number, (_, _, mean, axis, lobe) in enumerate(BALLS):
        field.params["sh"] = gray.copy()
        field.params["sh"][ball != number, 0] = -1e3  # black: sigmoid(-280)
        seen, _ = field.render(batch, seed=0, step=0, options=RenderOptions())
        towards = -directions @ np.array(axis)  # the viewer's direction
        color += seen.color * (1.0 + lobe * towards / mean)[:, None]
    field.params["sh"] = gray
    return batch, color


def wishes() -> Wishes:
    """The gradient of the mean squared error by the color of each cell of the middle layer."""
    field, ball = model()
    batch, truth = photographs(field, ball)
    seen, context = field.render(batch, seed=0, step=0, options=RenderOptions())
    d_color = 2.0 * (seen.color - truth) / truth.size
    d_sh = field.render_backward(context, Outputs(d_color))["sh"].mean(axis=2)
    lower, _ = field.tree.leaf_boxes()
    cell = lower[field.row >= 0]
    middle = cell[:, 2] == CELLS // 2
    viewer = np.stack([np.cos(ANGLES), np.sin(ANGLES), np.zeros(len(ANGLES))], axis=-1)
    value = d_sh[middle] @ sh.basis(-viewer, 1).T
    center = -1.0 + (cell[middle, :2] + 0.5) * 2.0 / CELLS
    return Wishes(center, value, ball[middle])


def draw_glyphs(axes: Axes, found: Wishes, *, biggest: float) -> None:
    """A lobe towards each side from which the cell should change: its length is the wish."""
    ring = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=-1)
    reach = 0.95 * 2.0 / CELLS / biggest
    for sign, color in ((-1.0, style.BLUE), (1.0, style.RED)):
        length = np.maximum(sign * found.value, 0.0) * reach
        drawn = length.max(axis=1) > LEAST * reach * biggest
        shapes = found.center[drawn, None] + length[drawn, :, None] * ring
        axes.add_collection(PolyCollection(list(shapes), facecolors=color, alpha=0.85))
    cross = 0.012
    marks = [[(x - cross, y), (x + cross, y)] for x, y in found.center]
    axes.add_collection(LineCollection(marks, colors=style.FRAME, linewidths=0.8))


def sh_figure() -> Figure:
    """Where the model is too dark or too bright, and seen from where."""
    found = wishes()
    biggest = float(np.abs(found.value).max())
    with style.house_style():
        size = 1.9 * PANEL
        figure = style.new_figure(size + 2.6, 0.62 * size + 1.25)
        axes = style.place_axes(figure, 0.15, 0.35, size + 2.3, 0.62 * size)
        draw_glyphs(axes, found, biggest=biggest)
        for center, radius, *_ in BALLS:
            axes.add_patch(Circle(center[:2], radius, fill=False, edgecolor=style.GUIDE))
        axes.set(xlim=(-1.1, 1.1), ylim=(-0.55, 0.55), xticks=[], yticks=[], aspect="equal")
        axes.set_title("gradient of the harmonics of degree 0 and 1, one slice")
        axes.annotate(
            "brighter\nfrom here",
            (-0.04, 0.0),
            (0.11, -0.1),
            color=style.INK,
            ha="center",
            va="top",
            arrowprops={"arrowstyle": "->", "color": style.INK, "relpos": (0.5, 1.0)},
        )
        style.write_caption(
            figure,
            "Each glyph shows dL/dcolor of one cell by the direction of the viewer: a blue lobe "
            "towards the sides from which the cell should look brighter, a red one where it should "
            "look darker. The left ball was photographed brighter from the right, and its cells "
            "ask for just that: those on its right to look brighter, those on its left darker, for "
            "each hears only from the cameras that see it. Cells inside are seen by no ray and "
            "stay silent. The right ball looks the same from everywhere, as the model has it.",
            left=0.15,
            right=0.15,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(sh_figure(), IMAGES / "sh_gradient.png")


if __name__ == "__main__":
    main()

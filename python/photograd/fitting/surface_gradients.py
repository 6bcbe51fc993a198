"""What a photograph asks of each vertex of a mesh: through silhouettes, and inside of faces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd_course.viz import style

from photograd._notebook import EDGE, png_of_sheet, sheet
from photograd.fields.surface import SurfaceField
from photograd.fitting.data import TrainingView
from photograd.fitting.gradient_drawings import draw_picture
from photograd.fitting.loss import picture_loss, picture_loss_backward
from photograd.geometry.normals import vertex_normals
from photograd.representation import ImageBatch, RenderOptions
from photograd.types import Array, FloatArray

PANEL, GAP, LEFT, TOP = 2.6, 0.14, 0.75, 0.62  # inches
ARROWS = 300
LONGEST = 0.09  # of the picture's width: the arrow at the 98th percentile
WHITE = np.ones(3)
CAPTION = (
    "Left: the view. Arrows: where lower loss would take each visible vertex on the screen; blue "
    "outward, orange inward. Middle: what comes through "
    "silhouettes, which antialiasing makes differentiable. Right: what comes from colors inside of "
    "faces, of vertices or a texture; its arrows are {scale}."
)


@dataclass(frozen=True, eq=False)
class SurfaceGradients:
    """One view of a mesh of V vertices.

    Attributes:
        picture: (H, W, 3) the mesh over white, display values.
        pixels: (V, 2) projected vertices.
        normals: (V, 2) normals of the vertices as the camera sees them, outward.
        visible: (V,) vertices of a face or a silhouette that the view shows.
        silhouettes: (V, 2) dL/d projected vertex at a fixed depth, the part of silhouettes.
        interior: (V, 2) the same inside of faces.
        loss: of the view.
    """

    picture: Array
    pixels: FloatArray
    normals: FloatArray
    visible: NDArray[np.bool_]
    silhouettes: FloatArray
    interior: FloatArray
    loss: float

    def _repr_png_(self) -> bytes:
        """The picture."""
        return png_of_sheet(sheet([self.picture], 1, EDGE))


def surface_gradients(
    field: SurfaceField, view: TrainingView, *, ssim_weight: float = 0.2
) -> SurfaceGradients:
    """The gradient of the loss of one view, over white.

    Args:
        field: the mesh.
        view: a photograph.
        ssim_weight: share of 1 - SSIM in the loss.
    """
    outputs, context = field.render(
        ImageBatch(view.camera), seed=0, step=0, options=RenderOptions()
    )
    loss = picture_loss(outputs, view, WHITE, ssim_weight=ssim_weight)
    drawn = context.picture
    parts = drawn.position_gradients(drawn.cotangent(picture_loss_backward(loss)[0]))
    depth = drawn.positions[:, 2:]
    visible = np.zeros(len(depth), bool)
    visible[field.faces[drawn.shown].reshape(-1)] = True
    visible |= parts.silhouettes.any(axis=1)  # of faces smaller than pixels
    return SurfaceGradients(
        loss.image,
        drawn.positions[:, :2] / np.where(depth > 0, depth, np.nan),
        vertex_normals(drawn.local, field.faces)[:, :2],
        visible & (depth[:, 0] > 0),
        depth * parts.silhouettes[:, :2],
        depth * parts.interior[:, :2],
        loss.value,
    )


def draw_surface_gradients(
    rows: Mapping[int, SurfaceGradients], *, title: str | None = None
) -> Figure:
    """Three panels for each step: the view, arrows of silhouettes, arrows inside of faces.

    Args:
        rows: {step: gradients}.
        title: above everything.
    """
    left_end, right_end, lower, upper = _frame(rows)
    height = PANEL * (lower - upper) / (right_end - left_end)
    width = LEFT + 3 * (PANEL + GAP)
    factor = _factor(rows)
    scale_of_both = "drawn to the same scale" if factor == 1 else f"{factor:g} times longer"
    caption = CAPTION.format(scale=scale_of_both)
    bottom = style.caption_height(caption, width - LEFT - 0.1) + 0.05
    with style.house_style():
        figure = style.new_figure(width, TOP + len(rows) * (height + GAP) + bottom)
        for k, (step, found) in enumerate(rows.items()):
            scale = _scale(found, factor)
            for column, (name, arrows) in enumerate(
                (
                    ("view", None),
                    ("silhouettes", found.silhouettes),
                    ("inside of faces", factor * found.interior),
                )
            ):
                left = LEFT + column * (PANEL + GAP)
                axes = style.place_axes(figure, left, TOP + k * (height + GAP), PANEL, height)
                draw_picture(axes, found.picture, pale=arrows is not None)
                if arrows is None:
                    axes.set_ylabel(f"step {step}\nloss {found.loss:.3g}")
                else:
                    _draw_arrows(axes, found, -scale * arrows)
                axes.set(xlim=(left_end, right_end), ylim=(lower, upper))
                if k == 0:
                    axes.set_title(name)
        style.write_title(figure, title, left=LEFT)
        style.write_caption(figure, caption, left=LEFT, right=0.1)
    return figure


def _frame(rows: Mapping[int, SurfaceGradients]) -> tuple[float, float, float, float]:
    """What of the view is shown: x from, to, y from (below), to; the mesh of all rows, and room."""
    height, width = next(iter(rows.values())).picture.shape[:2]
    pixels = np.concatenate([found.pixels[found.visible] for found in rows.values()])
    if not len(pixels):
        return 0.0, float(width), float(height), 0.0
    room = 0.2 * float(np.ptp(pixels, axis=0).max()) + 1
    low = np.maximum(pixels.min(axis=0) - room, 0)
    high = np.minimum(pixels.max(axis=0) + room, [width, height])
    return float(low[0]), float(high[0]), float(high[1]), float(low[1])


def _strong(found: SurfaceGradients, gradient: FloatArray) -> float:
    """The 98th percentile of the lengths of what is not zero."""
    length = np.sqrt(np.square(gradient[found.visible]).sum(axis=1))
    return float(np.quantile(length[length > 0], 0.98)) if (length > 0).any() else 0.0


def _factor(rows: Mapping[int, SurfaceGradients]) -> float:
    """How much longer arrows inside of faces are drawn, one digit, the same in all rows."""
    pairs = [(_strong(r, r.silhouettes), _strong(r, r.interior)) for r in rows.values()]
    ratios = [a / b for a, b in pairs if a > 0 and b > 0]
    if not ratios:
        return 1.0
    return max(1.0, float(f"{np.median(ratios):.0e}"))


def _scale(found: SurfaceGradients, factor: float) -> float:
    strongest = max(_strong(found, found.silhouettes), factor * _strong(found, found.interior))
    return LONGEST * float(found.picture.shape[1]) / max(strongest, 1e-30)


def _draw_arrows(axes: Axes, found: SurfaceGradients, way: FloatArray) -> None:
    """`way` (V, 2) in pixels, at the vertices where it is longest."""
    length = np.where(found.visible, np.sqrt(np.square(way).sum(axis=1)), 0.0)
    rows = np.argsort(-length, kind="stable")[:ARROWS]
    rows = rows[length[rows] > 0]
    if not len(rows):
        return
    longest = 1.5 * LONGEST * found.picture.shape[1]
    way = way[rows] * np.minimum(1, longest / length[rows])[:, None]
    outward = (way * found.normals[rows]).sum(axis=1) > 0
    axes.quiver(
        *found.pixels[rows].T,
        *way.T,
        color=np.where(outward, style.BLUE, style.ORANGE),
        angles="xy",
        scale_units="xy",
        scale=1,
        width=0.006,
        headwidth=4,
        headlength=4.5,
        headaxislength=4,
    )

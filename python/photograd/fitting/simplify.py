"""A mesh of few triangles that looks like a mesh of many [Hasselgren2021].

The dense mesh is drawn from cameras all around it. The simple one starts from a decimation by
quadric errors, with the colors of the dense one at its vertices or in a texture, and its faces
stay. Its vertices, colors and, where it has them, opacities (alpha mattes) descend on

    loss = picture_loss(image, reference) + w mean (opacity - reference opacity)^2

a view at a step, over a random background. Views between those of the descent measure it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.cli import Column
from photograd_course.optim import Adam
from photograd_course.random import permutation
from photograd_course.schedules import exponential

from photograd import _descend as descent
from photograd._checks import require_bounds, require_instance, require_types
from photograd._descend import Run, changing, descend, progress_bar
from photograd.capture.camera import Camera
from photograd.capture.orbit import spiral_cameras
from photograd.errors import Error, RangeError, message
from photograd.fields.bake import baked
from photograd.fields.layered_picture import Unwrapped
from photograd.fields.mesh_surface import MeshSurface
from photograd.fields.surface import SurfaceField
from photograd.fields.surface_texels import raw_texels
from photograd.fields.textured_surface import TexturedSurface
from photograd.fitting.data import TrainingView
from photograd.fitting.drawing import render_field
from photograd.fitting.loss import decibels, picture_loss, picture_loss_backward
from photograd.fitting.steps import Background, display_background
from photograd.geometry.decimation import decimate
from photograd.geometry.unwrap import unwrap
from photograd.representation import ImageBatch, Outputs, RenderOptions
from photograd.types import Array, FloatArray

VERTEX_STEP, TEXTURED_VERTEX_STEP = 0.005, 0.015
"""Rate of the vertices at the first step, in mean lengths of an edge; a texture bears longer ones,
since its colors do not depend on where few vertices lie."""
LAST_RATE = 0.1
"""Part of all rates that is left at the last step."""
SMALLEST_TEXTURE = 8
START_OPACITY = 0.99
"""Of texels: nearly all of what a decimation shows."""
HELD_OUT = 12
"""Views that measure, and that no step sees."""
WHITE = np.ones(3)
PSNR_COLUMN = Column("psnr", "{:.2f} dB".format, label="PSNR")


@dataclass(frozen=True)
class SimplifyOptions:
    """How a mesh is simplified.

    Attributes:
        triangles: at most so many.
        views: of the dense mesh, one of them at a step.
        size: of a view in pixels along each edge.
        steps: of the descent; 0 leaves the decimation.
        texture: texels along an edge of the texture that the simple mesh gets; 0 gives it colors at
            its vertices.
        opacity: whether the texels have an opacity, which cuts outlines out of few triangles.
        silhouette_weight: w above.
        ssim_weight: share of 1 - SSIM in the loss of a picture.
        seed: of the order of the views and of the backgrounds.
    """

    triangles: int
    views: int = 48
    size: int = 128
    steps: int = 600
    texture: int = 0
    opacity: bool = False
    silhouette_weight: float = 2.0
    ssim_weight: float = 0.2
    seed: int = 0

    def __post_init__(self) -> None:
        """Raises DtypeError or RangeError, naming the option."""
        require_types(self)
        require_bounds(self, "triangles", low=4, high=2**31 - 1)
        require_bounds(self, "views", low=2, high=100_000)
        require_bounds(self, "size", low=16, high=8192)
        require_bounds(self, "steps", "seed", low=0, high=2**31 - 1)
        require_bounds(self, "texture", low=0, high=16384)
        if self.texture and self.texture < SMALLEST_TEXTURE:
            expected = f"0 or at least {SMALLEST_TEXTURE}"
            raise RangeError(message("SimplifyOptions", "texture", expected, self.texture))
        if self.opacity and not self.texture:
            expected, remedy = "a texture, which holds it", "give texture, such as 256"
            raise RangeError(message("SimplifyOptions", "opacity", expected, "none", remedy))
        require_bounds(self, "silhouette_weight", low=0)
        require_bounds(self, "ssim_weight", low=0, high=1)


@dataclass(frozen=True)
class Likeness:
    """How like the dense mesh another looks, from views that no step has seen.

    Attributes:
        psnr: mean over the views, over white in display values, in dB.
        iou: intersection over union of the silhouettes: sum of the smaller over sum of the larger
            opacity of each pixel, mean over the views.
    """

    psnr: float
    iou: float


@dataclass(frozen=True, eq=False)
class SimplifiedMesh:
    """A simple mesh.

    Attributes:
        surface: the mesh.
        start: the decimation that it started from, with as many triangles.
        before, after: likeness of `start` and of `surface`.
        history: (steps, 3) step, loss, PSNR of the step's view in dB.
        finished: whether all steps were done.
    """

    surface: SurfaceField
    start: SurfaceField
    before: Likeness
    after: Likeness
    history: FloatArray
    finished: bool


@dataclass(frozen=True)
class Progress(descent.Progress):
    """What a progress display gets after a step."""

    psnr: float  # of the step's view, in dB


def simplify(
    dense: SurfaceField,
    options: SimplifyOptions,
    *,
    bar: bool = False,
    should_stop: Callable[[], bool] = lambda: False,
) -> SimplifiedMesh:
    """A mesh of `options.triangles` triangles whose pictures are those of `dense`.

    Args:
        dense: with its colors or texture; `lit` gives a mesh without any those of a shaded one.
        options: number of triangles, views and steps.
        bar: show progress on stderr.
        should_stop: asked before each step.

    Raises:
        DtypeError: other types.
        RangeError: no fewer triangles than `dense` has.
        SceneError: a decimation that is not manifold.
        IoError: the library of `decimate` or `unwrap` is not installed.
        Error: a loss that is not finite.
    """
    require_instance("simplify", "dense", dense, SurfaceField, "MeshSurface.of_mesh makes one")
    require_instance("simplify", "options", options, SimplifyOptions)
    dense = dense.unsmoothed()
    start = decimated(dense, options.triangles, texture=options.texture, opacity=options.opacity)
    job = Simplification(dense, start, options)
    columns = (descent.LOSS_COLUMN, PSNR_COLUMN)
    with progress_bar("simplify", job, columns, shown=bar) as on_step:

        def after_step(now: float) -> None:
            del now
            if on_step:
                step, loss, psnr = job.history[-1]
                on_step(Progress(int(step), job.steps, loss, psnr))

        def result(run: Run) -> SimplifiedMesh:
            cameras = spiral_cameras(dense.box, HELD_OUT, size=options.size, turn=90.0)
            checks = _views(dense, cameras)
            before, after = (likeness(each, checks) for each in (start, job.surface))
            history = np.array(job.history, np.float64).reshape(-1, 3)
            return SimplifiedMesh(job.surface, start, before, after, history, run.finished)

        return descend(job, None, result, after_step=after_step, should_stop=should_stop)


def decimated(
    dense: SurfaceField, triangles: int, *, texture: int = 0, opacity: bool = False
) -> SurfaceField:
    """A decimation by quadric errors that shows what `dense` shows nearby.

    Args:
        dense: the mesh.
        triangles: at most so many.
        texture: texels along an edge of its texture; 0 for colors at its vertices.
        opacity: whether texels have an opacity.

    Raises:
        RangeError, SceneError, IoError: as for `simplify`.
    """
    vertices, faces = decimate(dense.vertices, dense.faces, triangles)
    if texture:
        unwrapped = Unwrapped(*unwrap(vertices, faces, texture))
        texels = raw_texels(
            baked(vertices, unwrapped, texture, dense), START_OPACITY if opacity else None
        )
        return TexturedSurface.of_mesh(vertices, unwrapped, texels, smoothness=0.0)
    nearest = _nearest_vertices(vertices, dense.vertices)
    return MeshSurface.of_mesh(vertices, faces, dense.color_logits()[nearest], smoothness=0.0)


def _nearest_vertices(points: FloatArray, vertices: FloatArray) -> Array:
    """(N,) numbers of the nearest of (V, 3) vertices."""
    rows = [np.square(vertices - point).sum(axis=1).argmin() for point in points]
    return np.array(rows, np.int64)


class Simplification:
    """The descent, as `descend` drives it.

    Attributes:
        surface: the mesh as it is now.
        options: of the descent.
        step_number: how many steps were done.
        history: (step, loss, PSNR of its view in dB) of each.
    """

    def __init__(self, dense: SurfaceField, start: SurfaceField, options: SimplifyOptions) -> None:
        """Draw the references.

        Args:
            dense: what is drawn.
            start: what is changed; its arrays are copied.
            options: of the descent.
        """
        self.surface = copy(start)
        self.surface.params = {name: values.copy() for name, values in start.params.items()}
        self.options = options
        self.step_number = 0
        self.changing = False
        self.history: list[tuple[float, float, float]] = []
        self._views = _views(dense, spiral_cameras(dense.box, options.views, size=options.size))
        self._optimizer = Adam()
        a, b = (start.vertices[start.edges.ends[:, k]] for k in range(2))
        step = TEXTURED_VERTEX_STEP if isinstance(start, TexturedSurface) else VERTEX_STEP
        self._vertex_rate = step * float(np.sqrt(np.square(b - a).sum(axis=1)).mean())

    @property
    def steps(self) -> int:
        """Of the whole descent."""
        return self.options.steps

    def step(self) -> float:
        """One step; returns the loss before it."""
        view = self._draw()
        loss, square, gradients = self._loss_and_gradients(view)
        if not np.isfinite(loss):
            got = f"{loss} before step {self.step_number}"
            raise Error(message("simplify", "loss", "a finite number", got))
        with changing(self):
            self._optimizer.step(self.surface.params, gradients, self._rates())
            self.history.append((self.step_number, loss, decibels(square)))
            self.step_number += 1
        return loss

    def save(self, folder: Path) -> Path:
        """It keeps nothing on disk: a simplification takes a minute.

        Args:
            folder: is not used.
        """
        return folder

    def _draw(self) -> TrainingView:
        turn, index = divmod(self.step_number, len(self._views))
        order = permutation(self.options.seed, len(self._views), step=turn, dimension=8)
        return self._views[int(order[index])]

    def _loss_and_gradients(self, view: TrainingView) -> tuple[float, float, dict[str, Array]]:
        """Loss, mean squared error of the picture, and dL/d params."""
        options = self.options
        behind = display_background(
            Background(None, "random"), seed=options.seed, step=self.step_number
        )
        outputs, context = self.surface.render(
            ImageBatch(view.camera), seed=0, step=0, options=RenderOptions()
        )
        picture = picture_loss(outputs, view, behind, ssim_weight=options.ssim_weight)
        d_outputs, _ = picture_loss_backward(picture)
        assert outputs.opacity is not None
        assert d_outputs.opacity is not None
        gap = outputs.opacity - view.premultiplied[..., 3].reshape(-1)
        weight = options.silhouette_weight
        loss = picture.value + weight * float(np.square(gap).mean(dtype=np.float64))
        d_opacity = d_outputs.opacity + gap * gap.dtype.type(2 * weight / gap.size)
        d_view = Outputs(d_outputs.color, d_opacity)
        gradients: dict[str, Any] = dict(self.surface.render_backward(context, d_view))
        return loss, picture.mean_square, gradients

    def _rates(self) -> dict[str, float]:
        fall = exponential(LAST_RATE, self.options.steps)(self.step_number)
        groups = self.surface.param_groups()
        rates = {name: fall * spec.learning_rate for name, spec in groups.items()}
        return rates | {"differential": fall * self._vertex_rate}


def _views(surface: SurfaceField, cameras: Sequence[Camera]) -> list[TrainingView]:
    """What cameras see of a surface."""
    views = []
    for camera in cameras:
        color, opacity, _ = render_field(surface, camera, 0.0)
        rgba = np.concatenate([color, opacity[..., None]], axis=-1).astype(np.float32)
        views.append(TrainingView(camera, rgba, None))
    return views


def likeness(surface: SurfaceField, views: Sequence[TrainingView]) -> Likeness:
    """How like `views` of a mesh another one looks.

    Args:
        surface: the other one.
        views: pictures of the first.
    """
    errors, shares = [], []
    for view in views:
        truth = view.premultiplied.astype(np.float64)
        color, opacity, _ = render_field(surface, view.camera, 0.0)
        gap = color - truth[..., :3] - (opacity - truth[..., 3])[..., None] * WHITE
        errors.append(decibels(float(np.square(gap).mean(dtype=np.float64))))
        smaller, larger = (f(opacity, truth[..., 3]) for f in (np.minimum, np.maximum))
        shares.append(float(smaller.sum(dtype=np.float64) / larger.sum(dtype=np.float64)))
    return Likeness(float(np.mean(errors)), float(np.mean(shares)))

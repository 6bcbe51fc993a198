"""Renderers as pairs of functions of named arrays, for `photograd.torch` and `photograd.jax`.

A pair has a forward pass, {name: array} -> ({name: array}, context), and a backward pass from the
context and dL/d each output to dL/d each input. Both are NumPy; nothing here knows of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from photograd._checks import require_instance
from photograd.capture.camera import Camera
from photograd.errors import RangeError, ShapeError, message
from photograd.representation import (
    CanvasBatch,
    ImageBatch,
    Outputs,
    RayBatch,
    RenderOptions,
    Representation,
    dense_gradient,
)
from photograd.splats.splatting import Gaussians, SplatOptions, render, render_backward
from photograd.transport.path_options import PathOptions
from photograd.transport.tracer import PathTracer
from photograd.types import Array

Arrays = Mapping[str, Array]
OUTPUTS = ("color", "opacity", "depth")
BATCH_INPUTS = ("origins", "directions", "points", "camera_from_world")
"""Of a batch: what `RenderOptions.camera_adjoint` gives derivatives with respect to."""
SPLATS = ("means", "log_scales", "quats", "opacity_logits", "sh")
SPLAT_INPUTS = (*SPLATS, "background", "camera_from_world")


@dataclass(frozen=True)
class Pair:
    """A renderer that keeps its scene, and takes what varies as arrays.

    Attributes:
        forward: inputs by name -> outputs by name, and what the backward pass needs.
        backward: that, and dL/d each output (None for zero) -> dL/d each input, by name.
        shapes: of the outputs, by name, in order.
    """

    forward: Callable[[Arrays], tuple[dict[str, Array], Any]]
    backward: Callable[[Any, Mapping[str, Array | None]], Arrays]
    shapes: Mapping[str, tuple[int, ...]]


def representation_pair(
    function: str,
    field: Representation,
    names: tuple[str, ...],
    batch: RayBatch | ImageBatch | CanvasBatch,
    *,
    seed: int,
    step: int,
    options: RenderOptions,
) -> Pair:
    """`Representation.render` and `render_backward` as functions of some of their arrays.

    Args:
        function: on whose behalf errors speak.
        field: whose other parameters stay as they are; it is not changed.
        names: of its parameters, and of `BATCH_INPUTS` in the batch.
        batch: what is rendered.
        seed, step, options: of the rendering.

    Raises:
        RangeError: a name of neither.
        DtypeError: no `Representation`.
    """
    require_instance(function, "field", field, Representation)
    movable = [name for name in BATCH_INPUTS if hasattr(batch, name)]
    _require_names(function, names, (*field.params, *movable))
    moved = [name for name in names if name in movable]
    options = replace(options, camera_adjoint=options.camera_adjoint or bool(moved))

    def forward(arrays: Arrays) -> tuple[dict[str, Array], Any]:
        drawn = copy(field)
        drawn.params = {
            name: _like(function, name, arrays[name], array) if name in arrays else array
            for name, array in field.params.items()
        }
        rendered: Any = batch
        if moved:
            rendered = replace(rendered, **{name: np.asarray(arrays[name]) for name in moved})
        outputs, context = drawn.render(rendered, seed=seed, step=step, options=options)
        rows = len(outputs.color)
        none = np.zeros(rows, outputs.color.dtype)
        found = {name: getattr(outputs, name) for name in OUTPUTS}
        filled = {name: none if value is None else value for name, value in found.items()}
        absent = frozenset(name for name, value in found.items() if value is None)
        return filled, (drawn, context, absent, outputs.color)

    def backward(kept: Any, d_outputs: Mapping[str, Array | None]) -> Arrays:
        drawn, context, absent, color = kept
        given: Any = {name: None if name in absent else d_outputs.get(name) for name in OUTPUTS}
        if given["color"] is None:
            given["color"] = np.zeros_like(color)
        found: Any = drawn.render_backward(context, Outputs(**given))
        return {
            name: dense_gradient(found[name], drawn.params[name])
            if name in drawn.params
            else found[name]
            for name in names
        }

    rows = _rows(batch)
    return Pair(forward, backward, {"color": (rows, 3), "opacity": (rows,), "depth": (rows,)})


def splat_pair(
    function: str, names: tuple[str, ...], camera: Camera, options: SplatOptions | None
) -> Pair:
    """`photograd.splats.render` and `render_backward` as functions of named arrays.

    Args:
        function: on whose behalf errors speak.
        names: the five of `Gaussians`, and of "background" and "camera_from_world".
        camera: of the picture.
        options: policies; None for the defaults.

    Raises:
        RangeError: an unknown name, or one of the five missing.
    """
    _require_names(function, names, SPLAT_INPUTS)
    if missing := [name for name in SPLATS if name not in names]:
        raise RangeError(
            message(function, "arrays", f"all of {', '.join(SPLATS)}", f"no {missing[0]}")
        )

    def forward(arrays: Arrays) -> tuple[dict[str, Array], Any]:
        gaussians = Gaussians(**{name: arrays[name] for name in SPLATS})
        pose: ArrayLike | None = arrays.get("camera_from_world")
        behind: ArrayLike = arrays.get("background", np.zeros(3))
        picture, context = render(
            gaussians, camera, background=behind, options=options, camera_from_world=pose
        )
        return dict(vars(picture)), context

    def backward(context: Any, d_outputs: Mapping[str, Array | None]) -> Arrays:
        found = render_backward(context, *(d_outputs.get(name) for name in OUTPUTS))
        rest = {"background": found.background, "camera_from_world": found.camera_from_world}
        every = {**found.gaussians, **rest}
        return {name: every[name] for name in names}

    size = (camera.height, camera.width)
    return Pair(forward, backward, {"color": (*size, 3), "opacity": size, "depth": size})


def tracer_pair(
    function: str,
    tracer: PathTracer,
    names: tuple[str, ...],
    *,
    spp: int,
    seed: int,
    backward_seed: int | None,
    options: PathOptions,
    camera: Camera | None,
) -> Pair:
    """`PathTracer.render` and `render_backward` as functions of some of its params.

    Args:
        function: on whose behalf errors speak.
        tracer: whose params are the given ones during a pass, and its own again afterwards.
        names: of its params.
        spp: samples a pixel, of both passes.
        seed: of the picture.
        backward_seed: of the gradient; None takes that of the picture.
        options, camera: of the path tracer.

    Raises:
        RangeError: a name that it does not have, or whose derivative is incomplete.
        DtypeError: no `PathTracer`.
    """
    require_instance(function, "tracer", tracer, PathTracer)
    _require_names(function, names, tuple(tracer.params))
    for name in names:
        if name in tracer.incomplete:
            expected = f"a derivative that is complete, of {name} it is not"
            raise RangeError(message(function, "params", expected, tracer.incomplete[name]))

    def forward(arrays: Arrays) -> tuple[dict[str, Array], Any]:
        with _params(function, tracer, arrays):
            picture = tracer.render(spp=spp, seed=seed, options=options, camera=camera).mean
        return {"image": picture}, {name: np.array(array) for name, array in arrays.items()}

    def backward(arrays: Any, d_outputs: Mapping[str, Array | None]) -> Arrays:
        d_image = d_outputs["image"]
        if d_image is None:
            return {name: np.zeros_like(array) for name, array in arrays.items()}
        other = seed if backward_seed is None else backward_seed
        with _params(function, tracer, arrays):
            found = tracer.render_backward(
                d_image, spp=spp, seed=other, options=options, camera=camera
            )
            return {name: found[name] for name in names}

    view = tracer.scene.camera if camera is None else camera
    return Pair(forward, backward, {"image": (view.height, view.width, 3)})


@contextmanager
def _params(function: str, tracer: PathTracer, arrays: Arrays) -> Iterator[None]:
    """The tracer with other params for a while."""
    own = tracer.params
    tracer.params = {
        name: _like(function, name, arrays[name], array) if name in arrays else array
        for name, array in own.items()
    }
    try:
        yield
    finally:
        tracer.params = own


def _like(function: str, name: str, array: Array, own: Array) -> Array:
    """The array in the dtype of the scene's own; itself if it is in it."""
    if array.shape != own.shape:
        raise ShapeError(message(function, name, f"shape {own.shape}", array.shape))
    return np.ascontiguousarray(array, own.dtype)


def _rows(batch: RayBatch | ImageBatch | CanvasBatch) -> int:
    if isinstance(batch, ImageBatch):
        return batch.camera.width * batch.camera.height
    return len(batch.points if isinstance(batch, CanvasBatch) else batch.origins)


def _require_names(function: str, names: tuple[str, ...], known: tuple[str, ...]) -> None:
    if not names:
        raise RangeError(message(function, "arrays", "at least one array", "none"))
    for name in names:
        if name not in known:
            expected = f"one of {', '.join(known)}"
            raise RangeError(message(function, "arrays", expected, repr(name)))

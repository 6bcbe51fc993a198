"""Renderers for JAX: functions of arrays with custom_vjp, whose gradients are our adjoints.

    def loss(values):
        rendered = photograd.jax.render(field, {"values": values}, batch)
        return jnp.square(rendered.color - truth).mean()

    gradient = jax.jit(jax.grad(loss))(values)

They run on the host, through `jax.pure_callback`, so that `jit` and `grad` work; `vmap` calls them
one after another. The backward pass renders once more, since nothing can be kept between the two:
the same bits. Arrays on the CPU are handed over without a copy where JAX allows it. Double
precision needs `jax_enable_x64`. JAX is the extra `jax`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from photograd._bridges import Pair, representation_pair, splat_pair, tracer_pair
from photograd._extras import import_extra
from photograd.capture.camera import Camera
from photograd.representation import (
    CanvasBatch,
    ImageBatch,
    RayBatch,
    RenderOptions,
    Representation,
)
from photograd.splats.splatting import SplatOptions
from photograd.transport.path_options import DEFAULTS, PathOptions
from photograd.transport.tracer import PathTracer
from photograd.types import Array

JaxArray: TypeAlias = Any
"""jax.Array; JAX is not needed to read this module."""


class Rendering(NamedTuple):
    """What a renderer returns, as JAX arrays; see `photograd.representation.Outputs`.

    Attributes:
        color: (..., 3), premultiplied.
        opacity: (...); zeros where the representation has none.
        depth: (...), the sum of weight times distance; zeros where there is none.
    """

    color: JaxArray
    opacity: JaxArray
    depth: JaxArray


def render(
    field: Representation,
    arrays: Mapping[str, JaxArray],
    batch: RayBatch | ImageBatch | CanvasBatch,
    *,
    seed: int = 0,
    step: int = 0,
    options: RenderOptions | None = None,
) -> Rendering:
    """A representation, rendered with JAX arrays in place of some of its parameters.

    Args:
        field: any representation; it is not changed, and keeps its other parameters.
        arrays: by the names of `field.params`, and of `batch` as in `photograd.torch.render`.
        batch: what is rendered.
        seed: of random numbers, such as jitter.
        step: of the fit, for other random numbers at each.
        options: policies; None for the defaults, which do not stop early.

    Raises:
        IoError: JAX is not installed.
        RangeError: a name that neither the field nor the batch has.
        ShapeError: an array of another shape.
    """
    pair = representation_pair(
        "photograd.jax.render",
        field,
        tuple(arrays),
        batch,
        seed=seed,
        step=step,
        options=options or RenderOptions(),
    )
    return Rendering(*_run("photograd.jax.render", pair, arrays))


def splat(
    arrays: Mapping[str, JaxArray], camera: Camera, *, options: SplatOptions | None = None
) -> Rendering:
    """A picture of Gaussians: color (H, W, 3), opacity (H, W), depth (H, W).

    Args:
        arrays: the five of `photograd.Gaussians`, all of one dtype, and, if wanted, "background"
            (3,) and "camera_from_world" (3, 4) in place of the camera's pose.
        camera: size, focal lengths and pose.
        options: policies; None for the defaults.

    Raises:
        IoError: JAX is not installed.
        RangeError: an unknown name, or a missing one.
    """
    pair = splat_pair("photograd.jax.splat", tuple(arrays), camera, options)
    return Rendering(*_run("photograd.jax.splat", pair, arrays))


def trace(
    tracer: PathTracer,
    arrays: Mapping[str, JaxArray],
    *,
    spp: int,
    seed: int,
    backward_seed: int | None = None,
    options: PathOptions = DEFAULTS,
    camera: Camera | None = None,
) -> JaxArray:
    """A path traced picture (H, W, 3), linear, as a function of materials, textures and lights.

    Args:
        tracer: of the scene; its own params stay as they are.
        arrays: by the names of `tracer.params`.
        spp: samples a pixel, of the picture and of its gradient.
        seed: of the picture.
        backward_seed: of the gradient, see `photograd.torch.trace`; None takes `seed`.
        options: of the path tracer.
        camera: None takes the scene's.

    Raises:
        IoError: JAX is not installed.
        RangeError: an unknown name, or one whose derivative is incomplete.
    """
    pair = tracer_pair(
        "photograd.jax.trace",
        tracer,
        tuple(arrays),
        spp=spp,
        seed=seed,
        backward_seed=backward_seed,
        options=options,
        camera=camera,
    )
    (image,) = _run("photograd.jax.trace", pair, arrays)
    return image


def apply(
    forward: Callable[..., tuple[Sequence[Array], Any]],
    backward: Callable[..., Sequence[Array]],
    shapes: Sequence[tuple[int, ...]],
    *arrays: JaxArray,
) -> tuple[JaxArray, ...]:
    """Any function with an adjoint, such as `photograd.raster.soft_silhouette`.

    Args:
        forward: (*arrays) -> (outputs, context), NumPy arrays.
        backward: (context, *d_outputs) -> dL/d each array.
        shapes: of the outputs, which JAX has to know beforehand.
        arrays: of one dtype, which the outputs get, too.

    Returns:
        An array for each output.

    Raises:
        IoError: JAX is not installed.
    """
    names = tuple(f"{k}" for k in range(len(arrays)))

    def named_forward(given: Mapping[str, Array]) -> tuple[dict[str, Array], Any]:
        outputs, context = forward(*(given[name] for name in names))
        return {f"{k}": np.asarray(output) for k, output in enumerate(outputs)}, context

    def named_backward(context: Any, d_outputs: Mapping[str, Array | None]) -> Mapping[str, Array]:
        found = backward(context, *(d_outputs[f"{k}"] for k in range(len(shapes))))
        return dict(zip(names, found, strict=True))

    pair = Pair(named_forward, named_backward, {f"{k}": s for k, s in enumerate(shapes)})
    return _run("photograd.jax.apply", pair, dict(zip(names, arrays, strict=True)))


def _run(function: str, pair: Pair, arrays: Mapping[str, JaxArray]) -> tuple[JaxArray, ...]:
    jax = import_extra(function, "jax", "jax")
    names = tuple(arrays)
    given = [jax.numpy.asarray(array) for array in arrays.values()]
    dtype = given[0].dtype
    results = [jax.ShapeDtypeStruct(shape, dtype) for shape in pair.shapes.values()]
    inputs = [jax.ShapeDtypeStruct(array.shape, array.dtype) for array in given]

    def on_host(*values: Any) -> list[Array]:
        outputs, _ = pair.forward(_named(names, values))
        return [np.asarray(outputs[name], dtype) for name in pair.shapes]

    def adjoint_on_host(values: Any, d_outputs: Any) -> list[Array]:
        outputs, context = pair.forward(_named(names, values))
        cotangents = {
            name: np.asarray(d, outputs[name].dtype)
            for name, d in zip(pair.shapes, d_outputs, strict=True)
        }
        found = pair.backward(context, cotangents)
        return [
            np.asarray(found[name], like.dtype) for name, like in zip(names, inputs, strict=True)
        ]

    @jax.custom_vjp  # type: ignore[untyped-decorator]
    def rendered(*values: Any) -> Any:
        return tuple(jax.pure_callback(on_host, results, *values, vmap_method="sequential"))

    def forward(*values: Any) -> Any:
        return rendered(*values), values

    def backward(values: Any, d_outputs: Any) -> Any:
        found = jax.pure_callback(
            adjoint_on_host, inputs, values, d_outputs, vmap_method="sequential"
        )
        return tuple(found)

    rendered.defvjp(forward, backward)
    found: tuple[JaxArray, ...] = rendered(*given)
    return found


def _named(names: tuple[str, ...], values: Sequence[Any]) -> dict[str, Array]:
    return {name: np.asarray(value) for name, value in zip(names, values, strict=True)}

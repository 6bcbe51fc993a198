"""Renderers for PyTorch: functions of tensors, whose gradients are this project's adjoints.

    rendered = photograd.torch.render(field, {"values": values}, batch)
    loss = (rendered.color - truth).square().mean()
    loss.backward()  # values.grad, or what lies behind values

Tensors on the CPU are handed over without a copy, and their dtype is kept; those of other devices
are copied there and back. Second derivatives are not to be had. PyTorch is the extra `torch`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from photograd._bridges import Pair, representation_pair, splat_pair, tracer_pair
from photograd._extras import import_extra
from photograd.capture.camera import Camera
from photograd.errors import RangeError, message
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

Tensor: TypeAlias = Any
"""torch.Tensor; PyTorch is not needed to read this module."""


class Rendering(NamedTuple):
    """What a renderer returns, as tensors; see `photograd.representation.Outputs`.

    Attributes:
        color: (..., 3), premultiplied.
        opacity: (...); zeros where the representation has none.
        depth: (...), the sum of weight times distance; zeros where there is none.
    """

    color: Tensor
    opacity: Tensor
    depth: Tensor


def render(
    field: Representation,
    arrays: Mapping[str, Tensor],
    batch: RayBatch | ImageBatch | CanvasBatch,
    *,
    seed: int = 0,
    step: int = 0,
    options: RenderOptions | None = None,
) -> Rendering:
    """A representation, rendered with tensors in place of some of its parameters.

    Args:
        field: any representation; it is not changed, and keeps its other parameters.
        arrays: by the names of `field.params`; and of `batch`, for derivatives with respect to
            where rays, points or the camera are: "origins" and "directions", "points",
            "camera_from_world". Shapes are those of the arrays they stand for.
        batch: what is rendered.
        seed: of random numbers, such as jitter.
        step: of the fit, for other random numbers at each.
        options: policies; None for the defaults, which do not stop early.

    Raises:
        IoError: PyTorch is not installed.
        RangeError: a name that neither the field nor the batch has.
        ShapeError: a tensor of another shape.
    """
    pair = representation_pair(
        "photograd.torch.render",
        field,
        tuple(arrays),
        batch,
        seed=seed,
        step=step,
        options=options or RenderOptions(),
    )
    return Rendering(*_run("photograd.torch.render", pair, arrays))


def splat(
    arrays: Mapping[str, Tensor], camera: Camera, *, options: SplatOptions | None = None
) -> Rendering:
    """A picture of Gaussians: color (H, W, 3), opacity (H, W), depth (H, W).

    Args:
        arrays: the five of `photograd.Gaussians`, all of one dtype, and, if wanted, "background"
            (3,) and "camera_from_world" (3, 4) in place of the camera's pose.
        camera: size, focal lengths and pose.
        options: policies; None for the defaults.

    Raises:
        IoError: PyTorch is not installed.
        RangeError: an unknown name, or a missing one.
        DtypeError, ShapeError: as `Gaussians` does.
    """
    pair = splat_pair("photograd.torch.splat", tuple(arrays), camera, options)
    return Rendering(*_run("photograd.torch.splat", pair, arrays))


def trace(
    tracer: PathTracer,
    arrays: Mapping[str, Tensor],
    *,
    spp: int,
    seed: int,
    backward_seed: int | None = None,
    options: PathOptions = DEFAULTS,
    camera: Camera | None = None,
) -> Tensor:
    """A path traced picture (H, W, 3), linear, as a function of materials, textures and lights.

    Args:
        tracer: of the scene; its own params stay as they are.
        arrays: by the names of `tracer.params`.
        spp: samples a pixel, of the picture and of its gradient.
        seed: of the picture.
        backward_seed: of the gradient. None takes `seed`: the derivative of that very picture. The
            gradient of a loss that is not linear in the picture is unbiased with another seed only.
        options: of the path tracer.
        camera: None takes the scene's.

    Raises:
        IoError: PyTorch is not installed.
        RangeError: an unknown name, or one whose derivative is incomplete.
        ShapeError: a tensor of another shape.
    """
    pair = tracer_pair(
        "photograd.torch.trace",
        tracer,
        tuple(arrays),
        spp=spp,
        seed=seed,
        backward_seed=backward_seed,
        options=options,
        camera=camera,
    )
    (image,) = _run("photograd.torch.trace", pair, arrays)
    return image


def apply(
    forward: Callable[..., tuple[Sequence[Array], Any]],
    backward: Callable[..., Sequence[Array | None]],
    *tensors: Tensor,
) -> tuple[Tensor, ...]:
    """Any function with an adjoint, such as `photograd.raster.soft_silhouette`.

    Args:
        forward: (*arrays) -> (outputs, context), NumPy arrays.
        backward: (context, *d_outputs) -> dL/d each array, or None for one that has none. None
            among `d_outputs` is zero.
        tensors: of which the arrays share the memory, on the CPU.

    Raises:
        IoError: PyTorch is not installed.

    Returns:
        A tensor for each output.
    """
    names = tuple(f"{k}" for k in range(len(tensors)))

    def named_forward(arrays: Mapping[str, Array]) -> tuple[dict[str, Array], Any]:
        outputs, context = forward(*(arrays[name] for name in names))
        found = {f"{k}": np.asarray(output) for k, output in enumerate(outputs)}
        return found, (context, len(found))

    def named_backward(kept: Any, d_outputs: Mapping[str, Array | None]) -> Mapping[str, Array]:
        context, count = kept
        found = backward(context, *(d_outputs[f"{k}"] for k in range(count)))
        return {name: d for name, d in zip(names, found, strict=True) if d is not None}

    pair = Pair(named_forward, named_backward, {})
    return _run("photograd.torch.apply", pair, dict(zip(names, tensors, strict=True)))


def _run(function: str, pair: Pair, arrays: Mapping[str, Tensor]) -> tuple[Tensor, ...]:
    torch = import_extra(function, "torch", "torch")
    for name, tensor in arrays.items():
        if not isinstance(tensor, torch.Tensor) or not tensor.is_floating_point():
            got = getattr(tensor, "dtype", type(tensor).__name__)
            raise RangeError(message(function, name, "a tensor of floating-point numbers", got))
    found: tuple[Tensor, ...] = _function().apply(pair, tuple(arrays), *arrays.values())
    return found


@cache
def _function() -> Any:
    """The autograd function through which all of them go."""
    torch = import_extra("photograd.torch", "torch", "torch")

    class Rendered(torch.autograd.Function):  # type: ignore[misc, name-defined]
        """Forward and backward pass of a `Pair`."""

        @staticmethod
        def forward(ctx: Any, pair: Pair, names: tuple[str, ...], *tensors: Tensor) -> Any:
            given = [tensor.detach().cpu().numpy() for tensor in tensors]
            outputs, context = pair.forward(dict(zip(names, given, strict=True)))
            # Saved so that a tensor that changes in place before the backward pass is an error.
            ctx.save_for_backward(*tensors)
            ctx.set_materialize_grads(False)
            ctx.pair, ctx.names, ctx.context, ctx.outputs = pair, names, context, list(outputs)
            ctx.dtypes = [array.dtype for array in outputs.values()]
            like = tensors[0]
            return tuple(
                torch.from_numpy(np.ascontiguousarray(array)).to(like.device, like.dtype)
                for array in outputs.values()
            )

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, *d_outputs: Tensor | None) -> Any:
            tensors = ctx.saved_tensors
            if all(d is None for d in d_outputs):
                return (None, None, *(None for _ in tensors))
            given = {
                name: None if d is None else d.detach().cpu().numpy().astype(dtype, copy=False)
                for name, d, dtype in zip(ctx.outputs, d_outputs, ctx.dtypes, strict=True)
            }
            found = ctx.pair.backward(ctx.context, given)
            gradients = []
            for name, tensor in zip(ctx.names, tensors, strict=True):
                d = found.get(name)
                gradients.append(
                    None
                    if d is None
                    else torch.from_numpy(np.ascontiguousarray(d)).to(tensor.device, tensor.dtype)
                )
            return (None, None, *gradients)

    return Rendered

"""Gaussians with codes, blended like colors and decoded once a pixel [Hedman2021].

Each Gaussian has a color c and a code f, both non-negative as the rasterizer's colors are:
max(0, 1/2 + Y_0 x). The rasterizer blends them in triples, in the same order and with the same
weights w_i; a small network adds what depends on the view, once a pixel:

    A = sum_i w_i,   C = sum_i w_i c_i,   F = sum_i w_i f_i / A
    color = C + A network(F, Y(d))                         d: away from the camera

Colors are display values, as those of other Gaussians. At the start the network's last layer is
zero, so that a picture is that of the colors alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import matmul

from photograd import sh
from photograd._checks import require_bounds
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.errors import RangeError, message
from photograd.fields.decoded_march import DIRECTION_DEGREE, harmonics, harmonics_backward
from photograd.network import Perceptron
from photograd.representation import ImageBatch, Outputs, RenderOptions
from photograd.splats.splatting import (
    Gaussians,
    SplatContext,
    SplatOptions,
    render,
    render_backward,
)
from photograd.types import Array

LEAST_OPACITY = 1e-6
"""Added to what the codes of a pixel are divided by."""
GEOMETRY = ("means", "log_scales", "quats", "opacity_logits")


@dataclass(frozen=True)
class CodedSplatsPolicy(SplatOptions):
    """How splats are drawn, and how large codes and decoder are.

    Attributes:
        features: numbers of a code, a multiple of 3: each three are one more blend.
        width, depth: of the decoder's hidden layers, and how many.
        hidden: activation of these.
    """

    features: int = 3
    width: int = 32
    depth: int = 2
    hidden: Literal["relu", "softplus"] = "relu"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "features", low=3, high=48)
        require_bounds(self, "width", low=1, high=256)
        require_bounds(self, "depth", low=1, high=8)
        if self.features % 3:
            expected = "a multiple of 3"
            raise RangeError(message("CodedSplatsPolicy", "features", expected, self.features))

    def of_splats(self) -> SplatOptions:
        """How splats are drawn, alone."""
        return SplatOptions(
            **{part.name: getattr(self, part.name) for part in fields(SplatOptions)}
        )

    def decoder(self) -> Perceptron:
        """The network: codes and harmonics to what is added to the color."""
        inputs = self.features + sh.count(DIRECTION_DEGREE)
        return Perceptron(inputs, [self.width] * self.depth + [3], hidden=self.hidden)


@dataclass(frozen=True, eq=False)
class CodedSplatsContext:
    """What the backward pass needs: the blends, and what the decoder took and gave where."""

    blends: list[SplatContext]
    covered: NDArray[np.int64]  # (Q,) pixels that a splat reaches
    inputs: Array  # (Q, F + K)
    added: Array  # (Q, 3)
    decoder: Array
    policy: CodedSplatsPolicy
    local: Array  # (P, 3) directions in the camera's frame
    camera_from_world: Array
    camera_adjoint: bool


def geometry(params: Mapping[str, Array]) -> dict[str, Array]:
    """The groups that say where Gaussians are and how opaque.

    Args:
        params: of `GaussianCodes`.
    """
    return {name: params[name] for name in GEOMETRY}


def triples(params: Mapping[str, Array]) -> list[Array]:
    """Colors and codes as harmonics (N, 1, 3) of the blends.

    Args:
        params: of `GaussianCodes`.
    """
    codes = params["codes"]
    found = [params["colors"], *np.split(codes, codes.shape[1] // 3, axis=1)]
    return [np.ascontiguousarray(triple)[:, None] for triple in found]


def render_codes(
    params: dict[str, Array], policy: CodedSplatsPolicy, batch: ImageBatch, options: RenderOptions
) -> tuple[Outputs, CodedSplatsContext]:
    """Color (P, 3), opacity (P,) and depth (P,) of all pixels, row by row.

    Args:
        params: of `GaussianCodes`.
        policy: how splats are drawn, and sizes.
        batch: the camera.
        options: of this rendering.
    """
    kind = params["means"].dtype
    drawn_with = replace(policy.of_splats(), stop=options.stop)
    camera, pose = batch.camera, batch.camera_from_world
    blends = [
        render(
            Gaussians(**geometry(params), sh=triple),
            camera,
            options=drawn_with,
            camera_from_world=pose,
        )[1]
        for triple in triples(params)
    ]
    pictures = [blend.picture for blend in blends]
    color, opacity = pictures[0].color.reshape(-1, 3).copy(), pictures[0].opacity.ravel()
    covered = np.flatnonzero(opacity)
    sums = np.concatenate([picture.color.reshape(-1, 3) for picture in pictures[1:]], axis=1)
    view = blends[0].camera_from_world
    local = _local_directions(camera).astype(kind)
    directions = matmul(local[covered], view[:, :3])
    mean = sums[covered] / _share(opacity[covered])
    inputs = np.concatenate([mean, harmonics(directions)], axis=1)
    added = policy.decoder().forward(params["decoder"], inputs)
    color[covered] += opacity[covered, None] * added
    context = CodedSplatsContext(
        blends,
        covered,
        inputs,
        added,
        params["decoder"],
        policy,
        local,
        view,
        options.camera_adjoint,
    )
    outputs = Outputs(color, opacity, pictures[0].depth.ravel())
    return outputs.checked("GaussianCodes.render", batch), context


def render_codes_backward(context: CodedSplatsContext, d_outputs: Outputs) -> dict[str, Array]:
    """dL/d params, and "camera_from_world" (3, 4) if the options asked.

    Args:
        context: of `render_codes`.
        d_outputs: of the shapes of the outputs.
    """
    c, policy, picture = context, context.policy, context.blends[0].picture
    kind, pixels = c.inputs.dtype, picture.opacity.size
    d_color, d_opacity, d_depth = (
        np.zeros((pixels, *like.shape[2:]), kind)
        if d is None
        else np.ascontiguousarray(d, kind).reshape(pixels, *like.shape[2:])
        for d, like in (
            (d_outputs.color, picture.color),
            (d_outputs.opacity, picture.opacity),
            (d_outputs.depth, picture.depth),
        )
    )
    opacity, here = picture.opacity.ravel()[c.covered], d_color[c.covered]
    d_added = np.ascontiguousarray(opacity[:, None] * here)
    d_decoder, d_inputs = policy.decoder().backward(c.decoder, c.inputs, d_added)
    assert d_inputs is not None
    numbers = policy.features
    d_sums = np.zeros((pixels, numbers), kind)
    d_sums[c.covered] = d_inputs[:, :numbers] / _share(opacity)
    d_opacity = d_opacity.copy()
    d_opacity[c.covered] += (here * c.added).sum(axis=1)
    d_opacity[c.covered] -= (d_sums[c.covered] * c.inputs[:, :numbers]).sum(axis=1)
    size = picture.opacity.shape
    found = [
        render_backward(
            c.blends[0], d_color.reshape(*size, 3), d_opacity.reshape(size), d_depth.reshape(size)
        )
    ]
    for blend, d in zip(c.blends[1:], np.split(d_sums, numbers // 3, axis=1), strict=True):
        found.append(render_backward(blend, np.ascontiguousarray(d).reshape(*size, 3)))
    of_splats = [each.gaussians for each in found]
    gradients = {name: _sum([each[name] for each in of_splats]) for name in GEOMETRY}
    gradients["colors"] = of_splats[0]["sh"][:, 0]
    gradients["codes"] = np.concatenate([each["sh"][:, 0] for each in of_splats[1:]], axis=1)
    gradients["decoder"] = d_decoder
    if c.camera_adjoint:
        view = _sum([each.camera_from_world for each in found])
        local = c.local[c.covered]
        directions = matmul(local, c.camera_from_world[:, :3])
        d_directions = harmonics_backward(directions, d_inputs[:, numbers:])
        view[:, :3] += matmul(local.T, d_directions).astype(kind)
        gradients["camera_from_world"] = view
    return gradients


def _sum(arrays: list[Array]) -> Array:
    total = arrays[0].copy()
    for array in arrays[1:]:
        total += array
    return total


def _share(opacity: Array) -> Array:
    share: Array = (opacity + opacity.dtype.type(LEAST_OPACITY))[:, None]
    return share


def _local_directions(camera: Camera) -> Array:
    """(P, 3) unit directions through the pixels in the camera's frame."""
    _, directions = camera.rays()
    return matmul(directions, invert_rigid(camera.world_from_camera)[:3, :3].T)

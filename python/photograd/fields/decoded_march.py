"""Marching through codes that a small network decodes, per sample or per ray.

Density is a number at each active voxel, as in `SparseSh`; color is what the network makes of a
code, which is interpolated like a color would be, and of the direction [Liu2020]:

    per sample    rgb_k = sigmoid(network(f_k, Y(d))),   color = sum_k w_k rgb_k
    per ray       f = sum_k w_k f_k / A, A = sum_k w_k,  color = A sigmoid(network(f, Y(d)))

The second is deferred decoding [Hedman2021]: the network is evaluated once a pixel, whatever the
number of samples. It blends codes instead of colors, which the codes have to be trained for.

The stages of a march, and their adjoints, are in cpp/photograd/render/march/sample_rows.h.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from photograd_course.portable_math import sigmoid

from photograd import sh
from photograd._checks import require_bounds
from photograd._compiled import _core
from photograd._fit_options import Decode
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import (
    MarchPolicy,
    check_camera_adjoint,
    checked_rays,
    checked_values,
    cotangent_arrays,
    require_finite_image,
)
from photograd.fields.weighted_samples import WeightedSamples
from photograd.network import Perceptron
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd.types import Array

DIRECTION_DEGREE = 2
LEAST_OPACITY = 1e-6
"""Added to what the codes of a ray are divided by."""


@dataclass(frozen=True)
class CodesPolicy(MarchPolicy):
    """How a field of codes is marched through, and how large it is.

    Attributes:
        features: numbers of a code.
        width, depth: of the decoder's hidden layers, and how many.
        hidden: activation of these.
        decode: where the network is evaluated: at each sample, or once a ray.
    """

    border: Literal["clamp", "zero"] = "zero"
    features: int = 12
    width: int = 32
    depth: int = 2
    hidden: Literal["relu", "softplus"] = "relu"
    decode: Decode = "sample"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "features", "width", low=1, high=256)
        require_bounds(self, "depth", low=1, high=8)


@dataclass(frozen=True)
class CodeGrid:
    """What is marched through: parameters, decoder, policy and voxels."""

    params: dict[str, Array]  # "density" (N,), "codes" (N, F), "decoder" (P,)
    decoder: Perceptron
    policy: CodesPolicy
    active: ActiveVoxels
    background_density: float

    def at(self, points: Array, group: str) -> Array:
        """(M, C) values of a group.

        Args:
            points: (M, 3) in voxels.
            group: "density" or "codes".
        """
        values, empty = self._rows(group)
        found = np.empty((len(points), values.shape[1]), values.dtype)
        _core.sample_bricks(self.active.topology, values, empty, points, found)
        return found

    def at_backward(self, points: Array, group: str, d: Array, d_points: Array) -> Array:
        """The gradient of a group, in its shape.

        Args:
            points: (M, 3) in voxels.
            group: "density" or "codes".
            d: (M, C) for the values there.
            d_points: (M, 3), is added to.
        """
        values, empty = self._rows(group)
        d_values, unused = np.zeros_like(values), np.zeros_like(empty)
        arrays = values, empty, points, _whole(d), d_values, unused, d_points
        _core.sample_bricks_backward(self.active.topology, *arrays)
        return d_values.reshape(self.params[group].shape)

    def densities(self, points: Array) -> Array:
        """(M,) raw density.

        Args:
            points: (M, 3) in voxels.
        """
        return self.at(points, "density")[:, 0]

    def _rows(self, group: str) -> tuple[Array, Array]:
        values = np.ascontiguousarray(self.params[group]).reshape(len(self.active), -1)
        outside = self.background_density if group == "density" else 0.0
        return values, np.full(values.shape[1], outside, values.dtype)

    def decode(self, inputs: Array) -> Array:
        """Colors (M, 3) of codes.

        Args:
            inputs: (M, F + K), codes and harmonics.
        """
        raw = self.decoder.forward(self.params["decoder"], _whole(inputs))
        rgb: Array = sigmoid(raw).astype(raw.dtype)
        return rgb


@dataclass(frozen=True)
class CodesContext:
    """What the backward pass needs: the samples that were decoded, and of what."""

    grid: CodeGrid
    directions: Array
    samples: WeightedSamples
    features: Array  # (M, F)
    inputs: Array  # of the network: (M, F + K), or (R, F + K)
    rgb: Array  # (M, 3), or (R, 3)
    camera_adjoint: bool

    @property
    def sample_count(self) -> int:
        """Number of samples on all rays in cells with an active voxel."""
        return len(self.samples.t)


def march_codes(
    grid: CodeGrid, batch: RayBatch, options: RenderOptions, *, seed: int, step: int
) -> tuple[Outputs, CodesContext]:
    """Render rays. Shapes as in `RayBatch` and `Outputs`; raises as `photograd.fields.march.march`.

    Args:
        grid: what is marched through.
        batch: the rays.
        options: of this rendering.
        seed: of the jitter.
        step: of the fit, for other jitter at each.
    """
    check_camera_adjoint("LeafCodes.render", grid.policy, options)
    for name, values in grid.params.items():
        checked_values("LeafCodes.render", name, values)
    settings, kind = grid.policy.settings(options.stop), grid.params["density"].dtype
    rays = checked_rays(batch, settings, options, kind, seed=seed, step=step)
    found = WeightedSamples.of_rays(grid.policy, grid.active, rays, options.stop, grid.densities)
    features = grid.at(found.points, "codes")
    offset, directions, (weight, _, left) = found.offset, rays[1], found.weights
    basis = harmonics(directions)
    if grid.policy.decode == "sample":
        inputs = np.concatenate([features, basis[found.ray]], axis=1)
        rgb = grid.decode(inputs)
        color = _core.blend_samples(offset, weight, rgb)
    else:
        mean = _core.blend_samples(offset, weight, features) / _share(left)
        inputs = np.concatenate([mean, basis], axis=1)
        rgb = grid.decode(inputs)
        color = (1 - left)[:, None] * rgb
    depth = _core.blend_samples(offset, weight, found.t[:, None])[:, 0]
    require_finite_image(color, left, batch)
    context = CodesContext(grid, directions, found, features, inputs, rgb, options.camera_adjoint)
    return Outputs(color, 1 - left, depth), context


def march_codes_backward(context: CodesContext, d_outputs: Outputs) -> dict[str, Array]:
    """Of each group, and "origins", "directions" (R, 3) if the options asked.

    Args:
        context: of `march_codes`.
        d_outputs: of the shapes of the outputs.
    """
    c, grid, samples, ray = context, context.grid, context.samples, context.samples.ray
    weight, _, left = samples.weights
    function = "LeafCodes.render_backward"
    d_color, d_left, d_depth = cotangent_arrays(function, d_outputs, len(left), left.dtype)
    d_weight = d_depth[ray] * samples.t
    per_sample = grid.policy.decode == "sample"
    if per_sample:
        d_rgb = weight[:, None] * d_color[ray]
        d_weight += (d_color[ray] * c.rgb).sum(axis=1)
    else:
        d_rgb = (1 - left)[:, None] * d_color
        d_left = d_left - (d_color * c.rgb).sum(axis=1)
    d_raw = _whole(d_rgb * c.rgb * (1 - c.rgb))
    d_decoder, d_inputs = grid.decoder.backward(grid.params["decoder"], c.inputs, d_raw)
    assert d_inputs is not None
    numbers = c.features.shape[1]
    d_features, d_basis = d_inputs[:, :numbers], d_inputs[:, numbers:]
    if not per_sample:
        d_sum = d_features / _share(left)
        d_features = weight[:, None] * d_sum[ray]
        d_weight += (d_sum[ray] * c.features).sum(axis=1)
        d_left = d_left + (d_sum * c.inputs[:, :numbers]).sum(axis=1)  # the share is 1 - left
    d_density = samples.d_density(grid.policy, d_weight, d_left)
    points, d_points = samples.points, np.zeros_like(samples.points)
    gradients = {
        "density": grid.at_backward(points, "density", d_density[:, None], d_points),
        "codes": grid.at_backward(points, "codes", d_features, d_points),
        "decoder": d_decoder,
    }
    if c.camera_adjoint:
        if per_sample:
            ones = np.ones_like(weight)
            d_basis = _core.blend_samples(samples.offset, ones, _whole(d_basis))
        origins, directions = samples.d_rays(grid.policy.box, grid.active.shape, d_points)
        gradients["origins"] = origins
        gradients["directions"] = directions + harmonics_backward(c.directions, d_basis)
    return gradients


def _share(left: Array) -> Array:
    share: Array = (1 - left + left.dtype.type(LEAST_OPACITY))[:, None]
    return share


def harmonics(directions: Array) -> Array:
    """Y (R, K) of `DIRECTION_DEGREE`, of the dtype of the directions.

    Args:
        directions: (R, 3) of unit length.
    """
    count = sh.count(DIRECTION_DEGREE)
    none = np.zeros((len(directions), count, 1), directions.dtype)
    one = np.ones((len(directions), 1), directions.dtype)
    return sh.evaluate_backward(none, _whole(directions), one)[0][..., 0]


def harmonics_backward(directions: Array, d_basis: Array) -> Array:
    """dL/d directions (R, 3).

    Args:
        directions: (R, 3) of unit length.
        d_basis: (R, K), dL/dY.
    """
    one = np.ones((len(directions), 1), directions.dtype)
    return sh.evaluate_backward(_whole(d_basis)[..., None], _whole(directions), one)[1]


def _whole(values: Array) -> Array:
    return np.ascontiguousarray(values)

"""One small network for each brick of voxels, blended where the bricks' cells overlap [Reiser2021].

    (s, g) = density network(e(x)),  c = color network(g, Y(d))       x: position in the cell
    raw    = sum_n v_n(x) raw_n / sum_n v_n(x)                        of s and of c

A cell is a brick of 8^3 voxels, and reaches one voxel into its neighbors. There the windows v_n
fade, so that no seam shows between two networks; elsewhere a sample has one network. Networks of
bricks that do not exist are left out of both sums. Samples are sorted by network, so that each
network runs over a block of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import sigmoid

from photograd import sh
from photograd._checks import require_bounds
from photograd._compiled import _core
from photograd.fields.active_voxels import SIDE, ActiveVoxels
from photograd.fields.decoded_march import DIRECTION_DEGREE, harmonics, harmonics_backward
from photograd.fields.march import (
    MarchPolicy,
    check_camera_adjoint,
    checked_rays,
    checked_values,
    cotangent_arrays,
    require_finite_image,
)
from photograd.fields.weighted_samples import WeightedSamples
from photograd.network import FrequencyEncoding, Perceptron, Perceptrons
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd.types import Array

MARGIN = 1 / SIDE
"""How far a cell reaches into its neighbors, in cells: one voxel. Every sample in a voxel's
interpolation cell, at most half a voxel outside of its brick, has a network."""


@dataclass(frozen=True)
class CellsPolicy(MarchPolicy):
    """How a field of small networks is marched through, and how large they are.

    Attributes:
        octaves: of the frequency encoding of positions in a cell, which run from -1 to 1.
        width: of the hidden layers.
        depth: hidden layers of the density networks; color networks have one.
        features: numbers that a color network takes from the density network.
        hidden: activation of the hidden layers.
    """

    border: Literal["clamp", "zero"] = "zero"
    octaves: int = 4
    width: int = 16
    depth: int = 1
    features: int = 8
    hidden: Literal["relu", "softplus"] = "relu"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "octaves", low=0, high=24)
        require_bounds(self, "width", "features", low=1, high=256)
        require_bounds(self, "depth", low=1, high=8)

    def networks(self) -> tuple[Perceptrons, Perceptrons]:
        """The density networks and the color networks."""
        inputs = FrequencyEncoding(self.octaves).outputs
        widths = [self.width] * self.depth
        density = Perceptron(inputs, [*widths, 1 + self.features], hidden=self.hidden)
        inputs = self.features + sh.count(DIRECTION_DEGREE)
        color = Perceptron(inputs, [self.width, 3], hidden=self.hidden)
        return Perceptrons(density), Perceptrons(color)


@dataclass(frozen=True)
class Overlaps:
    """Which samples lie in which cells: E pairs, sorted by cell.

    Attributes:
        sample: (E,) the row of the sample.
        offset: (N + 1,) where the pairs of each cell begin.
        local: (E, 3) position in the cell, from -1 to 1 between its faces.
        share: (E,) the window of the pair, divided by the sum over the sample's pairs.
        total: (M,) that sum.
    """

    sample: NDArray[np.int64]
    offset: NDArray[np.int64]
    local: Array
    share: Array
    total: Array

    @classmethod
    def of_points(cls, points: Array, active: ActiveVoxels) -> Overlaps:
        """Find the cells of points.

        Args:
            points: (M, 3) in voxels: voxel i has its center at i.
            active: whose bricks are the cells.
        """
        table = _cell_table(active)
        u = (points + points.dtype.type(0.5)) / SIDE
        low, high = (np.floor(u + s * MARGIN).astype(np.int64) for s in (-1, 1))
        samples, cells, locals_ = [], [], []
        for corner in product((False, True), repeat=3):
            there = np.where(corner, high, low)
            index = np.clip(there + 1, 0, np.array(table.shape) - 1)
            cell = table[tuple(index.T)]
            fresh = (~np.array(corner) | (high > low)).all(axis=1) & (cell >= 0)
            samples.append(np.flatnonzero(fresh))
            cells.append(cell[fresh])
            locals_.append(2 * (u - there)[fresh] - 1)
        cell = np.concatenate(cells)
        order = np.argsort(cell, kind="stable")
        sample, local = np.concatenate(samples)[order], np.concatenate(locals_)[order]
        local = np.ascontiguousarray(local, points.dtype)
        window = _windows(local).prod(axis=1)
        total = _sums(sample, window[:, None], len(points))[:, 0]
        offset = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=len(active.origins)))])
        return cls(sample, offset, local, window / total[sample], total)

    def kept(self, those: NDArray[np.bool_]) -> tuple[Overlaps, NDArray[np.bool_]]:
        """The pairs of some of the samples, and which pairs (E,) these are.

        Args:
            those: (M,) samples that stay.
        """
        pairs = those[self.sample]
        number = np.cumsum(those) - 1
        offset = np.concatenate([[0], np.cumsum(pairs)])[self.offset]
        found = number[self.sample[pairs]], offset, self.local[pairs], self.share[pairs]
        return Overlaps(*found, self.total[those]), pairs

    def blended(self, values: Array) -> Array:
        """(M, C) of values of pairs (E, C)."""
        return _sums(self.sample, self.share[:, None] * values, len(self.total))

    def d_local(self, values: Array, d_blended: Array) -> Array:
        """Derivatives of a loss with respect to `local` (E, 3), through the windows alone.

        Args:
            values: (E, C) that were blended.
            d_blended: (M, C), derivatives with respect to what came of it.
        """
        d_share = (values * d_blended[self.sample]).sum(axis=1)
        mean = _sums(self.sample, (self.share * d_share)[:, None], len(self.total))[:, 0]
        d_window = (d_share - mean[self.sample]) / self.total[self.sample]
        windows, slopes = _windows(self.local), _window_slopes(self.local)
        others = [windows[:, (a + 1) % 3] * windows[:, (a + 2) % 3] for a in range(3)]
        d_local: Array = d_window[:, None] * slopes * np.stack(others, axis=1)
        return d_local


def _cell_table(active: ActiveVoxels) -> NDArray[np.int64]:
    """The number of each brick, -1 where there is none, with an empty rim."""
    shape = [-(-n // SIDE) + 2 for n in active.shape]
    table = np.full(shape, -1, np.int64)
    table[tuple((active.origins // SIDE + 1).T)] = np.arange(len(active.origins))
    return table


def _windows(local: Array) -> Array:
    """(E, 3) 1 inside of a cell, 0 where its margin ends, 1/2 on its face, smooth between."""
    t = _across(local)
    windows: Array = t * t * (3 - 2 * t)
    return windows


def _window_slopes(local: Array) -> Array:
    t = _across(local)
    slope: Array = -np.sign(local) * (6 * t * (1 - t) / (4 * MARGIN)).astype(local.dtype)
    return slope


def _across(local: Array) -> Array:
    return np.clip((1 + 2 * MARGIN - np.abs(local)) / (4 * MARGIN), 0, 1).astype(local.dtype)


def _sums(sample: NDArray[np.int64], values: Array, count: int) -> Array:
    """(M, C) sums of values (E, C) over the pairs of each sample, in order, in float64."""
    columns = [np.bincount(sample, column, minlength=count) for column in values.T]
    return np.stack(columns, axis=1).astype(values.dtype)


@dataclass(frozen=True)
class CellGrid:
    """What is marched through: parameters "density" (N, P) and "color" (N, Q), policy, bricks."""

    params: dict[str, Array]
    policy: CellsPolicy
    active: ActiveVoxels

    def densities(self, where: Overlaps) -> tuple[Array, Array]:
        """What the density networks take (E, I), and what they give (E, 1 + F).

        Args:
            where: the pairs of samples and cells.
        """
        encoded = FrequencyEncoding(self.policy.octaves).encode(where.local)
        density, _ = self.policy.networks()
        return encoded, density.forward(self.params["density"], where.offset, encoded)

    def colors(self, where: Overlaps, features: Array, basis: Array) -> tuple[Array, Array]:
        """What the color networks take (E, F + K), and what they give (E, 3).

        Args:
            where: the pairs of samples and cells.
            features: (E, F) of the density networks.
            basis: (M, K) harmonics of the direction of each sample.
        """
        _, color = self.policy.networks()
        taken = np.concatenate([features, basis[where.sample]], axis=1)
        return taken, color.forward(self.params["color"], where.offset, taken)


@dataclass(frozen=True)
class CellsContext:
    """What the backward pass needs: the samples, their cells, and what the networks took, gave."""

    grid: CellGrid
    directions: Array
    samples: WeightedSamples
    where: Overlaps
    encoded: Array  # (E, I)
    taken: Array  # (E, F + K)
    raw: Array  # (E, 4) density and color
    rgb: Array  # (M, 3)
    camera_adjoint: bool

    @property
    def sample_count(self) -> int:
        """Number of samples on all rays in cells with an active voxel."""
        return len(self.samples.t)


def march_cells(
    grid: CellGrid, batch: RayBatch, options: RenderOptions, *, seed: int, step: int
) -> tuple[Outputs, CellsContext]:
    """Render rays. Shapes as in `RayBatch` and `Outputs`; raises as `photograd.fields.march.march`.

    Args:
        grid: what is marched through.
        batch: the rays.
        options: of this rendering.
        seed: of the jitter.
        step: of the fit, for other jitter at each.
    """
    check_camera_adjoint("LeafMlps.render", grid.policy, options)
    for name, values in grid.params.items():
        checked_values("LeafMlps.render", name, values)
    settings, kind = grid.policy.settings(options.stop), grid.params["density"].dtype
    rays = checked_rays(batch, settings, options, kind, seed=seed, step=step)
    found: list[tuple[Overlaps, Array, Array]] = []

    def density(points: Array) -> Array:
        where = Overlaps.of_points(points, grid.active)
        found.append((where, *grid.densities(where)))
        return where.blended(found[0][2][:, :1])[:, 0]

    samples = WeightedSamples.of_rays(grid.policy, grid.active, rays, options.stop, density)
    where, encoded, given = found[0]
    if samples.kept is not None:
        where, pairs = where.kept(samples.kept)
        encoded, given = encoded[pairs], given[pairs]
    offset, (weight, _, left) = samples.offset, samples.weights
    basis = harmonics(rays[1])[samples.ray]
    taken, raw_rgb = grid.colors(where, given[:, 1:], basis)
    rgb = sigmoid(where.blended(raw_rgb)).astype(kind)
    color = _core.blend_samples(offset, weight, rgb)
    depth = _core.blend_samples(offset, weight, samples.t[:, None])[:, 0]
    require_finite_image(color, left, batch)
    raw = np.concatenate([given[:, :1], raw_rgb], axis=1)
    of_pairs = where, encoded, taken, raw, rgb
    context = CellsContext(grid, rays[1], samples, *of_pairs, options.camera_adjoint)
    return Outputs(color, 1 - left, depth), context


def march_cells_backward(context: CellsContext, d_outputs: Outputs) -> dict[str, Array]:
    """Of each group, and "origins", "directions" (R, 3) if the options asked.

    Args:
        context: of `march_cells`.
        d_outputs: of the shapes of the outputs.
    """
    c, grid, samples, where = context, context.grid, context.samples, context.where
    weight, _, left = samples.weights
    function, ray = "LeafMlps.render_backward", samples.ray
    d_color, d_left, d_depth = cotangent_arrays(function, d_outputs, len(left), left.dtype)
    d_weight = d_depth[ray] * samples.t + (d_color[ray] * c.rgb).sum(axis=1)
    d_rgb = weight[:, None] * d_color[ray] * c.rgb * (1 - c.rgb)
    d_density = samples.d_density(grid.policy, d_weight, d_left)
    d_blended = np.concatenate([d_density[:, None], d_rgb], axis=1)
    d_raw = where.share[:, None] * d_blended[where.sample]
    density, color = grid.policy.networks()
    d_color_rows, d_taken = color.backward(
        grid.params["color"], where.offset, c.taken, np.ascontiguousarray(d_raw[:, 1:])
    )
    d_features, d_basis = np.split(d_taken, [grid.policy.features], axis=1)
    d_given = np.concatenate([d_raw[:, :1], d_features], axis=1)
    d_density_rows, d_encoded = density.backward(
        grid.params["density"], where.offset, c.encoded, d_given
    )
    gradients = {"density": d_density_rows, "color": d_color_rows}
    if c.camera_adjoint:
        encoding = FrequencyEncoding(grid.policy.octaves)
        d_local = encoding.encode_backward(where.local, d_encoded)
        d_local += where.d_local(c.raw, d_blended)
        count = len(samples.t)
        d_points = _sums(where.sample, d_local * (2 / SIDE), count).astype(d_local.dtype)
        origins, directions = samples.d_rays(grid.policy.box, grid.active.shape, d_points)
        of_samples = _sums(where.sample, d_basis, count)
        d_basis = _core.blend_samples(samples.offset, np.ones_like(weight), of_samples)
        gradients["origins"] = origins
        gradients["directions"] = directions + harmonics_backward(c.directions, d_basis)
    return gradients

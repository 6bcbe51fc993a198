"""Sparse volumes: octree, empty-space skipping, pruning, dilation, and a recovery with them.

A volume fills the cube from -1 to 1 in x, y and z with n x n x n voxels, n a power of two. Points
are measured in *cells*: (0, 0, 0) is one corner of the cube and (n, n, n) the opposite one; cell
(i, j, k) extends from i to i + 1 along x and so on, and voxel (i, j, k) has its value at the center
of it. Rays, arguments of `march` and `fit_sparse`, are in the units of the cube instead. A *sparse
grid* is a list of active voxels (V, 3), their values (V, 4) with channels r, g, b and sigma, the
extinction per unit of length, and a table that maps a voxel to its row. Absent voxels are empty:
all four numbers are 0 there, outside the cube as well.

Your tasks are five functions, one section of the handout each; `photograd course check 10` tells
how far you are. The other functions are given and stay as they are. Values are float64, indices
int64.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Cube = Annotated[np.ndarray, "n n n"]  # bool
Tree = Annotated[np.ndarray, "N"]  # int64
Vectors = Annotated[np.ndarray, "R 3"]
Voxels = Annotated[np.ndarray, "V 3"]  # int64
Values = Annotated[np.ndarray, "V C"]
Corners = Annotated[np.ndarray, "8 M"]  # int64 rows, or weights
Samples = Annotated[np.ndarray, "M C"]
Colors = Annotated[np.ndarray, "R 3"]
Wanted = Annotated[np.ndarray, "R count"]  # bool
Losses = Annotated[np.ndarray, "rounds*steps"]
Rays = Annotated[np.ndarray, "2 R 3"]  # origins, directions
Leaf = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]

EMPTY, FULL = 0, -1  # leaves of an octree
START = np.array([0.5, 0.5, 0.5, 0.1])  # a new voxel: gray, with little extinction
RATES = np.array([0.05, 0.05, 0.05, 0.4])  # of Adam, by channel


def octree_from_dense(full: Cube) -> Tree:
    """The octree of a cube of cells that are full or empty.

    Args:
        full: (n, n, n) of bool, n a power of two; n = 1 is allowed.

    Returns:
        tree (N,) of int64. Node 0 is the whole cube. tree[node] is EMPTY or FULL for a leaf, a
        cube of equal cells that is as large as possible; otherwise it is the index of the first of
        eight consecutive children: child 4 X + 2 Y + Z, where X, Y and Z are 1 in the upper half
        along x, y and z. Handout equations (4) to (6).
    """
    # >>> solution 10.1
    tree = [EMPTY]

    def cut(node, block):
        if block.all():
            tree[node] = FULL
        elif block.any():
            first = tree[node] = len(tree)
            tree.extend([EMPTY] * 8)
            half = len(block) // 2
            for octant, upper in enumerate(np.ndindex(2, 2, 2)):
                parts = tuple(slice(half * up, half * up + half) for up in upper)
                cut(first + octant, block[parts])

    cut(0, full)
    return np.array(tree)
    # <<< solution


def octree_leaf(tree, n, points):
    """The leaves that contain the points.

    Args:
        tree: (N,), of `octree_from_dense`.
        n: cells per side of the cube.
        points: (M, 3), in cells, inside the cube.

    Returns:
        (full, low, side): (M,) of bool; (M, 3), the lower corner of the leaf in cells; (M,), its
        side. A point on a common face belongs to the upper leaf.
    """
    node = np.zeros(len(points), np.int64)
    low, side = np.zeros(points.shape), np.full(len(points), float(n))
    while (inner := tree[node] > 0).any():
        side = np.where(inner, side / 2, side)
        upper = (points >= low + side[:, None]) & inner[:, None]
        low = low + upper * side[:, None]
        node = np.where(inner, tree[node] + upper @ np.array([4, 2, 1]), node)
    return tree[node] == FULL, low, side


def skip_empty(leaf: Leaf, first: Vectors, stride: Vectors, count: int) -> Wanted:
    """Empty-space skipping: which samples of rays lie in full leaves.

    Args:
        leaf: a function from points (M, 3) to (full, low, side), as for `octree_leaf`. The points
            are counted: look up as few as you can.
        first: (R, 3), sample 0 of each ray, in cells.
        stride: (R, 3), from one sample to the next; one or two components may be zero.
        count: samples per ray; all lie inside the cube.

    Returns:
        (R, count) of bool; handout equations (7) and (8).
    """
    # >>> solution 10.2
    wanted = np.zeros((len(first), count), bool)
    k = np.zeros(len(first), np.int64)
    live = np.arange(len(first))
    for _ in range(count):  # each iteration advances by one sample or more
        here, step = first[live] + k[live, None] * stride[live], stride[live]
        full, low, side = leaf(here)
        face = low + np.where(step > 0, side[:, None], 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = np.where(step == 0, np.inf, (face - here) / step)
        jump = np.ceil(np.minimum(ahead.min(axis=1), count))
        after = np.minimum(k[live] + np.maximum(jump, 1).astype(np.int64), count)
        number = np.arange(count)
        within = (number >= k[live, None]) & (number < after[:, None])
        wanted[live] |= within & full[:, None]
        k[live] = after
        live = live[after < count]
    return wanted
    # <<< solution


def row_table(n, voxels):
    """Where the values of each voxel are: an array of int64 with its row, -1 for an absent one.

    It has n + 2 entries along each axis: voxel (i, j, k) is entry [i + 1, j + 1, k + 1], and the
    outermost layer stands for voxels just outside of the cube, which are always absent.
    """
    table = np.full((n + 2, n + 2, n + 2), -1, np.int64)
    table[tuple(voxels.T + 1)] = np.arange(len(voxels))
    return table


def find_rows(table, voxels):
    """The rows (M,) of voxels (M, 3) by a table of `row_table`; -1 for absent ones.

    Indices go from -1 to n.
    """
    return table[tuple(voxels.T + 1)]


def corners(table, points):
    """The eight voxels around each point: (row, weight), both (8, M); row -1 for an absent one.

    Values belong to the centers of cells; weights are trilinear and sum to 1.
    """
    low = np.floor(points - 0.5).astype(np.int64)
    part = points - 0.5 - low
    row, weight = [], []
    for corner in np.ndindex(2, 2, 2):
        row.append(find_rows(table, low + corner))
        weight.append(np.prod(np.where(corner, part, 1 - part), axis=1))
    return np.stack(row), np.stack(weight)


def sample_sparse(values, row, weight):
    """Values (M, C) at points with these `corners`; an absent voxel counts as 0.

    Args:
        values: (V, C), one row for each active voxel.
        row, weight: (8, M); row -1 for an absent voxel.
    """
    padded = np.concatenate([values, np.zeros((1, values.shape[1]))])  # row -1 is the last one
    return sum(w[:, None] * padded[r] for w, r in zip(weight, row, strict=True))


def sample_sparse_adjoint(voxel_count: int, row: Corners, weight: Corners, g: Samples) -> Values:
    """The adjoint of `sample_sparse`: scatters the derivative of each sample to its voxels.

    Args:
        voxel_count: V, the number of active voxels.
        row, weight: (8, M), as for `sample_sparse`; row -1 for an absent voxel.
        g: (M, C), the derivative of some loss with respect to each sample.

    Returns:
        (V, C), the derivative of that loss with respect to each value; handout equations (9) and
        (10).
    """
    # >>> solution 10.3
    known = row >= 0
    d_values = np.zeros((voxel_count, g.shape[1]))
    parts = weight[:, :, None] * g
    np.add.at(d_values, row[known], parts[known])
    return d_values
    # <<< solution


def prune_and_dilate(
    n: int, voxels: Voxels, row: Corners, share: Corners, threshold: float, grow: int
) -> Voxels:
    """Prune voxels of small contribution, and dilate the remaining set.

    Args:
        n: voxels per side of the cube.
        voxels: (V, 3), the active ones, in any order.
        row, share: (8, M) or any other shape: for each sample, the row of a voxel and its
            contribution to a pixel; row -1 for an absent voxel. Rows may occur many times, or
            never.
        threshold: a voxel is kept if its *largest* share is more than this.
        grow: each kept voxel adds all voxels of the cube whose three indices differ from its own
            by at most this; 0 or more.

    Returns:
        (W, 3) of int64, each voxel once, ordered by x, then y, then z; handout equations (11) and
        (12).
    """
    # >>> solution 10.4
    worth = np.zeros(len(voxels))
    np.maximum.at(worth, row[row >= 0], share[row >= 0])
    stays = voxels[worth > threshold]
    active = np.zeros((n, n, n), bool)
    for away in np.ndindex(3 * (2 * grow + 1,)):
        moved = stays + np.array(away) - grow
        inside = ((moved >= 0) & (moved < n)).all(axis=1)
        active[tuple(moved[inside].T)] = True
    return np.argwhere(active).astype(np.int64)
    # <<< solution


def march(n, voxels, rays):
    """Samples of rays in a sparse grid, in the cells that active voxels affect, no others.

    A ray is cut into 2 n equal steps between its entry and its exit of the cube, with a sample at
    the midpoint of each.

    Args:
        n: voxels per side.
        voxels: (V, 3), the active ones; their rows are those of this list.
        rays: (2, R, 3), origins and unit directions, in the units of the cube from -1 to 1, not in
            cells; rays that miss the cube have no samples.

    Returns:
        a tuple for `render`, `loss_and_grad` and `shares`: (wanted (R, 2 n) of bool, the samples
        that are evaluated; step (R,), their lengths; row and weight (8, M), `corners` of these
        samples, ray by ray).
    """
    origin, direction = rays
    with np.errstate(divide="ignore"):
        ends = (np.array([[[-1.0]], [[1.0]]]) - origin) / direction
    near = np.maximum(ends.min(axis=0).max(axis=1), 0)
    step = np.maximum(ends.max(axis=0).min(axis=1) - near, 0) / (2 * n)
    first = (origin + (near + step / 2)[:, None] * direction + 1) * (n / 2)
    stride = step[:, None] * direction * (n / 2)
    # A sample uses voxels up to a cell away: no pruning here, dilation by one.
    alone = np.arange(len(voxels))[None]
    reached = prune_and_dilate(n, voxels, alone, np.ones(alone.shape), 0.0, 1)
    touched = np.zeros((n, n, n), bool)
    touched[tuple(reached.T)] = True
    tree = octree_from_dense(touched)
    wanted, hits = np.zeros((len(step), 2 * n), bool), step > 0
    wanted[hits] = skip_empty(
        lambda points: octree_leaf(tree, n, points), first[hits], stride[hits], 2 * n
    )
    ray, k = np.nonzero(wanted)
    points = first[ray] + k[:, None] * stride[ray]
    return wanted, step, *corners(row_table(n, voxels), points)


def _along_rays(values, samples):
    """For both passes: values at samples, weights, and the transmittance behind each."""
    wanted, step, row, weight = samples
    at = np.zeros((*wanted.shape, 4))
    at[wanted] = sample_sparse(values, row, weight)
    kept = np.exp(-np.cumsum(at[:, :, 3] * step[:, None], axis=1))
    T = np.concatenate([np.ones((len(step), 1)), kept[:, :-1]], axis=1)
    return at, T - kept, kept


def render(values, samples):
    """Colors (R, 3) of rays through a sparse grid before a black background.

    Args:
        values: (V, 4), one row for each active voxel.
        samples: of `march`, for the same voxels.
    """
    at, w, _ = _along_rays(values, samples)
    return np.einsum("rs,rsc->rc", w, at[:, :, :3])


def loss_and_grad(values, samples, target):
    """Mean squared error of the colors of rays, and its derivative.

    Args:
        values, samples: as for `render`.
        target: (R, 3), measured colors.

    Returns:
        (loss, d_values), the derivative (V, 4).
    """
    wanted, step, row, weight = samples
    at, w, kept = _along_rays(values, samples)
    residual = np.einsum("rs,rsc->rc", w, at[:, :, :3]) - target
    d_pixel = 2 * residual / residual.size
    d_at = np.zeros(at.shape)
    d_at[:, :, :3] = w[:, :, None] * d_pixel[:, None]
    d_w = np.einsum("rsc,rc->rs", at[:, :, :3], d_pixel)
    behind = np.cumsum((w * d_w)[:, ::-1], axis=1)[:, ::-1] - w * d_w
    d_at[:, :, 3] = step[:, None] * (kept * d_w - behind)
    d_values = sample_sparse_adjoint(len(values), row, weight, d_at[wanted])
    return float(np.mean(residual**2)), d_values


def shares(values, samples):
    """(row, share), both (8, M): the contribution of each voxel to a pixel, sample by sample.

    A share is the weight of the sample in its pixel times the weight of the voxel in the sample.
    """
    wanted, _, row, weight = samples
    return row, weight * _along_rays(values, samples)[1][wanted]


class Adam:
    """Adam for one array, as in assignment 01, with beta1 = 0.9 and beta2 = 0.99."""

    def __init__(self):
        self.m = self.v = self.k = 0

    def step(self, x, d_x):
        """The array after one step with learning rates RATES; x does not change."""
        self.k += 1
        self.m = 0.9 * self.m + 0.1 * d_x
        self.v = 0.99 * self.v + 0.01 * d_x**2
        m, v = self.m / (1 - 0.9**self.k), self.v / (1 - 0.99**self.k)
        return x - RATES * m / (np.sqrt(v) + 1e-10)


def fit_sparse(
    n: int,
    voxels: Voxels,
    values: Values,
    rays: Rays,
    target: Colors,
    rounds: int,
    steps: int,
    threshold: float,
    grow: int,
) -> tuple[Voxels, Values, Losses]:
    """Recover a sparse grid: its values and the set of its active voxels.

    Args:
        n: voxels per side of the cube.
        voxels: (V, 3), active at the start, in any order.
        values: (V, 4), their initial values; these arrays must not change.
        rays: (2, R, 3), origins and unit directions, in the units of the cube, as for `march`.
        target: (R, 3), the measured colors.
        rounds: 1 or more; between two of them the list of voxels is renewed.
        steps: of Adam in each round, 0 or more.
        threshold, grow: of `prune_and_dilate`.

    Returns:
        (voxels, values, losses): of the last round; losses (rounds * steps,), before each step.
        Handout equations (13) to (15).
    """
    # >>> solution 10.5
    losses = []
    for number in range(rounds):
        samples = march(n, voxels, rays)
        adam = Adam()
        for _ in range(steps):
            value, d_values = loss_and_grad(values, samples, target)
            values = adam.step(values, d_values)
            values[:, 3] = np.maximum(values[:, 3], 0)
            losses.append(value)
        if number < rounds - 1:
            chosen = prune_and_dilate(n, voxels, *shares(values, samples), threshold, grow)
            old = find_rows(row_table(n, voxels), chosen)
            values = np.where(old[:, None] >= 0, values[old], START)
            voxels = chosen
    return voxels, values, np.array(losses)
    # <<< solution


def refine(n, voxels, values, rays, threshold):
    """Twice the resolution: voxels that matter to these rays, each divided into eight.

    Args:
        n, voxels, values: a sparse grid.
        rays, threshold: a voxel is kept if its largest share in them is more than the threshold.

    Returns:
        (2 n, voxels (8 W, 3), values (8 W, 4)), where eight voxels have the values of one.
    """
    kept = prune_and_dilate(n, voxels, *shares(values, march(n, voxels, rays)), threshold, 0)
    old = find_rows(row_table(n, voxels), kept)
    octants = np.array(list(np.ndindex(2, 2, 2)))
    return 2 * n, (2 * kept[:, None] + octants).reshape(-1, 3), np.repeat(values[old], 8, axis=0)


def active_stats(n, tree, values):
    """Bytes of a volume: (dense, octree, rows of voxels, values), 8 for each number."""
    return 8 * 4 * n**3, 8 * tree.size, 8 * (n + 2) ** 3, 8 * values.size

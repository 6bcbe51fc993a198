"""From a network to structure: octree leaves, and a multiresolution hash encoding.

A field maps points of the unit square (D = 2) or the unit cube (D = 3) to C values. Points are
rows (N, D), x first, from 0 to 1; in an image x runs to the right and y *down*. A *level* of
resolution n divides the square or cube into n cells along each axis, with n + 1 corners. Level l
is row l of `levels`: its resolution, its first row in the table, and its number of rows. The
*table* (R, F) holds the rows of all levels, one level after the other.

Your tasks are six functions, one section of the handout each; `photograd course check 13` tells how
far you are. The other functions are given and stay as they are. Values are float64, indices int64.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Points = Annotated[np.ndarray, "N D"]
Values = Annotated[np.ndarray, "N C"]
Field = Callable[[np.ndarray], np.ndarray]
Leaf = Annotated[np.ndarray, "n n ..."]  # int64, D axes
Leaves = Annotated[np.ndarray, "V C"]
Corners = Annotated[np.ndarray, "M D"]  # int64
Rows = Annotated[np.ndarray, "M"]  # int64
Levels = Annotated[np.ndarray, "L 3"]  # int64: resolution, first row, rows
Table = Annotated[np.ndarray, "R F"]
Features = Annotated[np.ndarray, "N L*F"]
Batches = Annotated[np.ndarray, "steps B"]  # int64
Weights = list[np.ndarray]  # (inputs + 1, outputs) of each layer
Losses = Annotated[np.ndarray, "steps"]

PRIMES = (1, 2654435761, 805459861)  # of the hash function, by axis
BETA1, BETA2, EPS = 0.9, 0.99, 1e-15  # of Adam


def tabulate(field: Field, n: int, offsets: Points, tolerance: float) -> tuple[Leaf, Leaves]:
    """Tabulate a field in the leaves of a quadtree (D = 2) or octree (D = 3).

    Args:
        field: a function from points (N, D) to values (N, C). The points are counted: no more
            than one for each offset in each cell.
        n: cells along an axis, a power of two.
        offsets: (S, D), where the samples of a cell lie, in units of the cell, 0 to 1.
        tolerance: a cube of cells is one leaf if the values of its cells differ by at most this,
            in every channel; 0 or more.

    Returns:
        leaf (n, n) or (n, n, n) of int64, the leaf of each cell, indexed by x first; and values
        (V, C), one row for each leaf, in any order. Handout equations (4) and (5).
    """
    # >>> solution 13.1
    D = offsets.shape[1]
    cells = np.stack(np.indices(D * (n,)), axis=-1).reshape(-1, 1, D)
    samples = field(((cells + offsets) / n).reshape(-1, D))
    means = samples.reshape(*D * (n,), len(offsets), -1).mean(axis=D)
    leaf, values = np.zeros(D * (n,), np.int64), []

    def divide(low, side):
        block = tuple(slice(a, a + side) for a in low)
        inside = means[block].reshape(side**D, -1)
        if (np.ptp(inside, axis=0) <= tolerance).all():
            leaf[block] = len(values)
            values.append(inside.mean(axis=0))
        else:
            for upper in np.ndindex(D * (2,)):
                divide(low + side // 2 * np.array(upper), side // 2)

    divide(np.zeros(D, np.int64), n)
    return leaf, np.array(values)
    # <<< solution


def read_leaves(leaf, values, points):
    """The values (N, C) of the leaves that contain given points (N, D)."""
    n = len(leaf)
    cell = np.clip((points * n).astype(np.int64), 0, n - 1)
    return values[leaf[tuple(cell.T)]]


def hash_index(corners: Corners, resolution: int, rows: int) -> Rows:
    """The row of each corner of a level, counted from the level's first row.

    Args:
        corners: (M, D) of int64, each index from 0 to `resolution`; D is 2 or 3, M may be 0.
        resolution: n, cells along an axis.
        rows: T, of this level in the table; any number, not only a power of two.

    Returns:
        (M,) of int64, from 0 to rows - 1; handout equations (6) and (7).
    """
    # >>> solution 13.2
    D = corners.shape[1]
    if (resolution + 1) ** D <= rows:
        return corners @ (resolution + 1) ** np.arange(D)
    bits = np.zeros(len(corners), np.int64)
    for axis in range(D):
        bits ^= corners[:, axis] * PRIMES[axis] % 2**32
    return bits % rows
    # <<< solution


def make_levels(resolutions, dimensions, most):
    """The levels (L, 3) of these resolutions: dense where all corners fit into `most` rows."""
    levels, first = [], 0
    for n in resolutions:
        levels.append((n, first, min((n + 1) ** dimensions, most)))
        first += levels[-1][2]
    return np.array(levels)


# >>> solution 13.3
def _look_up(points, levels):
    """For each level: the position in the cell (N, D), and (side, rows, weights) of each corner."""
    D = points.shape[1]
    for n, first, rows in levels.tolist():
        spot = np.clip(points, 0, 1) * n
        low = np.minimum(spot.astype(np.int64), n - 1)
        part = spot - low
        found = []
        for side in np.ndindex(D * (2,)):
            weights = np.where(side, part, 1 - part)
            found.append((side, first + hash_index(low + side, n, rows), weights))
        yield n, found


# <<< solution


def encode(points: Points, table: Table, levels: Levels) -> Features:
    """Features of points: on each level the D-linear interpolation of the corners of the cell.

    Args:
        points: (N, D); what lies outside of 0 to 1 has the features of the nearest point inside.
            N may be 0.
        table: (R, F), the rows of all levels.
        levels: (L, 3), resolution, first row and number of rows of each level.

    Returns:
        (N, L F): the F features of level 0, then those of level 1, and so on; handout equations
        (8) to (10).
    """
    # >>> solution 13.3
    features = np.zeros((len(points), len(levels), table.shape[1]))
    for level, (_, found) in enumerate(_look_up(points, levels)):
        for _, rows, weights in found:
            features[:, level] += weights.prod(axis=1)[:, None] * table[rows]
    return features.reshape(len(points), len(levels) * table.shape[1])
    # <<< solution


def encode_backward(
    points: Points, table: Table, levels: Levels, d_features: Features
) -> tuple[Table, Points]:
    """Derivatives of a loss with respect to the table and to the points.

    Args:
        points, table, levels: as for `encode`; N may be 0.
        d_features: (N, L F), the derivatives of the loss with respect to the features.

    Returns:
        (d_table (R, F), d_points (N, D)); handout equations (11) and (12).
    """
    # >>> solution 13.4
    N, D = points.shape
    back = d_features.reshape(N, len(levels), table.shape[1])
    d_table, d_points = np.zeros(table.shape), np.zeros((N, D))
    for level, (n, found) in enumerate(_look_up(points, levels)):
        for side, rows, weights in found:
            parts = weights.prod(axis=1)[:, None] * back[:, level]
            for column, part in enumerate(parts.T):
                d_table[:, column] += np.bincount(rows, part, len(table))
            along = n * np.sum(table[rows] * back[:, level], axis=1)
            for axis in range(D):
                others = np.delete(weights, axis, axis=1).prod(axis=1)
                d_points[:, axis] += (2 * side[axis] - 1) * others * along
    return d_table, d_points * ((points >= 0) & (points <= 1))
    # <<< solution


def adam_rows(
    table: Table, d_table: Table, m: Table, v: Table, k: int, rate: float
) -> tuple[Table, Table, Table]:
    """One step of Adam in the rows that have a derivative; all others stay, moments included.

    Args:
        table, d_table: (R, F), the values and the derivatives of the loss.
        m, v: (R, F), running means of the derivatives and of their squares, zeros at first.
        k: the number of this step, from 1.
        rate: the learning rate.

    Returns:
        new arrays (table, m, v); the given ones must not change. Handout equations (13), (14).
    """
    # >>> solution 13.5
    table, m, v = table.copy(), m.copy(), v.copy()
    rows = d_table.any(axis=1)
    d = d_table[rows]
    m[rows] = BETA1 * m[rows] + (1 - BETA1) * d
    v[rows] = BETA2 * v[rows] + (1 - BETA2) * d**2
    mean, square = m[rows] / (1 - BETA1**k), v[rows] / (1 - BETA2**k)
    table[rows] -= rate * mean / (np.sqrt(square) + EPS)
    return table, m, v
    # <<< solution


def finetune(leaf, values, points, target, steps, rate):
    """Leaves that learn from measured values: the leaves stay, what they hold is trained.

    Args:
        leaf, values: of `tabulate`.
        points: (N, D), where the field was measured.
        target: (N, C), the measured values.
        steps, rate: of `adam_rows`; the loss is the mean squared error.

    Returns:
        the new values (V, C); leaves without any point in them keep theirs.
    """
    rows = read_leaves(leaf, np.arange(len(values)), points)
    m = v = np.zeros(values.shape)
    for k in range(steps):
        d_leaves = np.zeros(values.shape)
        np.add.at(d_leaves, rows, 2 * (values[rows] - target) / target.size)
        values, m, v = adam_rows(values, d_leaves, m, v, k + 1, rate)
    return values


class Adam:
    """Adam for a list of arrays, all rows; the constants are those of `adam_rows`."""

    def __init__(self, count):
        self.m, self.v, self.k = [0.0] * count, [0.0] * count, 0

    def step(self, arrays, derivatives, rate):
        """The arrays after one step; the given ones do not change."""
        self.k += 1
        result = []
        for i, (x, d) in enumerate(zip(arrays, derivatives, strict=True)):
            self.m[i] = BETA1 * self.m[i] + (1 - BETA1) * d
            self.v[i] = BETA2 * self.v[i] + (1 - BETA2) * d**2
            m, v = self.m[i] / (1 - BETA1**self.k), self.v[i] / (1 - BETA2**self.k)
            result.append(x - rate * m / (np.sqrt(v) + EPS))
        return result


def start_weights(sizes, rng):
    """Random weights of a network with `sizes` numbers in its layers, such as (16, 16, 3).

    One array (inputs + 1, outputs) for each layer; its last row is added, zeros at first.
    """
    return [
        np.vstack([rng.normal(0, np.sqrt(2 / a), (a, b)), np.zeros((1, b))])
        for a, b in pairwise(sizes)
    ]


def _layers(weights, x):
    """What enters each layer, and the result of the last: ReLU after every layer but that one."""
    entering = [x]
    for number, w in enumerate(weights):
        x = x @ w[:-1] + w[-1]
        entering.append(x if number == len(weights) - 1 else np.maximum(x, 0))
        x = entering[-1]
    return entering


def network(weights, x):
    """The values (N, C) of a network for inputs (N, inputs): the decoder of features, too."""
    return _layers(weights, x)[-1]


def network_loss_and_grad(weights, x, target):
    """Mean squared error of a network, and its derivatives.

    Args:
        weights: of `start_weights`.
        x: (N, inputs).
        target: (N, C).

    Returns:
        (loss, d_weights (a list like weights), d_x (N, inputs)).
    """
    entering = _layers(weights, x)
    d = 2 * (entering[-1] - target) / target.size
    loss, d_weights = float(np.mean((entering[-1] - target) ** 2)), []
    for number in reversed(range(len(weights))):
        if number < len(weights) - 1:
            d = d * (entering[number + 1] > 0)
        d_weights.append(np.vstack([entering[number].T @ d, d.sum(axis=0)]))
        d = d @ weights[number][:-1].T
    return loss, d_weights[::-1], d


def frequencies(points, octaves):
    """The frequency encoding of NeRF: points, then sin and cos of 2^k pi times the points."""
    waves = [2.0**k * np.pi * points for k in range(octaves)]
    return np.concatenate([points, *(f(w) for w in waves for f in (np.sin, np.cos))], axis=1)


def train_network(points, target, batches, octaves, weights, rate):
    """The plain network, trained like the hash grid: no table, the points encoded by waves.

    Returns:
        (weights, losses (steps,), before each step).
    """
    adam, losses, x = Adam(len(weights)), [], frequencies(points, octaves)
    for batch in batches:
        loss, d_weights, _ = network_loss_and_grad(weights, x[batch], target[batch])
        weights = adam.step(weights, d_weights, rate)
        losses.append(loss)
    return weights, np.array(losses)


def train_hash_grid(
    points: Points,
    target: Values,
    batches: Batches,
    levels: Levels,
    table: Table,
    weights: Weights,
    rate: float,
) -> tuple[Table, Weights, Losses]:
    """Train a table and its decoder together.

    Args:
        points: (N, D), all points of the data.
        target: (N, C), the values there.
        batches: (steps, B) of int64, the rows of `points` and `target` that each step uses; there
            may be 0 steps.
        levels: (L, 3), of `make_levels`.
        table: (R, F), at the start.
        weights: of the decoder at the start, from L F features to C values.
        rate: the learning rate of both.

    Returns:
        (table, weights, losses (steps,), before each step); the given arrays must not change.
        Handout equation (15).
    """
    # >>> solution 13.6
    losses, adam = [], Adam(len(weights))
    m = v = np.zeros(table.shape)
    for k, batch in enumerate(batches):
        x = points[batch]
        features = encode(x, table, levels)
        loss, d_weights, d_features = network_loss_and_grad(weights, features, target[batch])
        d_table, _ = encode_backward(x, table, levels, d_features)
        table, m, v = adam_rows(table, d_table, m, v, k + 1, rate)
        weights = adam.step(weights, d_weights, rate)
        losses.append(loss)
    return table, weights, np.array(losses)
    # <<< solution


def numbers_per_point(weights, levels=(), features=0, dimensions=2):
    """How many stored numbers one point of a batch uses: each weight, 2^D rows on each level."""
    return sum(w.size for w in weights) + len(levels) * 2**dimensions * features


def julia(points, c=-0.8 + 0.156j, steps=48):
    """A picture with detail at every scale: colors (N, 3) of points in the unit square.

    How fast z <- z^2 + c leaves a disk of radius 4, as a color; points that never do have one.
    """
    z = 2.6 * (points[:, 0] - 0.5) + 2.6j * (points[:, 1] - 0.5)
    count = np.full(len(points), float(steps))
    inside = np.ones(len(points), bool)
    for step in range(steps):
        gone = inside & (z.real**2 + z.imag**2 > 16)
        size = np.abs(z[gone])
        count[gone] = step + 2 - np.log2(np.log2(size))
        inside &= ~gone
        z = np.where(inside, z * z + c, 0)
    turn = 1.6 * np.sqrt(np.maximum(count, 0) / steps)
    return 0.5 - 0.5 * np.cos(2 * np.pi * (turn[:, None] + np.array([0.0, 0.12, 0.25])))


def pixels(size):
    """The centers (size size, 2) of the pixels of a square image, row by row."""
    v, u = np.divmod(np.arange(size * size), size)
    return (np.stack([u, v], axis=1) + 0.5) / size

"""The hash encoding in float32: bit for bit the formulas in their order, and steps of a descent."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
from photograd.fitting.steps import RowAdam
from photograd.network import HashEncoding, Perceptron

from support.bits import same_bits

pytestmark = pytest.mark.usefixtures("core")

F4 = np.float32
PRIMES = (1, 2654435761, 805459861)
KERNELS = ("hash_encode", "hash_scatter", "hash_points")
SHAPES = {
    "2D": HashEncoding([3, 8, 21], dimensions=2, log2_rows=6, features=3),
    "one feature": HashEncoding([3, 30], log2_rows=8, features=1),
    "two features": HashEncoding([2, 5, 13, 2048], log2_rows=16, features=2),
    "four features": HashEncoding([6, 16], log2_rows=9, features=4),
    "eight features": HashEncoding([6, 16], dimensions=2, log2_rows=5, features=8),
    "smoothstep": HashEncoding([2, 5, 13], log2_rows=7, features=2, smoothstep=True),
    "eight rows": HashEncoding([40], log2_rows=3, features=2),
}
each_shape = pytest.mark.parametrize("encoding", SHAPES.values(), ids=SHAPES)


def inputs(encoding: HashEncoding, count: int) -> tuple[Any, Any, Any]:
    """A table, points of which some lie outside, cotangents."""
    random = np.random.default_rng(count)
    table = random.normal(size=(encoding.rows, encoding.features)).astype(F4)
    points = random.random((count, encoding.dimensions)) * 1.02 - 0.01
    points[0], points[-1] = 0.0, 1.0
    d = random.normal(size=(count, encoding.outputs)).astype(F4)
    return table, points.astype(F4), d


def corners(encoding: HashEncoding, level: Any, points: Any) -> Any:
    """(row, weight, derivative of the weight with respect to the point) of each corner, float32."""
    n = F4(level.resolution)
    inside = np.clip(points, F4(0), F4(1))
    at = inside * n
    cell = np.minimum(at.astype(np.int64), level.resolution - 1)
    f = at - cell.astype(F4)
    rate = np.where(inside == points, n, F4(0))
    if encoding is SHAPES["smoothstep"]:
        f, rate = f * f * (F4(3) - F4(2) * f), rate * (F4(6) * f * (F4(1) - f))
    axes = range(encoding.dimensions)
    for k in range(2**encoding.dimensions):
        side = [k >> a & 1 for a in axes]
        number = [cell[:, a] + side[a] for a in axes]
        if level.dense:
            row = sum(number[a] * (level.resolution + 1) ** a for a in axes)
        else:
            row = np.bitwise_xor.reduce([number[a] * PRIMES[a] % 2**32 for a in axes]) % level.rows
        sides = [f[:, a] if side[a] else F4(1) - f[:, a] for a in axes]
        weight = sides[0]
        for w in sides[1:]:
            weight = weight * w
        slopes = []
        for a in axes:
            slope = rate[:, a] if side[a] else -rate[:, a]
            for b in axes:
                slope = slope if a == b else slope * sides[b]
            slopes.append(slope)
        yield level.first + row, weight[:, None], np.stack(slopes, 1)


def in_numpy(encoding: HashEncoding, table: Any, points: Any, d: Any) -> tuple[Any, Any, Any]:
    """Features and both derivatives; sums run corner by corner, and point by point."""
    features, d_table, d_points = [], np.zeros_like(table), np.zeros_like(points)
    for number, level in enumerate(encoding.levels):
        d_level = d[:, number * encoding.features : (number + 1) * encoding.features]
        total: Any = None
        rows, increments = [], []
        for row, weight, slopes in corners(encoding, level, points):
            total = weight * table[row] if total is None else total + weight * table[row]
            rows.append(row)
            increments.append(weight * d_level)
            along = table[row][:, 0] * d_level[:, 0]
            for f in range(1, encoding.features):
                along = along + table[row][:, f] * d_level[:, f]
            d_points += slopes * along[:, None]
        features.append(total)
        flat = np.stack(increments, 1).reshape(-1, encoding.features)
        np.add.at(d_table, np.stack(rows, 1).reshape(-1), flat)
    return np.concatenate(features, 1), d_table, d_points


@each_shape
@pytest.mark.parametrize("count", [1, 33, 1000])
def test_float32_agrees_with_the_formulas_bit_for_bit(encoding: HashEncoding, count: int) -> None:
    table, points, d = inputs(encoding, count)
    features, d_table, d_points = in_numpy(encoding, table, points, d)
    np.testing.assert_array_equal(encoding.encode(table, points), features)
    got_table, got_points = encoding.encode_backward(table, points, d, d_points=True)
    np.testing.assert_array_equal(got_table, d_table)
    np.testing.assert_array_equal(got_points, d_points)


def test_no_points_are_no_error() -> None:
    encoding = SHAPES["two features"]
    table, points, d = inputs(encoding, 1)
    assert encoding.encode(table, points[:0]).shape == (0, 8)
    d_table, _ = encoding.encode_backward(table, points[:0], d[:0])
    assert not d_table.any()


@same_bits("hash kernels", each=SHAPES, kernels=KERNELS)
def many_points(name: str) -> list[Any]:
    encoding = SHAPES[name]
    table, points, d = inputs(encoding, 20_000)
    features = encoding.encode(table, points)
    return [features, *encoding.encode_backward(table, points, d, d_points=True)]


class Descent:
    """A table and a network that learn three numbers at points of a small part of the cube."""

    encoding = HashEncoding([4, 60], log2_rows=13, features=2)
    network = Perceptron(4, [16, 3])

    def __init__(self) -> None:
        self.params = {"table": self.encoding.initial(seed=1), "net": self.network.initial(seed=2)}
        self.adam = RowAdam()
        random = np.random.default_rng(3)
        self.points = (0.5 + 0.1 * random.random((3000, 3))).astype(F4)
        self.targets = np.sin(20 * self.points)

    def step(self) -> None:
        table, net = self.params["table"], self.params["net"]
        features = self.encoding.encode(table, self.points)
        d = (self.network.forward(net, features) - self.targets) * F4(1e-3)
        d_net, d_features = self.network.backward(net, features, d)
        assert d_features is not None
        self.d_table, _ = self.encoding.encode_backward(table, self.points, d_features)
        self.adam.step(self.params, {"table": self.d_table, "net": d_net}, 1e-2)


def test_rows_that_no_point_takes_stay_as_they_are() -> None:
    descent = Descent()
    before = copy.deepcopy(descent.params["table"])
    for _ in range(3):
        descent.step()
    touched = (descent.d_table != 0).any(1)
    assert 100 < touched.sum() < len(touched) / 2
    changed = (descent.params["table"].view(np.uint32) != before.view(np.uint32)).any(1)
    np.testing.assert_array_equal(changed, touched)


@same_bits("hash descent", kernels=(*KERNELS[:2], "perceptron_forward", "perceptron_backward"))
def descent_with_one_seed() -> list[Any]:
    descent = Descent()
    for _ in range(4):
        descent.step()
    return list(descent.params.values())

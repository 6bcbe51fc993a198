"""Pictures of the gradient inside a field of networks: what stands where, and what it claims."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.fitting.network_gradients import (
    draw_layer_gradients,
    draw_level_gradients,
    level_planes,
)
from photograd.network import HashEncoding, Perceptron

pytestmark = pytest.mark.usefixtures("core")


def test_a_level_shows_who_is_asked_where() -> None:
    encoding = HashEncoding([4, 32], log2_rows=8)
    d_features = np.zeros((1, encoding.outputs))
    d_features[:, [0, 2]] = -1.0, 2.0
    point = np.array([[0.3, 0.7, 0.5]])
    table = np.zeros((encoding.rows, encoding.features))
    d_table, _ = encoding.encode_backward(table, point, d_features)
    dense, hashed = level_planes(encoding, d_table, pixels=32)
    row, column = np.unravel_index(np.argmin(dense), dense.shape)
    assert abs((column + 0.5) / 32 - 0.3) < 1 / 4
    assert abs((row + 0.5) / 32 - 0.7) < 1 / 4
    assert dense.min() < 0 == dense.max()  # one corner's ask stays in the cells around it
    assert np.count_nonzero(dense) == 24 * 24  # three of four cells along each axis
    near = np.s_[20:25, 7:12]  # and where rows are shared it repeats elsewhere
    away = np.abs(hashed).sum() - np.abs(hashed[near]).sum()
    assert hashed[near].max() > 0
    assert away > 2 * np.abs(hashed[near]).sum()


def test_panels_are_drawn_for_levels_and_layers() -> None:
    encoding = HashEncoding.geometric(levels=7, coarsest=2, finest=16, log2_rows=6, dimensions=2)
    d_table = np.random.default_rng(0).normal(size=(encoding.rows, 2))
    figure = draw_level_gradients({0: d_table, 9: 0 * d_table}, encoding)
    labels = [axes.get_xlabel() for axes in figure.axes]
    assert len(labels) == 10
    assert all("100% of rows" in text for text in labels[:5])
    assert all("all zero" in text for text in labels[5:])
    assert "corners a row" in figure.axes[4].get_title()
    network = Perceptron(3, [4, 2])
    figure = draw_layer_gradients({0: {"net": np.arange(network.count) * 1.0}}, {"net": network})
    shown = [np.asarray(axes.images[0].get_array()) for axes in figure.axes]
    for values, (W, _) in zip(shown, network.layers(np.arange(network.count) * 1.0), strict=True):
        np.testing.assert_array_equal(values, W)

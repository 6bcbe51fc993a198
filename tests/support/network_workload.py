"""A little of everything that networks and their encodings ask of the core."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.fields import HashGrid, Nerf
from photograd.network import (
    FrequencyEncoding,
    HashEncoding,
    LayerValues,
    OneBlobEncoding,
    Perceptron,
)
from photograd.representation import RenderOptions

G = np.random.default_rng(2)


def networks() -> None:
    for dtype in (np.float32, np.float64):
        points = G.random((5, 3)).astype(dtype)
        for encoding in (FrequencyEncoding(3), OneBlobEncoding(4)):
            encoding.encode_backward(points, encoding.encode(points))
        network = Perceptron(3, [8, 4, 2], skip=1)
        for fused in (True, False):
            parameters = network.initial(seed=1, dtype=dtype)
            outputs = network.forward(parameters, points, fused=fused)
            network.backward(parameters, points, outputs, fused=fused)
        if dtype == np.float32:
            network.forward(parameters, points, values=(values := LayerValues()))
            network.backward(parameters, points, outputs, values=values)
        for dimensions in (2, 3):
            hashed = HashEncoding([2, 9], dimensions=dimensions, log2_rows=5)
            table, p = hashed.initial(seed=1, dtype=dtype), points[:, :dimensions].copy()
            hashed.encode_backward(table, p, hashed.encode(table, p), d_points=True)
        fields: tuple[Any, ...] = (HashGrid, Nerf)
        for kind in fields:
            field = kind.example(seed=1, dtype=dtype)
            field.densities(np.zeros((3, 3), dtype))
            keep = RenderOptions(keep_samples=True)
            field.render(field.example_batch(seed=1), seed=1, step=0, options=keep)

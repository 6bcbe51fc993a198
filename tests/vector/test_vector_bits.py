"""Registers pictures and gradients of drawings for the test of bits."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.vector import Drawing, Rendering, Shape, Solid, Stroke, Subpath

from support.bits import same_bits
from tests.vector.oracle import everything


@same_bits("vector drawing")
def drawn() -> list[Any]:
    """More curves than a piece of edges holds."""
    rng = np.random.default_rng(1)
    curves = [
        Shape(
            (Subpath(rng.uniform(0, 60, (7, 2)), (3, 3)),),
            Solid(rng.uniform(0, 1, 3), 0.6),
            stroke=Stroke(rng.uniform(0.5, 5), "round", "round"),
        )
        for _ in range(40)
    ]
    rendering = Rendering(Drawing.of([*everything().shapes, *curves]), (57, 63))
    d = rng.uniform(-1, 1, rendering.picture.shape)
    found = rendering.backward(d)
    return [rendering.picture, *found.parameters.arrays().values(), found.background]

"""A synthetic gradient: negative in a ball, positive around it, like a first step of a fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

BOUNDS = np.array([[-1.0, -0.5, -1.0], [1.0, 1.0, 0.5]])


@dataclass(frozen=True)
class Field:
    values: NDArray[np.float64]  # (X, Y, Z)
    occupied: NDArray[np.bool_]
    bounds: NDArray[np.float64]


@pytest.fixture
def field() -> Field:
    shape = (20, 15, 12)  # three different counts, so that swapped axes cannot go unnoticed
    axes = [
        low + (np.arange(count) + 0.5) * (high - low) / count
        for low, high, count in zip(*BOUNDS, shape, strict=True)
    ]
    x, y, z = np.meshgrid(*axes, indexing="ij")
    distance = np.sqrt((x - 0.1) ** 2 + (y - 0.2) ** 2 + (z + 0.2) ** 2)
    values = 1e-3 * np.where(distance < 0.4, -np.exp(-distance), 0.3 * np.exp(-distance))
    return Field(values, distance < 0.4, BOUNDS)

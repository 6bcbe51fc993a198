"""How a field of networks is marched through, and what its backward pass needs of a rendering."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._checks import require_bounds
from photograd.fields.march import Activation, MarchPolicy
from photograd.types import Array

Rays = tuple[Array, Array, Array, Array]
"""Origins, directions, t0 and samples, as `checked_rays` returns them."""


@dataclass(frozen=True)
class NeuralPolicy(MarchPolicy):
    """How a field of networks is marched through, and how large its networks are.

    Attributes:
        width: of the hidden layers.
        depth: hidden layers of the density network; the color network has one.
        features: numbers that the color network takes from the density network.
        hidden: activation of the hidden layers.
    """

    density_activation: Activation = "exp"
    width: int = 64
    depth: int = 1
    features: int = 15
    hidden: Activation = "relu"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "width", "features", low=1, high=1024)
        require_bounds(self, "depth", low=1, high=32)


@dataclass(frozen=True)
class NeuralContext:
    """What the backward pass needs: O(1) per ray, and the samples that were kept, if any."""

    parameters: tuple[Array, Array, Array]
    occupancy: Array | None
    march: Any
    rays: Rays
    image: tuple[Array, Array, Array]
    camera_adjoint: bool
    kept: Any  # _core.NeuralSamples, or None
    placed: tuple[Array, Array] | None  # t, width of samples that do not lie on the lattice

    @property
    def sample_count(self) -> int:
        """Number of samples that were placed on all rays, in empty cells as well."""
        return int(self.rays[3].sum(dtype=np.int64))

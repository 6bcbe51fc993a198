"""NeRF: a frequency encoding and a deep network."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from photograd._checks import require_bounds
from photograd.fields.neural_field import NeuralField, NeuralPolicy
from photograd.network import FrequencyEncoding
from photograd.representation import ParamSpec, Start, register


@dataclass(frozen=True)
class NerfPolicy(NeuralPolicy):
    """How a NeRF is marched through, and how large it is.

    Attributes:
        octaves: of the frequency encoding.
    """

    depth: int = 4
    octaves: int = 10

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "octaves", low=0, high=24)


@register
class Nerf(NeuralField):
    """Neural radiance field [Mildenhall2020]: frequency encoding and a deep network.

    params: "density" and "color", flat as in `Perceptron`.
    """

    name: ClassVar[str] = "nerf"
    counts: ClassVar[str] = "width"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 64, "steps": 6000, "rays": 2048}
    row_updates: ClassVar[bool] = False  # every sample reaches every weight
    policy: NerfPolicy
    policy_class: ClassVar[type[NeuralPolicy]] = NerfPolicy

    @classmethod
    def _encoding(cls, policy: NerfPolicy) -> FrequencyEncoding:
        return FrequencyEncoding(policy.octaves)

    @property
    def resolution(self) -> int:
        """Width of the hidden layers."""
        return self.policy.width

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Nearly empty space in the box, random weights."""
        options = start.options
        policy = cls._start_policy(NerfPolicy, start, width=options.resolution)
        field = cls.initial(policy, seed=options.seed, sigma_t=options.sigma_t)
        return field, f"box: {start.bounds.rule}"

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """The two networks."""
        return {
            name: ParamSpec(values.shape, "1", (-1e4, 1e4), 2e-3, "none")
            for name, values in self.params.items()
        }

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Two octaves, a skip connection; smooth, so that differences find no kink."""
        policy = NerfPolicy(
            ((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)),
            0.11,
            width=8,
            features=4,
            hidden="softplus",
            octaves=2,
        )
        field = cls.initial(policy, seed=seed, sigma_t=0.2, dtype=dtype)
        field._perturb(seed, 0.3)
        return field

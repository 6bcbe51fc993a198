"""A multiresolution hash grid with small networks behind it: instant neural graphics primitives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from photograd._checkpoint import FLOAT, Row
from photograd._checks import require_bounds
from photograd.fields.neural_field import NeuralField
from photograd.fields.neural_policy import NeuralPolicy
from photograd.network import HashEncoding
from photograd.representation import ParamSpec, Start, register


@dataclass(frozen=True)
class HashGridPolicy(NeuralPolicy):
    """How a hash grid is marched through, and how large it is.

    Attributes:
        levels: of the encoding.
        coarsest, finest: cells along an axis of its first and its last level.
        log2_rows: of the largest table of a level.
        row_features: numbers in a row.
        smoothstep: whether interpolation has no kinks.
    """

    levels: int = 12
    coarsest: int = 16
    finest: int = 512
    log2_rows: int = 17
    row_features: int = 2
    smoothstep: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "levels", low=1, high=32)


@register
class HashGrid(NeuralField):
    """Instant neural graphics primitives [Mueller2022]: a hash encoding and two small networks.

    params: "table" (rows, features of a row); "density" and "color", flat as in `Perceptron`.
    """

    name: ClassVar[str] = "hash_grid"
    counts: ClassVar[str] = "finest level"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 512, "steps": 3000, "rays": 4096}
    policy: HashGridPolicy
    policy_class: ClassVar[type[NeuralPolicy]] = HashGridPolicy

    @classmethod
    def _encoding(cls, policy: HashGridPolicy) -> HashEncoding:
        return HashEncoding.geometric(
            levels=policy.levels,
            coarsest=policy.coarsest,
            finest=policy.finest,
            log2_rows=policy.log2_rows,
            features=policy.row_features,
            smoothstep=policy.smoothstep,
        )

    @property
    def resolution(self) -> int:
        """Cells of the finest level along an axis."""
        return self.policy.finest

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """Nearly empty space in the box, random weights."""
        options = start.options
        finest = options.resolution
        policy = cls._start_policy(HashGridPolicy, start, finest=finest, coarsest=min(16, finest))
        field = cls.initial(policy, seed=options.seed, sigma_t=options.sigma_t)
        return field, f"box: {start.bounds.rule}"

    @classmethod
    def _table_rows(cls) -> dict[str, Row]:
        return {"table": (FLOAT, ("N", "F"))}

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """The table, and the networks."""
        return {
            name: ParamSpec(values.shape, "1", (-1e4, 1e4), 1e-2, "none")
            for name, values in self.params.items()
        }

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Three levels, the finest hashed; smooth, so that differences find no kink."""
        policy = HashGridPolicy(
            ((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)),
            0.11,
            width=8,
            features=4,
            hidden="softplus",
            levels=3,
            coarsest=2,
            finest=7,
            log2_rows=7,
            smoothstep=True,
        )
        field = cls.initial(policy, seed=seed, sigma_t=0.2, dtype=dtype)
        field._perturb(seed, 0.4)
        return field

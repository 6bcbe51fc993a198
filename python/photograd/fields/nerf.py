"""NeRF: a frequency encoding and a deep network."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from photograd_course.random import uniform

from photograd._checks import require_bounds
from photograd.errors import RangeError, message
from photograd.fields.importance import fine_samples
from photograd.fields.neural_field import NeuralField
from photograd.fields.neural_policy import NeuralPolicy, Rays
from photograd.network import FrequencyEncoding
from photograd.representation import ParamSpec, RayBatch, RenderOptions, Start, register
from photograd.types import Array


@dataclass(frozen=True)
class NerfPolicy(NeuralPolicy):
    """How a NeRF is marched through, and how large it is.

    Attributes:
        octaves: of the frequency encoding.
        importance: samples of a ray by importance; 0 for those of the lattice.
    """

    depth: int = 4
    octaves: int = 10
    importance: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_bounds(self, "octaves", low=0, high=24)
        require_bounds(self, "importance", low=0, high=4096)


@register
class Nerf(NeuralField):
    """Neural radiance field [Mildenhall2020]: frequency encoding and a deep network.

    Samples lie on the lattice of the march, or by importance (photograd/fields/importance.py), if
    the policy says how many; no derivative is taken with respect to their positions.

    params: "density" and "color", flat as in `Perceptron`.
    """

    name: ClassVar[str] = "nerf"
    counts: ClassVar[str] = "width"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 64, "steps": 6000, "rays": 2048}
    fit_options: ClassVar[frozenset[str]] = frozenset({"importance"})
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
        sizes = {"width": options.resolution, "importance": options.importance}
        policy = cls._start_policy(NerfPolicy, start, **sizes)
        field = cls.initial(policy, seed=options.seed, sigma_t=options.sigma_t)
        return field, f"box: {start.bounds.rule}"

    def with_dt(self, dt: float) -> Self:
        """The same field, marched in other steps (meters); as many more samples by importance."""
        other = super().with_dt(dt)
        count = round(self.policy.importance * self.policy.dt / dt)
        other.policy = replace(other.policy, importance=count)
        return other

    def _sampled(
        self, rays: Rays, cells: Array | None, batch: RayBatch, options: RenderOptions, **at: int
    ) -> tuple[Rays, tuple[Array, Array] | None]:
        """Samples by importance, if the policy asks for them, in the span of those of the lattice.

        Raises RangeError for `camera_adjoint`: the samples move with the camera.
        """
        count = self.policy.importance
        if count == 0:
            return rays, None
        if options.camera_adjoint:
            expected = "samples that do not move with the camera"
            got = f"importance={count}, whose positions are held constant"
            raise RangeError(message("Nerf.render", "options.camera_adjoint", expected, got))
        shift = None
        if options.jitter:
            shift = uniform(at["seed"], step=at["step"], pixel=batch.pixel, sample=0, dimension=1)
        origins, directions, t0, samples = rays

        def density(t: Array) -> Array:
            points = origins[:, None] + t[..., None] * directions[:, None]
            return self._densities_where(cells, points.reshape(-1, 3)).reshape(t.shape)

        length = samples * self.policy.dt
        placed = fine_samples(density, t0, length, count, shift)
        t, width = (np.ascontiguousarray(a, origins.dtype) for a in placed)
        counts = np.where(samples > 0, count, 0).astype(np.int32)
        return (origins, directions, t0, counts), (t, width)

    def _densities_where(self, cells: Array | None, points: Array) -> Array:
        """Extinction (N,) at points (N, 3) in meters; 0 in empty cells."""
        lower, upper = self.box
        unit = np.clip((points - lower) / (upper - lower), 0, 1)
        occupied = np.ones(len(unit), np.bool_)
        if cells is not None:
            i, j, k = np.minimum((unit * len(cells)).astype(np.int64), len(cells) - 1).T
            occupied = cells[k, j, i] > 0
        found = np.zeros(len(unit))
        found[occupied] = self._unit_densities(unit[occupied].astype(self.params["density"].dtype))
        return found

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

"""What radiance fields of networks have in common: two networks, marched through, empty cells.

    e = encoding(p);  (s, g) = density network(e);  rgb = color network(g, Y(direction))

Density depends on the position alone; color on the direction, too, as spherical harmonics of degree
3 of the direction towards the camera. An occupancy grid says which cells are worth evaluating: a
running maximum of the densities found in each, as in [Mueller2022, App. E.2].
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt
from photograd_course.portable_math import log
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._checkpoint import FLOAT, Row
from photograd._checks import from_plain
from photograd._compiled import _core
from photograd._fit_options import FitOptions
from photograd.errors import RangeError, message
from photograd.fields.march import (
    check_camera_adjoint,
    checked_rays,
    checked_values,
    cotangent_arrays,
    require_finite_image,
)
from photograd.fields.neural_policy import NeuralContext, NeuralPolicy, Rays
from photograd.network import FrequencyEncoding, HashEncoding, Perceptron
from photograd.network.explosion import require_bounded
from photograd.representation import Fittable, Memory, Outputs, RayBatch, RenderOptions, Start
from photograd.types import Array

DIRECTION_NUMBERS: int = _core.neural_direction_numbers
"""Harmonics of the direction that the color network takes."""
CELLS = 64
"""Of the occupancy grid, along each axis."""
EVERY = 16
"""Steps between two updates of the occupancy grid."""
PARTS = 4
"""Updates after which all cells have been looked at."""
DECAY = 0.8
"""Of a cell's maximum, from look to look."""
STEPS_ACROSS = 128
"""Steps of a march across the box, times the option `steps_per_voxel`."""
UNSEEN = 1e30
"""The maximum of a cell that was not looked at yet; it is evaluated."""
OPAQUE = 0.01
"""Opacity of a step that makes a cell occupied, wherever the mean of all cells is above it."""


class NeuralField(Fittable):
    """Two networks behind an encoding of the position.

    Attributes:
        encoding: of the position.
        density, color: the networks. The first gives raw density and features, the second takes the
            features and `DIRECTION_NUMBERS` harmonics, and gives raw color.
        policy: box, step, activations, sizes.
        reached: (K, K, K) float32, [z, y, x] over the box, the running maximum of sigma_t in each
            cell; None evaluates all samples.
    """

    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})
    gradient_picture: ClassVar[str] = "networks"
    first_model_help: ClassVar[str] = "networks start with random weights"
    frozen = False
    policy: NeuralPolicy
    policy_class: ClassVar[type[NeuralPolicy]]

    def __init__(
        self,
        policy: NeuralPolicy,
        params: Mapping[str, Array] | None = None,
        *,
        dtype: npt.DTypeLike = np.float32,
    ) -> None:
        """State the sizes and the parameters.

        Args:
            policy: sizes of the networks, and how they are marched through.
            params: "density" and "color", flat as in `Perceptron`, and "table" (rows, features) of
                a hash encoding; by default zeros.
            dtype: of the zeros, float32 or float64.

        Raises:
            RangeError: sizes that no network has.
            ShapeError, DtypeError: parameters of other sizes.
        """
        self.policy = policy
        self.encoding = self._encoding(policy)
        widths = [policy.width] * policy.depth
        self.density = Perceptron(
            self.encoding.outputs,
            [*widths, 1 + policy.features],
            hidden=policy.hidden,
            skip=policy.depth // 2 if policy.depth >= 4 else 0,
        )
        self.color = Perceptron(
            policy.features + DIRECTION_NUMBERS, [policy.width, 3], hidden=policy.hidden
        )
        self.reached: Array | None = None
        e = self.encoding
        self._parts: dict[str, Perceptron | HashEncoding]
        self._parts = {"density": self.density, "color": self.color}
        if isinstance(e, HashEncoding):
            self._parts["table"] = e
        self._settings = Arguments(type(self).__name__).run(
            _core.NeuralSettings,
            e.settings if isinstance(e, HashEncoding) else None,
            e.octaves if isinstance(e, FrequencyEncoding) else 0,
            self.density.shape,
            self.color.shape,
        )
        shapes = self._shapes()
        call, given = Arguments(type(self).__name__), params
        if given is None:
            given = {name: np.zeros(shape, dtype) for name, shape in shapes.items()}
        self.params = {
            name: call.array(name, given.get(name), shape, finite=False)
            for name, shape in shapes.items()
        }

    @classmethod
    @abstractmethod
    def _encoding(cls, policy: Any) -> HashEncoding | FrequencyEncoding: ...

    @classmethod
    def initial(
        cls,
        policy: NeuralPolicy,
        *,
        seed: int,
        sigma_t: float = 0.1,
        dtype: npt.DTypeLike = np.float32,
    ) -> Self:
        """A field with random weights that is nearly empty.

        Args:
            policy: sizes of the networks, and how they are marched through.
            seed: of the random numbers.
            sigma_t: density everywhere, about, in 1/m.
            dtype: float32 or float64.
        """
        field = cls(policy, dtype=dtype)
        starts: dict[str, Any] = {"density": field.density, "color": field.color}
        for step, (name, values) in enumerate(field.params.items()):
            start = starts.get(name, field.encoding)
            values[...] = start.initial(seed=seed + step, dtype=dtype)
        _, b = field.density.layers(field.params["density"])[-1]
        b[0] = log(np.float64(sigma_t / policy.density_scale))
        return field

    def _shapes(self) -> dict[str, tuple[int, ...]]:
        shapes: dict[str, tuple[int, ...]] = {}
        if isinstance(self.encoding, HashEncoding):
            shapes["table"] = (self.encoding.rows, self.encoding.features)
        return shapes | {"density": (self.density.count,), "color": (self.color.count,)}

    @property
    def box(self) -> Array:
        """(2, 3) corners of the box in world meters."""
        return np.array(self.policy.box)

    @property
    def dt(self) -> float:
        """Step of the march in meters."""
        return self.policy.dt

    def with_dt(self, dt: float) -> Self:
        """The same field, whose parameters are shared, marched in other steps (meters)."""
        other = copy(self)
        other.policy = replace(self.policy, dt=dt)
        return other

    @classmethod
    def _start_policy(cls, policy: type[Any], start: Start, **more: Any) -> Any:
        """The policy of a fit's options."""
        options, box = start.options, start.bounds.box
        extent = float((box[1] - box[0]).max())
        lower, upper = box.tolist()
        return policy(
            (tuple(lower), tuple(upper)),
            extent / (STEPS_ACROSS * options.steps_per_voxel),
            density_scale=STEPS_ACROSS / extent,
            **more,
        )

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """Tables and networks of any size that the policy asks for, and the occupancy."""
        del options
        params: dict[str, Row] = {"density": (FLOAT, ("P",)), "color": (FLOAT, ("Q",))}
        return cls._table_rows() | params, {"reached": (("float32",), (CELLS,) * 3)}

    @classmethod
    def _table_rows(cls) -> dict[str, Row]:
        return {}

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The field of a checkpoint."""
        del options
        field = cls(from_plain("checkpoint", cls.policy_class, policy), params)
        field.load_state(state)
        return field

    def state(self) -> dict[str, Array]:
        """The running maximum of each cell."""
        unseen = np.full((CELLS,) * 3, UNSEEN, np.float32)
        return {"reached": unseen if self.reached is None else self.reached}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Take what `state` returned."""
        function = f"{self.name}.load_state"
        if set(state) != {"reached"}:
            raise RangeError(message(function, "state", "reached alone", f"{sorted(state)}"))
        call, shape = Arguments(function, np.float32), (CELLS,) * 3
        self.reached = call.array("reached", state["reached"], shape, finite=False).copy()

    @classmethod
    def memory(cls, box: Array, options: FitOptions, available: int) -> tuple[Memory, ...]:
        """Of the gradients that a batch of rays records."""
        del box, available
        samples = options.rays * STEPS_ACROSS
        size = 4 * min(samples, 1 << 20) * 64
        return (Memory("rays", "what a batch of rays records", size, "take fewer rays"),)

    def occupied(self) -> Array | None:
        """(K, K, K) uint8, [z, y, x]: cells that are evaluated; None for all.

        A cell counts where one step through its maximum is more opaque than `OPAQUE`, or than the
        mean over all cells, if that is less.
        """
        if self.reached is None:
            return None
        threshold = min(OPAQUE / self.policy.dt, float(np.minimum(self.reached, 1e6).mean()))
        occupied: Array = (self.reached >= threshold).astype(np.uint8)
        return occupied

    def after_step(self, rates: Mapping[str, float], step: int) -> None:
        """Look at a part of the cells, at random places in them, every few steps.

        Raises Error if a layer or a level has exploded, and names it.
        """
        del rates
        require_bounded("fit", self.params, self._parts)
        if step % EVERY or self.frozen:
            return
        if self.reached is None:
            self.reached = np.full((CELLS,) * 3, UNSEEN, np.float32)
        look = step // EVERY
        index = np.arange(look % PARTS, CELLS * CELLS * CELLS, PARTS)
        u = [uniform(0, step=look, pixel=index, sample=0, dimension=k) for k in range(3)]
        cell = np.stack([index % CELLS, index // CELLS % CELLS, index // (CELLS * CELLS)], axis=1)
        unit = ((cell + np.stack(u, axis=1)) / CELLS).astype(self.params["density"].dtype)
        found = self._unit_densities(unit).astype(np.float32)
        flat = self.reached.reshape(-1)
        before = np.where(flat[index] < UNSEEN, flat[index] * np.float32(DECAY), 0)
        flat[index] = np.maximum(before, found)

    @classmethod
    def frozen_at(cls, options: FitOptions) -> int:
        """Halfway: the occupancy is held from there on."""
        return options.steps // 2

    def freeze(self) -> None:
        """Hold the occupancy."""
        self.frozen = True

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, NeuralContext]:
        """Color (R, 3) linear, premultiplied, without background; opacity (R,); depth (R,) m."""
        check_camera_adjoint("march", self.policy, options)
        for name, values in self.params.items():
            checked_values("march", name, values)
        parameters, settings = self._arrays(), self.policy.settings(options.stop)
        rays = checked_rays(batch, settings, options, parameters[1].dtype, seed=seed, step=step)
        cells = self.occupied()
        rays, placed = self._sampled(rays, cells, batch, options, seed=seed, step=step)
        kept = _core.NeuralSamples() if options.keep_samples else None
        image = _core.march_neural(self._settings, parameters, cells, settings, rays, kept, placed)
        color, transmittance, depth = image
        require_finite_image(color, transmittance, batch)
        of_rays = settings, rays, image, options.camera_adjoint
        context = NeuralContext(parameters, cells, *of_rays, kept, placed)
        return Outputs(color, 1 - transmittance, depth), context

    def _sampled(
        self, rays: Rays, cells: Array | None, batch: RayBatch, options: RenderOptions, **at: int
    ) -> tuple[Rays, tuple[Array, Array] | None]:
        """Rays, and t and width (R, N) of their samples where these leave the lattice."""
        del cells, batch, options, at
        return rays, None

    def render_backward(self, context: NeuralContext, d_outputs: Outputs) -> dict[str, Array]:
        """Of each group, and "origins", "directions" (R, 3) if the options asked.

        The camera adjoint is the interior term: where a ray meets the box is held fixed.
        """
        c = context
        function, dtype = f"{self.name}.render_backward", c.parameters[1].dtype
        cotangents = cotangent_arrays(function, d_outputs, len(c.rays[2]), dtype)
        d_parameters = tuple(np.zeros_like(values) for values in c.parameters)
        d_rays = tuple(np.zeros_like(a) for a in c.rays[:2]) if c.camera_adjoint else None
        of_field = (self._settings, c.parameters, c.occupancy, c.march, c.rays)
        d = cotangents, d_parameters, d_rays
        _core.march_neural_backward(*of_field, c.image, *d, c.kept, c.placed)
        gradients = dict(zip(("table", "density", "color"), d_parameters, strict=True))
        gradients = {name: gradients[name] for name in self.params}
        if d_rays is not None:
            gradients["origins"], gradients["directions"] = d_rays
        return gradients

    def densities(self, points: Array) -> Array:
        """Extinction (N,), in 1/m, at points of the world, occupancy aside.

        Args:
            points: (N, 3) in meters, in the box.

        Raises:
            ShapeError, DtypeError, RangeError: other arrays, or points outside of the box.
        """
        call = Arguments(f"{type(self).__name__}.densities", self.params["density"].dtype)
        points = call.array("points", points, ("N", 3))
        lower, upper = np.asarray(self.policy.box, points.dtype)
        unit = (points - lower) / (upper - lower)
        return self._unit_densities(call.array("points", unit, ("N", 3), low=-1e-5, high=1 + 1e-5))

    def _unit_densities(self, unit: Array) -> Array:
        found = np.empty(len(unit), unit.dtype)
        settings = self.policy.settings(0.0)
        _core.neural_densities(self._settings, self._arrays(), settings, unit, found)
        return found

    def _arrays(self) -> tuple[Array, Array, Array]:
        """Table, density network, color network; a table of no rows where there is none."""
        density = self.params["density"]
        table = self.params.get("table", np.zeros((0, 1), density.dtype))
        return table, density, self.params["color"]

    def example_batch(self, *, seed: int) -> RayBatch:
        """The same rays as the dense grid's example."""
        from photograd.fields.dense_grid import DenseGrid

        return DenseGrid.example(seed=seed).example_batch(seed=seed)

    def _perturb(self, seed: int, scale: float) -> None:
        """Move all parameters, biases as well, so that no derivative vanishes."""
        for step, values in enumerate(self.params.values()):
            index = np.arange(values.size)
            u = uniform(seed, step=step, pixel=index, sample=1, dimension=0)
            values[...] += (scale * (2 * u - 1)).reshape(values.shape).astype(values.dtype)

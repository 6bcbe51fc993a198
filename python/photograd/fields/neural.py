"""Radiance fields by networks: NeRF, and a multiresolution hash grid with a small decoder.

    e = encoding(p);  (s, g) = density network(e);  rgb = color network(g, Y(direction))

Density depends on the position alone; color on the direction, too, as spherical harmonics of degree
3 of the direction towards the camera. Both are marched through as every field is.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd.fields.march import (
    MarchPolicy,
    check_camera_adjoint,
    checked_rays,
    checked_values,
    require_finite_image,
)
from photograd.network import FrequencyEncoding, HashEncoding, Perceptron
from photograd.network.perceptron import Activation
from photograd.representation import (
    Outputs,
    ParamSpec,
    RayBatch,
    RenderOptions,
    Representation,
    register,
)
from photograd.types import Array

DIRECTION_NUMBERS: int = _core.neural_direction_numbers
"""Harmonics of the direction that the color network takes."""


@dataclass(frozen=True)
class NeuralContext:
    """What the backward pass needs: O(1) per ray."""

    parameters: tuple[Array, Array, Array]
    occupancy: Array | None
    march: Any
    rays: tuple[Array, Array, Array, Array]
    image: tuple[Array, Array, Array]
    camera_adjoint: bool

    @property
    def sample_count(self) -> int:
        """Number of samples that were placed on all rays, in empty cells as well."""
        return int(self.rays[3].sum(dtype=np.int64))


class NeuralField(Representation):
    """Two networks behind an encoding of the position, marched through.

    Attributes:
        density, color: the networks. The first gives raw density and features, the second takes the
            features and `DIRECTION_NUMBERS` harmonics, and gives raw color.
        policy: box, step, and activations of raw density and color.
        occupancy: (K, K, K) bool, [z, y, x] over the box; False where a cell is empty, and is
            skipped. None evaluates all samples.
    """

    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})

    def __init__(
        self,
        encoding: HashEncoding | FrequencyEncoding,
        density: Sequence[int],
        color: Sequence[int],
        policy: MarchPolicy,
        *,
        features: int = 15,
        hidden: Activation = "relu",
        skip: int = 0,
    ) -> None:
        """State the networks; parameters are zeros until `initialize`.

        Args:
            encoding: of the position, three-dimensional.
            density: widths of the density network's hidden layers.
            color: widths of the color network's hidden layers.
            policy: how the field is marched through.
            features: numbers that the color network takes from the density network.
            hidden: activation of all hidden layers.
            skip: layer of the density network that takes the encoding again; 0 for none.

        Raises:
            RangeError: sizes that no network has.
        """
        self.encoding = encoding
        self.density = Perceptron(
            encoding.outputs, [*density, 1 + features], hidden=hidden, skip=skip
        )
        self.color = Perceptron(features + DIRECTION_NUMBERS, [*color, 3], hidden=hidden)
        self.policy = policy
        self.occupancy: Array | None = None
        hash_settings = encoding.settings if isinstance(encoding, HashEncoding) else None
        octaves = encoding.octaves if isinstance(encoding, FrequencyEncoding) else 0
        self._settings = Arguments(type(self).__name__).run(
            _core.NeuralSettings, hash_settings, octaves, self.density.shape, self.color.shape
        )

    @abstractmethod
    def initialize(self, *, seed: int, dtype: npt.DTypeLike = np.float32) -> None:
        """Give all parameters their random start.

        Args:
            seed: of the random numbers.
            dtype: float32 or float64.
        """

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """The networks, and the table where there is one."""
        rates = {"table": 1e-2, "density": 1e-2, "color": 1e-2}
        return {
            name: ParamSpec(values.shape, "1", (-1e4, 1e4), rates[name], "none")
            for name, values in self.params.items()
        }

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, NeuralContext]:
        """Color (R, 3) linear, premultiplied, without background; opacity (R,); depth (R,) m."""
        check_camera_adjoint("march", self.policy, options)
        parameters = self._arrays()
        for name, values in self.params.items():
            checked_values("march", name, values)
        settings = self.policy.settings(options.stop)
        rays = checked_rays(batch, settings, options, parameters[1].dtype, seed=seed, step=step)
        cells = None if self.occupancy is None else self.occupancy.astype(np.uint8)
        color, transmittance, depth = _core.march_neural(
            self._settings, parameters, cells, settings, rays
        )
        require_finite_image(color, transmittance, batch)
        image = (color, transmittance, depth)
        context = NeuralContext(parameters, cells, settings, rays, image, options.camera_adjoint)
        return Outputs(color, 1 - transmittance, depth), context

    def render_backward(self, context: NeuralContext, d_outputs: Outputs) -> dict[str, Array]:
        """Of each group, and "origins", "directions" (R, 3) if the options asked.

        The camera adjoint is the interior term: where a ray meets the box is held fixed.
        """
        c = context
        rays, dtype = len(c.rays[2]), c.parameters[1].dtype
        d_opacity = np.zeros(rays, dtype) if d_outputs.opacity is None else d_outputs.opacity
        d_depth = np.zeros(rays, dtype) if d_outputs.depth is None else d_outputs.depth
        cotangents = [
            np.ascontiguousarray(d, dtype) for d in (d_outputs.color, -d_opacity, d_depth)
        ]
        d_parameters = tuple(np.zeros_like(values) for values in c.parameters)
        d_rays = tuple(np.zeros_like(a) for a in c.rays[:2]) if c.camera_adjoint else None
        _core.march_neural_backward(
            self._settings,
            c.parameters,
            c.occupancy,
            c.march,
            c.rays,
            c.image,
            cotangents,
            d_parameters,
            d_rays,
        )
        gradients = dict(zip(("table", "density", "color"), d_parameters, strict=True))
        gradients = {name: gradients[name] for name in self.params}
        if d_rays is not None:
            gradients["origins"], gradients["directions"] = d_rays
        return gradients

    def densities(self, points: Array) -> Array:
        """Extinction (N,), in 1/m, at points (N, 3) of the world, occupancy aside.

        Raises:
            ShapeError, DtypeError, RangeError: anything but finite points of the box.
        """
        call = Arguments(f"{type(self).__name__}.densities", self.params["density"].dtype)
        points = call.array("points", points, ("N", 3))
        low, high = np.asarray(self.policy.box, points.dtype)
        unit = call.array(
            "points", (points - low) / (high - low), ("N", 3), low=-1e-6, high=1 + 1e-6
        )
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
            np.add(
                values, (scale * (2 * u - 1)).reshape(values.shape), out=values, casting="same_kind"
            )


@register
class HashGrid(NeuralField):
    """Instant neural graphics primitives [Mueller2022]: a hash encoding and two small networks.

    params: "table" (rows, features of a row); "density" and "color", flat as in `Perceptron`.
    """

    name: ClassVar[str] = "hash_grid"
    teaching_example: ClassVar[str] = "start it from Python, with an encoding of your own"

    def initialize(self, *, seed: int, dtype: npt.DTypeLike = np.float32) -> None:
        """Tables within 1e-4 of zero, weights by `Perceptron.initial`."""
        assert isinstance(self.encoding, HashEncoding)
        self.params = {
            "table": self.encoding.initial(seed=seed, dtype=dtype),
            "density": self.density.initial(seed=seed, dtype=dtype),
            "color": self.color.initial(seed=seed + 1, dtype=dtype),
        }

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Three levels, the finest hashed; smooth, so that differences find no kink."""
        encoding = HashEncoding([2, 4, 7], log2_rows=7, features=2, smoothstep=True)
        policy = MarchPolicy(((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)), 0.11)
        field = cls(encoding, [8], [8], policy, features=4, hidden="softplus")
        field.initialize(seed=seed, dtype=dtype)
        field._perturb(seed, 0.7)
        return field


@register
class Nerf(NeuralField):
    """Neural radiance field [Mildenhall2020]: frequency encoding and a deep network.

    params: "density" and "color", flat as in `Perceptron`.
    """

    name: ClassVar[str] = "nerf"
    teaching_example: ClassVar[str] = "start it from Python, with networks of your own"

    def initialize(self, *, seed: int, dtype: npt.DTypeLike = np.float32) -> None:
        """Weights by `Perceptron.initial`."""
        self.params = {
            "density": self.density.initial(seed=seed, dtype=dtype),
            "color": self.color.initial(seed=seed + 1, dtype=dtype),
        }

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Two octaves, a skip connection; smooth, so that differences find no kink."""
        policy = MarchPolicy(((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)), 0.11)
        field = cls(
            FrequencyEncoding(2), [8, 8], [8], policy, features=4, hidden="softplus", skip=1
        )
        field.initialize(seed=seed, dtype=dtype)
        field._perturb(seed, 0.3)
        return field

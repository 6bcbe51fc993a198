"""A picture as a network: the color at a point of a canvas, behind an encoding of the point.

    color(p) = network(encoding(p)),  p in the unit square, x to the right and y down

The same encodings and networks as those of radiance fields, in two dimensions, where a fit takes
seconds. Without an encoding a network learns a blur: it takes low frequencies first [Tancik2020].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._checks import require_bounds, require_choices
from photograd.network import FrequencyEncoding, HashEncoding, OneBlobEncoding, Perceptron
from photograd.network.explosion import require_bounded
from photograd.representation import (
    CanvasBatch,
    Outputs,
    ParamSpec,
    RenderOptions,
    Representation,
    register,
)
from photograd.types import Array

Encoding = Literal["hash_grid", "frequencies", "one_blob"]
SLAB = 1 << 16
"""Points of a picture that are evaluated at a time."""


@dataclass(frozen=True)
class ImagePolicy:
    """How large a neural image is.

    Attributes:
        encoding: of points.
        levels: of a hash grid.
        coarsest, finest: cells along an axis of its first and its last level.
        log2_rows: of the largest table of a level.
        row_features: numbers in a row.
        octaves: of frequencies; 0 hands the point itself to the network.
        bins: of one-blob encodings, along each axis.
        width: of the hidden layers.
        depth: hidden layers.
    """

    encoding: Encoding = "hash_grid"
    levels: int = 16
    coarsest: int = 16
    finest: int = 1024
    log2_rows: int = 14
    row_features: int = 2
    octaves: int = 10
    bins: int = 64
    width: int = 64
    depth: int = 2

    def __post_init__(self) -> None:
        """Raises RangeError for an unknown encoding, or sizes that no network has."""
        require_choices(self)
        require_bounds(self, "levels", "depth", low=1, high=32)
        require_bounds(self, "width", low=1, high=1024)


@dataclass(frozen=True)
class ImageContext:
    """What the backward pass of a neural image needs: its parameters and points, as they were."""

    params: dict[str, Array]
    points: Array
    features: Array
    camera_adjoint: bool


@register
class NeuralImage(Representation):
    """params: "network", flat as in `Perceptron`, and "table" (rows, features) of a hash grid.

    Colors are what the network gives: linear in its last layer, and not held to [0, 1].
    """

    name: ClassVar[str] = "neural_image"
    capabilities: ClassVar[frozenset[str]] = frozenset({"canvas2d"})
    teaching_example: ClassVar[str] = "it lives on a 2D canvas; fit_image fits it to a picture"
    color_space: ClassVar[str] = "display"

    def __init__(
        self,
        policy: ImagePolicy,
        params: Mapping[str, Array] | None = None,
        *,
        seed: int = 0,
        dtype: npt.DTypeLike = np.float32,
    ) -> None:
        """State the sizes, and the parameters.

        Args:
            policy: sizes of the encoding and the network.
            params: by name; None takes random ones.
            seed: of random parameters.
            dtype: of random parameters, float32 or float64.

        Raises:
            RangeError: sizes that no encoding has.
            ShapeError, DtypeError: parameters of other sizes.
        """
        self.policy = policy
        self.encoding = _encoding(policy)
        self.network = Perceptron(self.encoding.outputs, [policy.width] * policy.depth + [3])
        self._parts: dict[str, Perceptron | HashEncoding] = {"network": self.network}
        if isinstance(self.encoding, HashEncoding):
            self._parts["table"] = self.encoding
        if params is None:
            params = {
                name: part.initial(seed=seed + step, dtype=dtype)
                for step, (name, part) in enumerate(self._parts.items())
            }
        call = Arguments("NeuralImage")
        shapes: dict[str, tuple[int, ...]] = {"network": (self.network.count,)}
        if isinstance(self.encoding, HashEncoding):
            shapes["table"] = (self.encoding.rows, self.encoding.features)
        self.params = {
            name: call.array(name, params.get(name), shape, finite=False)
            for name, shape in shapes.items()
        }

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Three levels, the finest hashed, and lively parameters."""
        policy = ImagePolicy(levels=3, coarsest=2, finest=9, log2_rows=5, width=8, depth=1)
        image = cls(policy, seed=seed, dtype=dtype)
        for step, values in enumerate(image.params.values()):
            u = uniform(seed, step=step, pixel=np.arange(values.size), sample=1, dimension=0)
            values[...] += (0.4 * (2 * u - 1)).reshape(values.shape).astype(dtype)
        return image

    def example_batch(self, *, seed: int) -> CanvasBatch:
        """40 points in the unit square."""
        index = np.arange(40)
        points = [uniform(seed, step=1, pixel=index, sample=0, dimension=k) for k in range(2)]
        return CanvasBatch(np.stack(points, axis=-1))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """The network, and the table of a hash grid."""
        return {
            name: ParamSpec(values.shape, "1", (-1e4, 1e4), 1e-2, "none")
            for name, values in self.params.items()
        }

    def require_bounded(self, function: str) -> None:
        """Raise Error, on behalf of `function`, if a layer or level has exploded."""
        require_bounded(function, self.params, self._parts)

    def image(self, height: int, width: int) -> Array:
        """(height, width, 3) colors at the centers of pixels, not held to [0, 1]."""
        colors = np.empty((height * width, 3), self.params["network"].dtype)
        for first in range(0, len(colors), SLAB):
            pixel = np.arange(first, min(first + SLAB, len(colors)))
            colors[first : first + SLAB] = self._colors(pixel_centers(pixel, height, width))[0]
        return colors.reshape(height, width, 3)

    def render(
        self, batch: CanvasBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, ImageContext]:
        """Color (N, 3) at the points; a canvas has neither opacity nor depth."""
        del seed, step  # nothing random here
        points = np.asarray(batch.points, self.params["network"].dtype)
        colors, features = self._colors(points)
        context = ImageContext(dict(self.params), points, features, options.camera_adjoint)
        return Outputs(colors).checked("NeuralImage.render", batch), context

    def render_backward(self, context: ImageContext, d_outputs: Outputs) -> dict[str, Array]:
        """Of each group, and "points" (N, 2) if the options asked."""
        c = context
        d_color = np.asarray(d_outputs.color, c.points.dtype)
        of_network: tuple[Array, Any] = self.network.backward(
            c.params["network"], c.features, d_color
        )
        d_network, d_features = of_network
        gradients = {"network": d_network}
        d_points = None
        if isinstance(self.encoding, HashEncoding):
            gradients["table"], d_points = self.encoding.encode_backward(
                c.params["table"], c.points, d_features, d_points=c.camera_adjoint
            )
        elif c.camera_adjoint:
            d_points = self.encoding.encode_backward(c.points, d_features)
        return gradients if d_points is None else gradients | {"points": d_points}

    def _colors(self, points: Array) -> tuple[Array, Array]:
        """Colors (N, 3) and encoded points (N, E)."""
        points = points.astype(self.params["network"].dtype, copy=False)
        if isinstance(self.encoding, HashEncoding):
            features = self.encoding.encode(self.params["table"], points)
        else:
            features = self.encoding.encode(points)
        return self.network.forward(self.params["network"], features), features


def _encoding(policy: ImagePolicy) -> HashEncoding | FrequencyEncoding | OneBlobEncoding:
    if policy.encoding == "frequencies":
        return FrequencyEncoding(policy.octaves, dimensions=2)
    if policy.encoding == "one_blob":
        return OneBlobEncoding(policy.bins, dimensions=2)
    return HashEncoding.geometric(
        levels=policy.levels,
        coarsest=policy.coarsest,
        finest=policy.finest,
        dimensions=2,
        log2_rows=policy.log2_rows,
        features=policy.row_features,
    )


def pixel_centers(pixel: Array, height: int, width: int) -> Array:
    """(N, 2) float64 points of the canvas in the centers of pixels, numbered row by row.

    Args:
        pixel: (N,) numbers below height * width.
        height, width: of the picture.
    """
    x, y = pixel % width, pixel // width
    return np.stack([(x + 0.5) / width, (y + 0.5) / height], axis=-1)
